"""Each piece of a strand move keeps what it has to."""

from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.diagrams import jones, simplified
from mobius_flow.core.diagrams.diagram import ENDS, PIN, Diagram
from mobius_flow.core.diagrams.projection import rotation
from mobius_flow.core.knots import knot, knot_type, scramble
from mobius_flow.core.passes.drawing import Drawing
from mobius_flow.core.passes.heights import combed
from mobius_flow.core.passes.matching import carried
from mobius_flow.core.passes.moving import MovingCurve
from mobius_flow.core.passes.passing import passed
from mobius_flow.core.passes.plan import is_least, planned
from mobius_flow.core.passes.spread import spread
from mobius_flow.core.passes.thin import thin
from mobius_flow.core.passes.triangles import Triangles, UnclearError

NOWHERE = np.empty(0, dtype=np.intp)


def body(name: str, seed: int = 1, held: tuple[int, ...] = (), *, is_open: bool = False) -> MovingCurve:
    """A messy curve seen from a random direction."""
    curve = scramble(knot(name, 60), seed, moves=1500)
    if is_open:
        curve = Curve(curve.vertices[:-1], Mesh((len(curve) - 1,), (False,)))
    found = MovingCurve(curve, np.array(held, dtype=np.intp))
    found.frame = rotation(np.random.default_rng(seed).normal(size=(3, 3)))
    return found


def drawing(found: MovingCurve) -> Drawing:
    return Drawing.of(found.mesh, found.seen, found.held)


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
    line = np.array([[0.0, 0.0], [1.0, 1.0 + 2**-50], [0.3, 0.3 + 2**-54], [0.5, 0.25]])
    assert len(Triangles(line, [(0, 1)]).corners) == 2 * len(line) + 2
    with pytest.raises(UnclearError):
        Triangles(np.array([[0.0, 0.0], [1.0, 1.0], [0.5, 0.5]]), [(0, 1)])


@pytest.mark.parametrize("name", ["5_2", "L2a1", "8_19"])
def test_plans_keep_the_type(name: str) -> None:
    diagram = drawing(body(name)).diagram
    wanted = jones(simplified(diagram))
    moves = planned(diagram, np.random.default_rng(1))
    assert moves[-1].after.crossings < diagram.crossings
    assert all(b.before is a.after for a, b in pairwise(moves))
    assert all(move.after.is_planar and jones(simplified(move.after)) == wanted for move in moves)


def test_where_a_curve_is_held_strands_end() -> None:
    pinned = drawing(body("5_2", held=(3, 30))).diagram
    assert pinned.sequence.count(PIN) == 2
    arc = drawing(body("5_2", is_open=True)).diagram
    assert arc.sequence.count(ENDS) == 1
    assert not is_least(arc)
    for diagram in (pinned, arc):
        assert diagram.is_planar
        for move in planned(diagram, np.random.default_rng(1)):
            assert all(move.before.sequence[i][0] >= 0 for i in move.strand.inner)
            assert move.after.is_planar


def test_moves_are_found_again_in_a_diagram_that_is_numbered_otherwise() -> None:
    diagram = drawing(body("5_2")).diagram
    (part,) = diagram.passes
    turned = Diagram((part[7:] + part[:7],), diagram.signs)
    move = planned(diagram, np.random.default_rng(1))[0]
    again = carried(move, turned)
    assert again is not None
    assert again.strand.inner[0] == (move.strand.inner[0] - 7) % len(part)
    assert carried(move, move.after) is None


@pytest.mark.parametrize("held", [(), (3, 30)])
def test_heights_keep_the_order_at_crossings_and_what_is_held(held: tuple[int, ...]) -> None:
    found = body("7_4", held=held)
    before = drawing(found)
    heights = combed(before, found.held)
    assert heights is not None
    np.testing.assert_allclose(heights[list(held)], found.seen[list(held), 2], atol=1e-12)
    after = Drawing.of(found.mesh, np.column_stack([before.points[:, :2], heights]), found.held)
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


def test_what_is_spread_has_its_diagram_and_wider_gaps() -> None:
    found = body("7_4")
    thin(found)
    before = drawing(found)
    flat = np.column_stack([before.points[:, :2] * [0.02, 1.0], combed(before, found.held)])
    found = MovingCurve(Curve(flat), NOWHERE)
    before, gap = drawing(found), found.gap / found.size
    assert spread(found, before)
    assert found.gap / found.size > 3.0 * gap
    move = planned(before.diagram, np.random.default_rng(1))[0]
    assert carried(move, drawing(found).diagram) is not None


@pytest.mark.parametrize("name", ["5_2", "L6a4"])
def test_a_move_in_space_leads_to_the_diagram_that_was_planned(name: str) -> None:
    found = body(name)
    thin(found)
    seen = drawing(found)
    for move in planned(seen.diagram, np.random.default_rng(1))[:1]:
        assert passed(found, seen, move)
        after = drawing(found).diagram
        assert after.crossings == move.after.crossings
        assert all(
            carried(following, after) is not None for following in planned(move.after, np.random.default_rng(1))[:1]
        )
