"""Each piece of a strand move keeps what it has to."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.curve.pins import NOWHERE
from mobius_flow.core.knots import knot, knot_type, scramble
from mobius_flow.core.knots.diagrams import is_least, jones, simplified
from mobius_flow.core.knots.diagrams.diagram import ENDS, PIN
from mobius_flow.core.knots.diagrams.projection import rotation
from mobius_flow.core.knots.diagrams.rerouting import shortened
from mobius_flow.core.untangle.drawing import PlaneDrawing, Triangles, UnclearError, level_heights
from mobius_flow.core.untangle.moving import MovingCurve
from mobius_flow.core.untangle.strand_move import make_move
from mobius_flow.core.untangle.tidying import spread, thin
from mobius_flow.core.untangle.untangle import face, turn


def body(name: str, seed: int = 1, held: tuple[int, ...] = (), *, is_open: bool = False) -> MovingCurve:
    """A messy curve seen from a random direction."""
    curve = scramble(knot(name, 60), seed, moves=1500)
    if is_open:
        curve = Curve(curve.vertices[:-1], Mesh((len(curve) - 1,), (False,)))
    found = MovingCurve(curve, np.array(held, dtype=np.intp))
    found.frame = rotation(np.random.default_rng(seed).normal(size=(3, 3)))
    return found


def drawing(found: MovingCurve) -> PlaneDrawing:
    return PlaneDrawing.of(found.mesh, found.seen, found.held)


@pytest.mark.parametrize("seed", [1, 3])
def test_triangles_fill_the_rectangle_and_have_all_walls_for_edges(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle, radius = np.sort(rng.uniform(0, 2 * np.pi, 60)), rng.uniform(0.1, 1.0, 60)
    star = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    walls = [(k, (k + 1) % 60) for k in range(60)]
    found = Triangles(star, walls)
    corners, star = found.corners, found.points
    (a, b, c) = star[corners].transpose(1, 0, 2)
    areas = 0.5 * np.linalg.det(np.stack([b - a, c - a], axis=1))
    assert areas.min() > 0
    assert areas.sum() == pytest.approx(np.ptp(star, axis=0).prod())
    edges = {frozenset(pair) for corner in corners.tolist() for pair in pairwise([*corner, corner[0]])}
    assert all(frozenset(wall) in edges for wall in walls)


def test_sides_are_decided_where_rounding_hides_them() -> None:
    rng = np.random.default_rng(1)
    for _ in range(200):
        a, b = rng.uniform(-1.0, 1.0, (2, 2))
        a *= 10.0 ** -rng.integers(8)  # so that differences are rounded too
        found = Triangles(np.array([a, b, a + rng.uniform(0.1, 0.9) * 10.0 ** -rng.integers(6) * (b - a)]), [(0, 1)])
        for corner, *others in found.points[found.corners]:
            (x, y), (z, w) = ([Fraction(p) - Fraction(q) for p, q in zip(end, corner, strict=True)] for end in others)
            assert x * w > y * z
    with pytest.raises(UnclearError):
        Triangles(np.array([[0.0, 0.0], [1.0, 1.0], [0.5, 0.5]]), [(0, 1)])


def test_where_a_curve_is_held_strands_end() -> None:
    pinned = drawing(body("5_2", held=(3, 30))).diagram
    assert pinned.sequence.count(PIN) == 2
    arc = drawing(body("5_2", is_open=True)).diagram
    assert arc.sequence.count(ENDS) == 1
    for diagram in (pinned, arc):
        assert diagram.is_planar
        while (move := shortened(diagram)) is not None:
            assert all(move.before.sequence[i][0] >= 0 for i in move.strand.inner)
            diagram = move.after
            assert diagram.is_planar
        assert is_least(diagram)
        assert diagram.crossings == (0 if diagram.sequence.count(ENDS) else 5)


@pytest.mark.parametrize("held", [(), (3, 30)])
def test_heights_keep_the_order_at_crossings_and_what_is_held(held: tuple[int, ...]) -> None:
    found = body("7_4", held=held)
    before = drawing(found)
    heights = level_heights(before, found.held)
    assert heights is not None
    np.testing.assert_allclose(heights[list(held)], found.seen[list(held), 2], atol=1e-12)
    after = PlaneDrawing.of(found.mesh, np.column_stack([before.points[:, :2], heights]), found.held)
    assert after.diagram == before.diagram
    assert np.ptp(heights) < 0.5 * np.ptp(before.points[:, 2]) or held


@pytest.mark.parametrize("name", ["5_2", "L6a4"])
def test_thin_curves_have_their_type_and_no_more_crossings(name: str) -> None:
    found = body(name)
    kind, crossings, gap = str(knot_type(found.curve)), drawing(found).diagram.crossings, found.gap
    vertices = found.mesh.size
    thin(found)
    assert found.mesh.size < 0.7 * vertices
    assert str(knot_type(found.curve)) == kind
    assert drawing(found).diagram.crossings <= crossings
    assert found.gap >= 0.98 * min(gap, 4e-3 * found.size)


def test_corners_that_would_cross_together_are_not_dropped_together() -> None:
    below = [(-8.0, 0.0), (0.0, 0.0), (2.0, 2.0), (4.0, 0.0), (-6.0, -3.6)]
    above = [(-3.0, -9.5), (2.0, 0.5), (6.0, 1.0), (3.0, -1.0), (3.0, -12.0)]
    points = np.column_stack([np.array(below + above), np.repeat([0.0, 1.0], 5)])
    found = MovingCurve(Curve(points, Mesh((5, 5), (False, False))), NOWHERE)
    crossings = drawing(found).diagram.crossings
    thin(found)
    assert drawing(found).diagram.crossings <= crossings


def test_hairpins_narrower_than_anything_else_vanish() -> None:
    found = body("3_1")
    start, end = found.curve.vertices[[0, 1]]
    hairpin = np.cross(end - start, np.eye(3)[np.abs(end - start).argmin()])
    middle, aside = 0.5 * (start + end), 1e-4 * found.gap * hairpin / np.linalg.norm(hairpin)
    at = middle - 1e-9 * (end - start), middle + aside, middle + 1e-9 * (end - start)
    found = MovingCurve(Curve(np.insert(found.curve.vertices, [1, 1, 1], at, axis=0)), NOWHERE)
    thin(found)
    assert found.curve.edge_lengths.min() > 1e-6 * found.size
    assert str(knot_type(found.curve)) == str(knot_type(knot("3_1")))


def test_arcs_between_pins_stay_bent() -> None:
    found = body("5_2", held=tuple(range(0, 60, 3)))
    places = found.curve.vertices[found.held]
    thin(found)
    held = np.flatnonzero(found.held)
    np.testing.assert_array_equal(found.curve.vertices[held], places)
    assert (np.diff(held, append=found.mesh.size) >= 2).all()


def test_a_view_whose_moves_are_not_free_is_left_for_another_one() -> None:
    found = body("3_1")
    face(found, np.random.default_rng(1))
    best, here = turn(found, np.random.default_rng(1)), found.frame
    assert turn(found, np.random.default_rng(1)) == best
    assert found.frame is here
    turn(found, np.random.default_rng(1), away=True)
    assert found.frame is not here


def test_what_is_spread_has_its_diagram_and_wider_gaps() -> None:
    found = body("7_4")
    thin(found)
    before = drawing(found)
    flat = np.column_stack([before.points[:, :2] * [0.02, 1.0], level_heights(before, found.held)])
    found = MovingCurve(Curve(flat), NOWHERE)
    before, gap = drawing(found), found.gap / found.size
    assert spread(found, before)
    assert found.gap / found.size > 3.0 * gap
    after = drawing(found).diagram
    assert (after.crossings, jones(after)) == (before.diagram.crossings, jones(before.diagram))


@pytest.mark.parametrize("name", ["5_2", "L6a4"])
def test_a_move_in_space_leads_to_the_diagram_that_was_planned(name: str) -> None:
    found = body(name)
    thin(found)
    seen = drawing(found)
    move = shortened(seen.diagram)
    assert move is not None
    assert make_move(found, seen, move)
    after = drawing(found).diagram
    assert (after.crossings, after.writhe) == (move.after.crossings, move.after.writhe)
    assert jones(simplified(after)) == jones(simplified(seen.diagram))


def test_what_is_taken_back_leaves_no_trace() -> None:
    found = body("3_1")
    thin(found)
    before, count, mark = found.curve, len(found.stages), found.mark()
    thinner, everything = found.mesh.size, np.arange(found.mesh.size)
    assert found.move(everything, 1.01 * found.seen)
    assert found.insert(np.array([0.5, 2.5]))
    assert found.move(everything[:1], found.seen[:1])
    found.rewind(mark)
    assert (found.curve, len(found.stages), found.mesh.size) == (before, count, thinner)
    np.testing.assert_array_equal(found.stages[-1].end.vertices, before.vertices)
