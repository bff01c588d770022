"""Growth: lengths become a multiple of those of the start, by proved motions, as far as there is room for that."""

import json

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh, OptionError, Status, minimize, relax
from mobius_flow.core.collision import thickness
from mobius_flow.core.curve.pins import Pins
from mobius_flow.core.curve.refine import SPLIT
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.knots import torus_knot
from mobius_flow.core.solve.constraints import Constraints
from shapes import regular_polygon
from solids import box, plate, rod
from tasks import proved, wanted

WALLS = box(-1.5, 1.5)
SADDLED = regular_polygon(32).with_vertices(
    np.column_stack([regular_polygon(32).vertices[:, :2], 0.1 * np.cos(4 * np.pi * np.arange(32) / 32)])
)


def in_the_box(factor, **more):
    return {"curve": SADDLED, "grow": factor, "avoid": [WALLS], "vertices": 32, "max_iterations": 45} | more


def lengths(curve):
    return np.array([curve.edge_lengths[s].sum() for s in curve.mesh.edge_slices])


def test_a_curve_in_a_box_grows_to_three_times_its_length():
    """A circle three times as long would reach through the walls: the curve has folded."""
    result, _ = proved(**in_the_box(3.0))
    assert np.abs(result.curve.vertices).max() < 1.5
    assert result.curve.length == pytest.approx(3.0 * SADDLED.length, rel=1e-6)
    assert result.last.edge_length_error < 1e-9
    assert json.loads(json.dumps(result.report()))["grown"] == pytest.approx(3.0, rel=1e-12)
    assert "grew to 3 of 3 times its length" in result.message
    cut, _ = proved(**in_the_box(3.0, max_iterations=8))
    assert cut.status is Status.ITERATION_LIMIT
    assert 1.0 < cut.last.grown < 3.0
    assert cut.energies == result.energies[:9], "equal runs have equal results"
    assert "of 3 times its length" in cut.message


def test_a_rope_is_packed_as_one():
    """It touches neither the walls nor itself."""
    result, _ = proved(**in_the_box(3.0, radius=0.1))
    assert result.last.grown == pytest.approx(3.0)
    assert result.last.radius == (0.1,)
    assert np.abs(result.curve.vertices).max() < 1.5 - 0.1


def test_a_rope_grows_twentyfold_and_shrinks_until_it_is_in_its_own_way():
    """It stays as thin; a circle's edges become as short as arcs of the radius need them."""
    trefoil = torus_knot(2, 3, 30)
    grown, iterates = proved(
        trefoil, grow=20.0, radius=0.95 * thickness(trefoil), vertices=30, mesh="fixed", max_iterations=1
    )
    assert grown.last.grown == pytest.approx(20.0)
    assert len(iterates[1].path) > 1, "no proof reaches that far at once"
    shrunk, _ = proved(regular_polygon(12), grow=0.1, radius=0.5, vertices=12, mesh="fixed")
    assert shrunk.last.grown == pytest.approx(0.5 / np.cos(np.pi / 12), rel=0.02)
    assert "edge 1 and edge 2 too near, or costs too much energy" in shrunk.message
    assert shrunk.outcome.place is not None


def test_edges_are_split_as_walls_come_near():
    """In the end, too: a curve that has grown bends as narrowly as walls are near."""
    result = minimize(*wanted(**in_the_box(3.0, mesh="finer", max_iterations=60)))
    assert result.last.grown == pytest.approx(3.0, rel=1e-12)
    problem = start_problem(*wanted(result.curve, vertices=len(result.curve), avoid=[WALLS]))
    coarse = result.curve.edge_lengths * 2.0 / problem.clearance(result.curve)
    assert 0.5 < coarse.max() < 1.1 * SPLIT
    above = {"pins": (0, 8, 16, 24), "avoid": [plate(-0.05)], "vertices": 32, "max_iterations": 16}
    assert len(minimize(*wanted(regular_polygon(32), mesh="adaptive", **above)).curve) > 64


def test_what_has_no_room_stops_and_says_how_far_it_has_come():
    """A loop cannot be pulled through the rods that it goes round."""
    loop = regular_polygon(24)
    loop = Curve(np.column_stack([loop.vertices[:, :2], np.zeros(24)]))
    rods = [rod(0.5, 0.0), rod(-0.5, 0.0)]
    result = minimize(*wanted(loop, grow=0.1, avoid=rods, vertices=24, max_iterations=150))
    assert result.certified
    assert result.status is Status.STALLED
    assert 1.0 / np.pi < result.last.grown < 0.4  # the loop is π times as long as it is around the rods
    assert f"grew to {result.last.grown:.6g} of 0.1 times its length" in result.message
    assert result.last.edge_length_error < 1e-9


def test_arcs_between_pins_grow_and_shrink_to_the_distance_of_their_ends():
    curve = regular_polygon(24)
    result = minimize(*wanted(curve, grow=1.5, pins=(0, 12), vertices=24, mesh="fixed", max_iterations=60))
    assert result.certified
    assert np.array_equal(result.curve.vertices[[0, 12]], curve.vertices[[0, 12]])
    assert result.curve.length == pytest.approx(1.5 * curve.length, rel=1e-6)
    with pytest.raises(OptionError, match=r"grow makes the arc between vertices 1 and 13, which are pinned, 0\.9"):
        relax(*wanted(curve, grow=0.6, pins=(0, 12), vertices=24))
    with pytest.raises(OptionError, match="all edges lie between pinned vertices"):
        relax(*wanted(curve, grow=2.0, pins=tuple(range(24)), vertices=24))
    constraints = Constraints.of(curve, Pins.of(curve, np.array([0, 1]))).scaled(2.0, curve.mesh)
    np.testing.assert_array_equal(constraints.lengths, curve.edge_lengths * ([1.0] + 23 * [2.0]))


def bow(rise):
    """An arc of unit length between its ends, all but straight."""
    x = np.linspace(0.0, 1.0, 25)
    return Curve(np.column_stack([x, rise * np.sin(np.pi * x), np.zeros(25)]), Mesh((25,), (False,)))


@pytest.mark.parametrize(
    ("rise", "factor", "more"),
    [
        # their energy is nearly 0, and to first order no motion makes them longer
        *((rise, 2.0, {"pins": (0, 24), "max_iterations": 80}) for rise in (0.1, 1e-2, 1e-3)),
        # it is 0, to which nothing that growth costs is small
        (0.0, 3.0, {"pins": (12,), "max_iterations": 40}),
        (0.0, 3.0, {"avoid": [box(-9.0, 9.0)], "max_iterations": 40}),
    ],
    ids=["bent", "nearly taut", "taut", "pinned", "confined"],
)
def test_arcs_that_are_nearly_straight_grow(rise, factor, more):
    result, _ = proved(bow(rise), grow=factor, vertices=25, mesh="fixed", **more)
    assert result.last.grown == pytest.approx(factor, rel=1e-9)
    assert result.curve.length == pytest.approx(factor * bow(rise).length, rel=1e-6)
    with pytest.raises(OptionError, match=r"or on straight arcs between them; .* or bend the arcs"):
        relax(*wanted(bow(0.0), grow=2.0, pins=(0, 24), vertices=25))


def test_hops_do_not_grow_again():
    result = minimize(*wanted(**in_the_box(1.2, hops=1, max_iterations=30, tolerance=1e-2)))
    assert result.last.grown == pytest.approx(1.2, rel=1e-12)
    assert result.curve.length == pytest.approx(1.2 * SADDLED.length, rel=1e-6)
