"""The core's messages in Blender's words."""

import re

import pytest
from mobius_flow.core import Curve, CurveError, Obstacle, Outcome, Status, Task, relax
from mobius_flow.core.driver.outcome import converged
from mobius_flow.core.driver.words import in_blenders_words, spline_names
from shapes import torus_trefoil

NAMES = spline_names(["Ring", "Knot"], [1, 2])
SQUARE = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]
ABOVE = [[x, y, z + 1.0] for x, y, z in SQUARE]
WALL = Obstacle([[-1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [0.0, 1.0, 1.0]], [[0, 1, 2]], "edge of component 1")
OTHER = [[1.0, 2.0, 0.0], [1.0, 1.0, 3.0], [1.0, 3.0, 3.0]]
# what is wrong, what is avoided, and how the message begins, if the names of parts matter
BAD = {
    "repeated": (
        [ABOVE, [*SQUARE, SQUARE[3]]],
        (),
        "point 4 of spline 1 of 'Knot' and point 5 of spline 1 of 'Knot' are the same",
    ),
    "doubled back": (
        [[*SQUARE, [0.0, -1.0, 0.0]]],
        (),
        "the curve doubles back at point 5 of spline 1 of 'Ring', (0, -1, 0)",
    ),
    "crossing": ([[SQUARE[0], SQUARE[2], SQUARE[1], SQUARE[3]]], (), ""),
    "crossing another": ([SQUARE, OTHER], (), "segment 3 of spline 1 of 'Ring' and segment 1 of spline 1 of 'Knot' t"),
    "too near": ([SQUARE, [[x, y, 1e-12] for x, y, _ in SQUARE]], (), ""),
    "too large": ([[[1e41 * x for x in point] for point in SQUARE]], (), ""),
    "too small": ([[[1e-41 * x for x in point] for point in SQUARE]], (), ""),
    "too many": ([torus_trefoil(200_001).vertices], (), ""),
    "avoided": ([SQUARE], (WALL,), "segment 4 of spline 1 of 'Ring' pierces 'edge of component 1' at (0, 1, 0)"),
}


@pytest.mark.parametrize(("components", "avoid", "begins"), BAD.values(), ids=BAD)
def test_what_the_core_refuses_is_told_in_other_terms(components, avoid, begins):
    with pytest.raises(CurveError) as error:
        relax(Task(curve=Curve.from_components(components), obstacles=avoid))
    said = in_blenders_words(str(error.value), NAMES)
    assert said.startswith(begins)
    assert not re.search(r"component|vert|edge", said.replace(WALL.name, "")), "what is avoided keeps its name"


def test_splines_are_counted_in_each_object():
    assert NAMES == ["spline 1 of 'Ring'", "spline 1 of 'Knot'", "spline 2 of 'Knot'"]


def test_clauses_are_kept_where_an_outcome_stalls():
    outcome = converged(1.25e-5, 1e-4).adding("a minimum").stalling("no way on: {error}", error="{x}")
    assert outcome == Outcome(Status.STALLED, ("stalled: no way on: {x}", "a minimum"))
