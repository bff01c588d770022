"""A tube that was fitted stays so while its curve moves; one of the artist's own stays as it is."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil
from mobius_flow.addon.curves.bevel import fitting_radius, is_fitted
from mobius_flow.addon.curves.recorded import Recorded

COARSE = 1e-6  # of a radius: Blender keeps 32 bits


@pytest.fixture
def knot():
    """A flat trefoil, stretched by 2, with a tube that fits."""
    obj = add_trefoil()
    obj.scale = (2, 2, 2)
    for point in obj.data.splines[0].points:
        point.co.z *= 0.3
    bpy.context.view_layer.update()
    bpy.ops.curve.mobius_flow_fit_tube()
    return obj


@pytest.mark.parametrize("keep_size", ["LENGTH", "RADIUS"])
def test_it_is_as_thick_as_free_of_contact_allows_at_every_moment(operator, knot, keep_size):
    operator.given |= {"keep_size": keep_size}
    depth, original, depths = knot.data.bevel_depth, knot.data, []
    operator.start()
    for index in (1, 3, 6):
        operator.reach(index)
        depths.append(knot.data.bevel_depth)
        group = operator.run.group
        assert fitting_radius(group.in_view) == pytest.approx(2.0 * depths[-1], rel=COARSE)
    assert len(set(depths)) > 1
    assert max(depths) > 1.05 * depth, "a flat knot is given room"
    operator.run.cancel()
    assert knot.data == original
    assert (knot.data.bevel_depth, is_fitted(knot.data)) == (depth, True)


def test_it_is_kept_as_it_is_shown(operator, knot):
    operator.given |= {"keep_size": "LENGTH", "max_iterations": 8}
    operator.start()
    operator.reach(8)
    shown = knot.data.bevel_depth
    assert operator.until(lambda: False) == {"FINISHED"}
    assert knot.data.bevel_depth == pytest.approx(shown, rel=COARSE)
    assert is_fitted(knot.data)
    assert Recorded.of(knot).radii[-1] == pytest.approx(1.0)


@pytest.mark.parametrize("given", [{"fit_bevel": False}, {}])
def test_an_artists_own_is_not_changed(operator, knot, given):
    operator.given |= given
    if not given:
        knot.data.bevel_depth *= 0.5
    depth = np.float32(knot.data.bevel_depth)
    operator.start()
    operator.reach(4)
    assert knot.data.bevel_depth == depth
    operator.run.cancel()


def test_one_that_somebody_else_takes_over_still_counts_as_fitted(operator, knot):
    operator.start()
    operator.reach(4)
    depth = knot.data.bevel_depth
    knot.data.splines[0].points.add(1)
    operator.event()
    assert operator.run.state.over
    assert (knot.data.bevel_depth, is_fitted(knot.data)) == (depth, True)
