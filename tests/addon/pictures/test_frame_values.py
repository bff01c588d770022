"""Attributes of a tube, worked out by Blender's nodes at every frame, against the library's numbers of its curve."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, evaluated, relax
from mobius_flow.core import Curve
from mobius_flow.core.curve.distances import vertex_positions
from mobius_flow.core.keys.colours import strand_distances
from shapes import hopf_link, regular_polygon, torus_trefoil

SIDES = 6
# Blender computes in 32 bits, and curvature is a second difference; the nearest edge need not be at the nearest vertex,
# which is all that the library looks at
TOLERANCES = {"arc_length": 1e-5, "curvature": 1e-3, "component": 0.0, "strand_distance": 3e-3}


def tube(**options):
    made = bpy.ops.curve.mobius_flow_tube_mesh(radius=0.01, sides=SIDES, every_frame=True, **options)
    assert made == {"FINISHED"}
    return bpy.context.object


def shown(obj):
    """The attributes at the rings, one for each; all vertices of a ring have the same."""
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    found = {}
    for name in TOLERANCES:
        rings = np.array([each.value for each in mesh.attributes[name].data]).reshape(-1, SIDES)
        assert (rings == rings[:, :1]).all()
        found[name] = rings[:, 0]
    return found


def expected(curve):
    """The library's numbers, and the turning angle over the mean length of both edges."""
    curvature = []
    for points, closed in zip(curve.components, curve.mesh.closed, strict=True):
        edges = np.diff(np.concatenate([points[-1:], points, points[:1]]), axis=0)
        lengths = np.linalg.norm(edges, axis=1)
        units = edges / lengths[:, None]
        angles = np.arccos(np.clip((units[1:] * units[:-1]).sum(axis=1), -1.0, 1.0))
        values = angles / (0.5 * (lengths[1:] + lengths[:-1]))
        if not closed:
            values[[0, -1]] = 0.0
        curvature.append(values)
    return {
        "arc_length": vertex_positions(curve),
        "curvature": np.concatenate(curvature),
        "component": curve.mesh.component,
        "strand_distance": strand_distances(curve),
    }


def assert_alike(obj, curve):
    found = shown(obj)
    for name, values in expected(curve).items():
        np.testing.assert_allclose(found[name], values, rtol=TOLERANCES[name], atol=1e-4, err_msg=name)


@pytest.mark.parametrize("cyclic", [True, False])
@pytest.mark.parametrize(
    "components",
    [[torus_trefoil(70).vertices], hopf_link(40).components, [regular_polygon(30).vertices]],
    ids=["knot", "link", "nothing near"],
)
def test_they_are_the_librarys(components, cyclic):
    add_curve(components, cyclic=cyclic)
    assert_alike(tube(), Curve.from_components(components, [cyclic] * len(components)))


def test_they_follow_the_motion_at_keys_and_between_them():
    add_trefoil(40)
    curve = relax(max_iterations=6, vertices=60)
    made = tube()
    seen = []
    for frame in (1, 3.4, 7):
        assert_alike(made, Curve(evaluated(curve, frame).astype(float)))
        seen.append(shown(made)["strand_distance"])
    assert not np.allclose(seen[0], seen[2], rtol=1e-2)


def test_one_group_of_nodes_does_for_all():
    add_curve(hopf_link(40).components)
    first = tube()
    add_trefoil(30)
    assert tube().modifiers[0].node_group == first.modifiers[0].node_group
    assert len(bpy.data.node_groups) == 1
