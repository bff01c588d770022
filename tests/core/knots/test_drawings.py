"""Drawings lifted into space: the drawn crossings and no others, alternating or as told, or refused with the place."""

from contextlib import suppress

import numpy as np
import pytest
from curve_checks import strand_distance
from knot_diagrams import pairwise_linking
from knot_type import UNKNOT, knot_invariants
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.knots import Drawing, torus_knot
from mobius_flow.core.knots.diagrams.projection import plane_crossings


def flat(curve):
    return curve.with_vertices(curve.vertices[:, :2])


def scribble(seed, points=160):
    """A random closed curve with a few dozen crossings at most."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 2 * np.pi, points, endpoint=False)[:, None]
    modes = np.arange(1, 6)
    waves = np.concatenate([np.cos(t * modes), np.sin(t * modes)], axis=1)
    return Curve(waves @ (rng.normal(size=(10, 2)) / np.tile(modes, 2)[:, None] ** 0.7))


def circle(x, y=0.0, radius=1.0, points=40):
    t = 2 * np.pi * (np.arange(points) + 0.3) / points
    return np.column_stack([x + radius * np.cos(t), y + radius * np.sin(t)])


def test_a_drawn_trefoil_is_a_trefoil_and_changed_crossings_unknot_or_mirror_it():
    drawing = Drawing.of(flat(torus_knot(2, 3, 60)))
    assert len(drawing.crossings) == 3
    found, mirrored = (knot_invariants(drawing.lifted(changed).vertices) for changed in ([], [1, 2, 3]))
    assert (found.genus, found.fibered, abs(found.tau)) == (1, True, 1)
    assert mirrored.tau == -found.tau
    for number in (1, 2, 3):
        assert knot_invariants(drawing.lifted([number]).vertices) == UNKNOT


def test_components_side_by_side_and_within_each_other_are_drawn():
    drawing = Drawing.of(Curve.from_components([circle(0), circle(1.1), circle(4), circle(4, 0.1, 0.5)]))
    lifted = drawing.lifted()
    assert len(drawing.crossings) == 2
    assert {pair: abs(n) for pair, n in pairwise_linking(lifted.components).items() if n} == {(0, 1): 1}
    assert not lifted.components[3][:, 2].any()
    # corners on a grid are no trouble: strands through each other's vertices cross all the same
    bow = Drawing.of(Curve([(0, 0), (1, 1), (2, 2), (2, 0), (1, 1.0), (0, 2)]))
    assert bow.crossings == pytest.approx(np.array([[1.0, 1.0]]), abs=1e-6)
    assert knot_invariants(bow.lifted().vertices) == UNKNOT


SCRIBBLES: list[Drawing] = []  # the first random ones that are no unclear drawings
for seed in range(32):
    with suppress(CurveError):
        SCRIBBLES.append(Drawing.of(scribble(seed)))


@pytest.mark.parametrize("drawing", SCRIBBLES[:16])
def test_scribbles_have_the_drawn_crossings_and_no_others(drawing):
    order = np.argsort(drawing.passes.ravel())
    over = np.stack([drawing.first_over, ~drawing.first_over], axis=1).ravel()[order]
    assert (over[1:] != over[:-1]).all()
    assert over[:1].all()
    size = np.ptp(drawing.curve.vertices)
    for changed in ([], list(range(1, len(drawing.crossings) + 1, 2))):
        lifted = drawing.lifted(changed)
        check_embedded(lifted)
        generic = lifted.vertices + 1e-7 * size * np.random.default_rng(1).normal(size=(len(lifted), 3))
        found = plane_crossings(lifted.mesh, generic)
        pairs = zip(found.edges, found.at, strict=True)
        first, second = (lifted.vertices[e] + at[:, None] * lifted.edge_vectors[e] for e, at in pairs)
        assert len(first) == len(drawing.crossings)
        for number, crossing in enumerate(drawing.crossings, 1):
            k = int(np.linalg.norm(first[:, :2] - crossing, axis=1).argmin())
            assert np.linalg.norm(first[k, :2] - crossing) < 1e-4 * size
            assert (first[k, 2] > second[k, 2]) == (drawing.first_over[number - 1] ^ (number in changed))


TRIPLE = [(np.cos(a), np.sin(a)) for a in np.radians([0, 180, 210, 30, 60, 240])]


@pytest.mark.parametrize(
    ("curve", "place"),
    [
        (Curve.from_components([circle(0, points=400), circle(2, points=400)]), (1, 0)),
        (Curve([(0, 0), (2, 0), (2, 1), (1, 0), (0, 1)]), (1, 0)),
        (Curve([(0, 0), (2, 0), (2, 1), (1.5, 0), (0.5, 0), (0, 1)]), None),
        (Curve(TRIPLE), (0, 0)),
        (Curve([*circle(0), *circle(0)]), None),
    ],
    ids=["circles", "corner", "along", "triple", "twice round"],
)
def test_what_is_unclear_is_refused_with_the_place(curve, place):
    with pytest.raises(CurveError, match=r"near \(\S+, \S+\) strands touch") as caught:
        Drawing.of(curve)
    assert caught.value.place is not None
    if place is not None:
        said = str(caught.value).split("(")[1].split(")")[0].split(", ")
        assert np.linalg.norm(np.array(said, dtype=float) - place) < 0.1


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Drawing.of(torus_knot(2, 3)), "dimension 3"),
        (lambda: Drawing.of(Curve(np.ones((5, 2)))), "all points"),
        (lambda: Drawing.of(Curve(circle(0, points=20_001))), "at most 20000"),
        (lambda: Drawing.of(Curve(circle(0))).lifted([1]), "no crossing 1; the drawing has 0"),
        (lambda: Drawing.of(flat(torus_knot(2, 3))).lifted([0]), "no crossing 0"),
    ],
)
def test_what_is_no_drawing(make, said):
    with pytest.raises(CurveError, match=said):
        make()


@pytest.mark.parametrize("changed", [(), (1,), (1, 3)])
def test_what_was_lifted_is_seen_as_it_is(changed):
    """Lifting it again gives the same heights at the crossings, whichever were changed."""
    drawing = Drawing.of(scribble(3))
    again = Drawing.seen(drawing.lifted(changed))
    np.testing.assert_allclose(again.crossings, drawing.crossings, atol=1e-6)
    over = drawing.first_over.copy()
    over[[k - 1 for k in changed]] ^= True
    np.testing.assert_array_equal(again.first_over, over)


def test_strands_keep_apart_in_proportion_to_the_room_there():
    drawing = Drawing.of(flat(torus_knot(2, 7)))
    apart = np.linalg.norm(drawing.crossings[:, None] - drawing.crossings[None], axis=2)
    assert strand_distance(drawing.lifted()) > 0.4 * apart[apart > 0].min()
