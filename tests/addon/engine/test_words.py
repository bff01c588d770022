"""The core's messages in Blender's words, and in German."""

import re

import pytest
from mobius_flow.core import Curve, CurveError, Obstacle, Outcome, Status, Task, relax
from mobius_flow.core.driver.outcome import converged
from mobius_flow.core.driver.words import in_blenders_words, spline_names
from shapes import torus_trefoil

NAMES = spline_names(["Ring", "Knot"], [1, 2])
TERMS = re.compile(r"component|vert|edge")
SQUARE = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]
ABOVE = [[x, y, z + 1.0] for x, y, z in SQUARE]
BAD = {
    "repeated": [[*SQUARE, SQUARE[3]]],
    "doubled back": [[*SQUARE, [0.0, -1.0, 0.0]]],
    "crossing": [[SQUARE[0], SQUARE[2], SQUARE[1], SQUARE[3]]],
    "crossing another": [SQUARE, [[1.0, 2.0, 0.0], [1.0, 1.0, 3.0], [1.0, 3.0, 3.0]]],
    "too near": [SQUARE, [[x, y, 1e-12] for x, y, _ in SQUARE]],
    "too large": [[[1e41 * x for x in point] for point in SQUARE]],
    "too small": [[[1e-41 * x for x in point] for point in SQUARE]],
    "too many": [torus_trefoil(200_001).vertices],
}


def refusal(task):
    with pytest.raises(CurveError) as error:
        relax(task)
    return error.value


def test_splines_are_counted_in_each_object():
    assert NAMES == ["spline 1 of 'Ring'", "spline 1 of 'Knot'", "spline 2 of 'Knot'"]


@pytest.mark.parametrize(
    ("components", "wanted"),
    [
        (
            [ABOVE, BAD["repeated"][0]],
            "point 4 of spline 1 of 'Knot' and point 5 of spline 1 of 'Knot' are the same",
        ),
        (BAD["crossing another"], "segment 3 of spline 1 of 'Ring' and segment 1 of spline 1 of 'Knot' touch"),
        (BAD["doubled back"], "the curve doubles back at point 5 of spline 1 of 'Ring', (0, -1, 0)"),
    ],
)
def test_refusals(components, wanted):
    error = refusal(Curve.from_components(components))
    assert in_blenders_words(str(error), NAMES).startswith(wanted)


def test_what_is_avoided_keeps_its_name():
    name = "edge of component 1"
    wall = Obstacle([[-1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [0.0, 1.0, 1.0]], [[0, 1, 2]], name)
    error = refusal(Task(curve=Curve.from_components([SQUARE]), obstacles=(wall,)))
    assert in_blenders_words(str(error), NAMES).startswith(
        f"segment 4 of spline 1 of 'Ring' pierces '{name}' at (0, 1, 0)"
    )


@pytest.mark.parametrize("components", BAD.values(), ids=BAD)
def test_what_the_core_refuses_is_told_without_its_terms(components):
    assert not TERMS.search(in_blenders_words(str(refusal(Curve.from_components(components))), NAMES))


def test_clauses_are_kept_where_an_outcome_stalls():
    outcome = converged(1.25e-5, 1e-4).adding("a minimum").stalling("no way on: {error}", error="{x}")
    assert outcome == Outcome(Status.STALLED, ("stalled: no way on: {x}", "a minimum"))
