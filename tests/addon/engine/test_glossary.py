"""The core's sentences in Blender's words."""

import re

import pytest
from mobius_flow.addon.engine.glossary import as_phrase, in_blenders_words, spline_names
from mobius_flow.core import Curve, CurveError, Obstacle, relax
from mobius_flow.core.driver.outcome import converged, out_of_iterations
from mobius_flow.core.messages import Message
from shapes import torus_trefoil

NAMES = spline_names(["Ring", "Knot"], [1, 2])
TERMS = re.compile(r"component|vert|edge")


def test_splines_are_counted_in_each_object():
    assert NAMES == ["spline 1 of 'Ring'", "spline 1 of 'Knot'", "spline 2 of 'Knot'"]


@pytest.mark.parametrize(
    ("said", "wanted"),
    [
        (
            "component 3: vertices 3 and 4 are the same point (1, 2, 3); remove one of them",
            "spline 2 of 'Knot': points 3 and 4 are the same point (1, 2, 3); remove one of them",
        ),
        (
            "edge 7 of component 1 and edge 2 of component 2 touch or cross near (0, 0, 0); move the strands apart",
            "segment 7 of spline 1 of 'Ring' and segment 2 of spline 1 of 'Knot' touch or cross near (0, 0, 0); "
            "move the strands apart",
        ),
        ("relax its components apart", "relax its splines apart"),
        ("knowledge of a vertex", "knowledge of a point"),
    ],
)
def test_sentences(said, wanted):
    assert in_blenders_words(said, NAMES) == wanted


def test_what_is_avoided_keeps_its_name():
    still = [[0, 0, 0], [1, 0, 0]], [[0, 1]]
    avoided = [Obstacle(*still, name) for name in ("edge", "edge of component 1", "O'Hara (2)")]
    said = "component 1: edge 4 pierces {}; move one of them away"
    for each in avoided:
        expected = f"spline 1 of 'Ring': segment 4 pierces '{each.name}'; move one of them away"
        assert in_blenders_words(said.format(each.title), NAMES, avoided) == expected


SQUARE = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]
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


@pytest.mark.parametrize("components", BAD.values(), ids=BAD)
def test_what_the_core_refuses_is_told_without_its_terms(components):
    with pytest.raises(CurveError) as error:
        relax(Curve.from_components(components))
    assert not TERMS.search(in_blenders_words(str(error.value), NAMES))


@pytest.mark.parametrize("outcome", [converged(1.25e-5, 1e-4), out_of_iterations(1), out_of_iterations(20)])
def test_ends_of_relaxations_can_be_translated(outcome):
    phrase = as_phrase(outcome.message)
    assert phrase == outcome.message
    assert isinstance(phrase, Message)


def test_other_ends_stay_as_they_are():
    message = converged(1.25e-5, 1e-4).adding("a minimum").message
    assert not isinstance(as_phrase(message), Message)
