"""Polygons from planar diagram codes: the knot of the diagram, and coarse but not crumpled."""

from collections import defaultdict

import numpy as np
import pytest
from knot_diagrams import diagram
from knot_type import UNKNOT, knot_invariants
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.collision import check_embedded, minimal_gap
from mobius_flow.core.knots import HARD_UNKNOTS, knot, knot_type
from mobius_flow.core.knots.braids import braid_diagram
from mobius_flow.core.knots.diagrams import diagram_of, linking_numbers, quick_invariants, views
from mobius_flow.core.knots.diagrams.rerouting import without_nugatory
from mobius_flow.core.knots.planar import drawn, grid_drawing, redrawn

RIGHT_TREFOIL = [(1, 5, 2, 4), (3, 1, 4, 6), (5, 3, 6, 2)]
CODES = {
    "3_1": RIGHT_TREFOIL,
    "m3_1": [(1, 4, 2, 5), (3, 6, 4, 1), (5, 2, 6, 3)],
    "4_1": [(4, 2, 5, 1), (8, 6, 1, 5), (6, 3, 7, 4), (2, 7, 3, 8)],
    **{name: diagram([knot(name).vertices]).pd_code() for name in ("5_2", "6_3", "7_7", "8_19", "9_42")},
}


def diagram_knot(code):
    return drawn(diagram_of(code))


@pytest.mark.parametrize("name", CODES)
def test_small_codes_and_codes_read_off_other_polygons(name):
    assert knot_invariants(diagram_knot(CODES[name]).vertices) == knot_invariants(knot(name).vertices)


@pytest.mark.parametrize("name", ["m8_20", "L6n1"])
def test_drawings_of_other_diagrams_keep_the_type_and_a_seed_tells_which(name):
    given = knot(name)
    curves, again, others = (list(redrawn(given, 3, seed)) for seed in (5, 5, 6))
    assert [each.vertices.tolist() for each in curves] == [each.vertices.tolist() for each in again]
    assert curves[0].vertices.tolist() != others[0].vertices.tolist()
    assert len({round(each.length, 6) for each in curves}) == 3
    for each in curves:
        assert knot_type(each).names == (name,)
        assert linking_numbers(each) == linking_numbers(given)
        assert len(each) < 8 * int(name[1])  # of few crossings


def test_nothing_is_drawn_of_what_comes_apart():
    circle = diagram_knot([(1, 1, 2, 2)])
    for curve in (circle, Curve.from_components([circle.vertices, circle.vertices + 5.0])):
        assert not list(redrawn(curve, 3, 5))


LONG = ("ochiai-4", "haken", "ochiai-2", "ochiai-3")


@pytest.mark.parametrize(
    "name", [pytest.param(each, marks=pytest.mark.slow if each in LONG else ()) for each in HARD_UNKNOTS]
)
def test_hard_unknots(name):
    curve = knot(name)
    code = HARD_UNKNOTS[name]
    assert len(curve) < 8 * len(code)
    check_embedded(curve)
    assert minimal_gap(curve)[0] > 5e-3
    assert quick_invariants(curve).is_trivial
    assert knot_invariants(curve.vertices) == UNKNOT


@pytest.mark.parametrize(
    ("code", "said"),
    [
        ([], "it has no component"),
        ([(1, 4, 2, 5), (3, 6, 4, 1), (5, 2, 6, 7)], "every edge must be there twice"),
        ([(1, 4, 2, 5), (3, 6, 4, 1), (2, 5, 6, 3)], "cannot be drawn in the plane"),
    ],
)
def test_bad_codes_are_one_sentence(code, said):
    with pytest.raises(CurveError, match=said):
        diagram_knot(code)


def test_links_codes_that_fall_apart_and_nugatory_crossings():
    link = diagram_knot([(6, 1, 7, 2), (8, 3, 5, 4), (2, 5, 3, 6), (4, 7, 1, 8)])
    assert len(link.components) == 2
    assert abs(quick_invariants(link).linking[0]) == 2
    two = diagram_knot([*RIGHT_TREFOIL, *[tuple(10 + e for e in crossing) for crossing in RIGHT_TREFOIL]])
    assert [knot_invariants(part) for part in two.components] == 2 * [knot_invariants(knot("3_1").vertices)]
    assert np.ptp(two.vertices, axis=0).max() == pytest.approx(2.0)
    assert len(diagram_knot([(1, 2, 2, 3), (3, 1, 4, 4)])) == 12


RNG = np.random.default_rng(23)
TREFOIL = diagram_of([(1, 5, 2, 4), (3, 1, 4, 6), (5, 3, 6, 2)])
DIAGRAMS = {
    "trefoil": TREFOIL,
    "Hopf link": braid_diagram((1, 1)),
    "many twists": braid_diagram((1,) * 300 + (-2, 1, -2)),
    "a braid of eight strands": braid_diagram((RNG.integers(1, 8, 300) * RNG.choice([-1, 1], 300)).tolist()),
    **{name: diagram_of(HARD_UNKNOTS[name]) for name in ("culprit", "d28", "haken")},
    **{f"a walk of {n} steps": next(views(Curve(RNG.normal(size=(n, 3)).cumsum(axis=0)), 1)) for n in (50, 100, 400)},
}


@pytest.mark.parametrize("name", DIAGRAMS)
def test_the_drawing_is_of_the_diagram(name):
    (piece,) = (each for each in without_nugatory(DIAGRAMS[name]).pieces() if each.crossings)
    places, met, walked = grid_drawing(piece), defaultdict(list), set()
    for i, path in enumerate(places):
        (x, y), steps = path[0], []
        for a, b in np.concatenate([path[1:], places[piece.next[i]][:1]]).tolist():
            assert (a == x) != (b == y)
            step = int(np.sign(a - x)), int(np.sign(b - y))
            while (x, y) != (a, b):
                met[x, y].append((i if not steps else None, step))
                steps.append(step)
                x, y = x + step[0], y + step[1]
                line = frozenset([(x, y), (x - step[0], y - step[1])])
                assert line not in walked
                walked.add(line)
    shared = {place: each for place, each in met.items() if len(each) > 1}
    assert len(shared) == piece.crossings
    for (first, one), (second, other) in shared.values():
        (c, over), (d, _) = piece.sequence[first], piece.sequence[second]
        assert (c, piece.levels[c]) == (d, (second, first) if over else (first, second))
        turn = one[0] * other[1] - one[1] * other[0]
        assert turn == (piece.signs[c] if over else -piece.signs[c])


def test_bends_are_as_few_as_faces_need():
    """Seven of the trefoil between the outer triangle and bigons, and one between a bigon and the inner triangle."""
    assert sum(len(path) - 1 for path in grid_drawing(TREFOIL)) == 8
