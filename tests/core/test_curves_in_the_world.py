"""Scenes of others, for those who have them: certified, and accepted by the independent check."""

import os
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core import Curve, Status, minimize, read_curve, read_obstacle
from mobius_flow.core.knots import overhand
from mobius_flow.core.knots.knot_type import knot_type
from tasks import proved, wanted

SCENES = Path(os.environ.get("MOBIUS_FLOW_SCENES", "scenes"))
needs_scenes = pytest.mark.skipif(not SCENES.is_dir(), reason="MOBIUS_FLOW_SCENES names no directory of scenes")


def ends(curve: Curve) -> tuple[int, ...]:
    return tuple(curve.mesh.ends.ravel().tolist())


@needs_scenes
def test_arcs_in_a_duct_come_to_rest_there() -> None:
    """Their lengths, if evened out, would press them against its walls."""
    curve, duct = read_curve(SCENES / "paths-center.obj"), read_obstacle(SCENES / "h-shape.obj")
    result, _ = proved(curve, pins=ends(curve), avoid=(duct,))
    assert result.status is Status.CONVERGED


@needs_scenes
def test_an_arc_with_pins_and_tangents() -> None:
    curve = read_curve(SCENES / "curve.obj")
    result, _ = proved(curve, pins=(*ends(curve), 44, 88), pin_tangents=True)
    assert result.status is Status.CONVERGED


@needs_scenes
@pytest.mark.parametrize(("name", "surface"), [("circle", "bunny"), ("square-loop-smaller", "round-cup")])
def test_loops_come_to_rest_and_grow_in_containers(name: str, surface: str) -> None:
    """To twenty times their length, without more vertices than there is time for."""
    curve, container = read_curve(SCENES / f"{name}.obj"), read_obstacle(SCENES / f"{surface}.obj")
    assert proved(curve, avoid=(container,))[0].status is Status.CONVERGED
    result, _ = proved(curve, avoid=(container,), grow=20.0, max_iterations=100)
    assert result.last.grown == pytest.approx(20.0, rel=1e-12)
    assert len(result.curve) < 2500


@needs_scenes
def test_straight_arcs_between_all_corners_cannot_move() -> None:
    curve = read_curve(SCENES / "loop.obj")
    result = minimize(*wanted(curve, pins=(62, 94, 126, 158, 222, 254, 286, 318)))
    assert "nothing can move" in result.message
    np.testing.assert_array_equal(result.curve.vertices, curve.vertices)


def closed_far_away(arc: Curve) -> Curve:
    """The arc, continued straight beyond its ends and closed by two edges that are far away."""
    points, size = arc.vertices, np.ptp(arc.vertices, axis=0).max()
    before, after = points[0] - points[1], points[-1] - points[-2]
    first = points[0] + 20.0 * size * before / np.linalg.norm(before)
    last = points[-1] + 20.0 * size * after / np.linalg.norm(after)
    up = np.cross(before, [0.0, 0.0, 1.0])
    return Curve([*points, last, 0.5 * (first + last) + 50.0 * size * up / np.linalg.norm(up), first])


@pytest.mark.parametrize("pin_tangents", [False, True])
def test_descent_keeps_the_knot_of_an_arc_with_pinned_ends(pin_tangents: bool) -> None:
    """Nothing but its energy does: strands may go round the ends, as hops find out."""
    arc = overhand(60)
    result, _ = proved(arc, pins=(0, 59), pin_tangents=pin_tangents)
    assert result.status is Status.CONVERGED
    assert result.final_energy > 50.0
    assert knot_type(closed_far_away(arc)).names == knot_type(closed_far_away(result.curve)).names == ("3_1",)
