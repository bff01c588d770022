"""What a run does beside its steps where pins, obstacles or open ends make it pointless or untrue."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Obstacle, OptionError, RelaxOptions, Status, minimize
from mobius_flow.core.driver.moves import links
from mobius_flow.core.driver.moves.links import separate_parts
from mobius_flow.core.knots import knot, overhand
from mobius_flow.core.knots.composite import Ball
from shapes import opened, regular_polygon, straight_arc
from solids import box, plate, rod
from tasks import wanted

SQUARE = Curve([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
HELD = "unlinked parts"


def two_rings(distance: float) -> Curve:
    ring = regular_polygon(30).vertices
    return Curve.from_components([ring, ring + np.array([distance, 0.0, 0.3])])


def test_balance_does_not_go_with_obstacles() -> None:
    with pytest.raises(OptionError, match=r"^balance takes Möbius images, which have another repulsion than the curve"):
        minimize(*wanted(SQUARE, balance=True, avoid=(plate(9.0),)))


def test_where_nothing_can_move_nothing_hops() -> None:
    result = minimize(*wanted(SQUARE, pins=(0, 1, 2, 3), hops=2))
    assert result.message.endswith("nothing can move: the curve is pinned, or straight between pins")


def test_hops_of_what_lengths_alone_hold_lead_nowhere() -> None:
    """A vertex in the plane between two pins, at given distances from both, moves neither way."""
    corner = Curve.from_components([[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]], [False])
    result = minimize(*wanted(corner, pins=(0, 2), vertices=3, hops=1, max_iterations=5))
    np.testing.assert_array_equal(result.curve.vertices, corner.vertices)


def test_straight_arcs_do_not_hop() -> None:
    """Their energy is the least of all, and a share of it is rounding."""
    result = minimize(overhand(60), RelaxOptions(hops=2))
    assert result.status is Status.CONVERGED
    assert "hop" not in result.message


def test_hops_keep_pins() -> None:
    arc = overhand(60)
    result = minimize(*wanted(arc, pins=(0, 59), hops=1, max_iterations=90))
    assert "hops that lowered" in result.message or result.status is Status.ITERATION_LIMIT
    np.testing.assert_array_equal(result.curve.vertices[list(result.last.pins)], arc.vertices[[0, 59]])


def test_no_hop_is_recommended_to_what_is_confined() -> None:
    """A circle pressed flat between walls is an unknot and no circle, and can become none."""
    ellipse = regular_polygon(60).with_vertices(regular_polygon(60).vertices * [2.0, 0.4, 1.0])
    walls = [Obstacle(wall.vertices[:, [0, 2, 1]], wall.faces) for wall in (plate(0.5), plate(-0.5))]
    result = minimize(*wanted(ellipse, avoid=walls))
    assert result.status is Status.CONVERGED
    assert "unknot" not in result.message


def test_parts_between_walls_are_not_held() -> None:
    assert separate_parts(two_rings(6.0)) == (0, 1)
    assert separate_parts(two_rings(6.0), (box(-9.0, 9.0),)) == (0, 0)
    result = minimize(*wanted(two_rings(5.0), avoid=(box(-9.0, 9.0),), vertices=60, tolerance=0.1))
    assert result.status is Status.CONVERGED
    assert HELD not in result.message


def test_parts_far_from_obstacles_are_held() -> None:
    post = Obstacle([[0.0, 0.0, 5.0], [0.0, 0.0, 6.0]], [[0, 1]])
    assert separate_parts(two_rings(90.0), (post,)) == (0, 1)
    assert separate_parts(two_rings(6.0), (rod(1e4, 0.0),)) == (0, 1)


def test_parts_that_are_all_pinned_are_not_said_to_be_held() -> None:
    """But one without a pin is."""
    options = {"vertices": 60, "max_iterations": 300}
    pinned = minimize(*wanted(two_rings(9.0), pins=(0, 30), **options))
    assert pinned.status is Status.CONVERGED
    assert HELD not in pinned.message
    assert HELD in minimize(*wanted(two_rings(9.0), pins=(0,), **options)).message


def test_balls_and_obstacles() -> None:
    ball = Ball(np.array([0.0, 0.0, 2.0]), 1.0)
    assert ball.is_clear_of(plate(0.99))
    assert not ball.is_clear_of(plate(1.01))
    assert ball.is_clear_of(rod(1.01, 0.0))
    assert not ball.is_clear_of(Obstacle([[0, 0, 2], [0, 0, 3]], [[0, 1]]))
    assert ball.is_clear_of(box(-9.0, 9.0))  # a surface: the ball is inside


@pytest.mark.parametrize(("post", "composite"), [((9.0, 9.0), True), ((0.0, 0.0), False)])
def test_a_knotted_part_around_a_post_does_not_shrink(
    post: tuple[float, float], composite: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(links, "knotted_ball", lambda curve: Ball(np.zeros(3), 1.0))
    curve = knot("3_1#3_1", 60)  # so few that its strands are not resolved
    size = float(np.abs(curve.vertices).max())
    far = curve.with_vertices(curve.vertices / size * 3.0 + [20.0, 0.0, 0.0])
    result = minimize(*wanted(far, vertices=None, mesh="fixed", tolerance=0.2, avoid=(rod(*post),)))
    assert ("is composite" in result.message) == composite


def test_arcs_in_links_are_not_asked_whether_they_are_composite() -> None:
    """Linking numbers, which that takes, are those of closed components."""
    trefoils = [opened(knot("3_1", vertices=60), 0).vertices + np.array([0.0, 0.0, 12.0 * k]) for k in range(2)]
    curve = Curve.from_components([*trefoils, straight_arc(4).vertices + 90.0], [False, False, False])
    result = minimize(curve, RelaxOptions(tolerance=1.0, vertices=130, mesh="fixed"))
    assert result.status is Status.CONVERGED
