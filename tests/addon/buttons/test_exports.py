"""What exporters make of the outputs, read back by Blender's importers: as the buttons' tooltips say."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, evaluated, in_world, relax

pytestmark = pytest.mark.filterwarnings("ignore:Setting the shape:DeprecationWarning")  # Blender's own FBX

FRAMES = (1, 4, 8, 20)
LATER = {"fbx": 1}  # frames by which Blender's FBX files come late
MOTION_SETTINGS = {"bake_anim_use_nla_strips": False, "bake_anim_use_all_actions": False}


def operator(name):
    """An operator of Blender's, its extension enabled; a build without it is no failure of ours."""
    import addon_utils

    for extension in ("io_scene_gltf2", "io_scene_fbx"):
        addon_utils.enable(extension)
    module, _, function = name.partition(".")
    found = getattr(getattr(bpy.ops, module), function)
    try:
        found.get_rna_type()
    except KeyError:
        pytest.skip(f"this build of Blender has no bpy.ops.{name}")
    return found


EXPORTERS = {
    "glb": ("export_scene.gltf", {"use_selection": True}, "import_scene.gltf", {}),
    "fbx": ("export_scene.fbx", {"use_selection": True} | MOTION_SETTINGS, "import_scene.fbx", {}),
    "usdc": ("wm.usd_export", {"selected_objects_only": True, "export_animation": True}, "wm.usd_import", {}),
    "abc": (
        "wm.alembic_export",
        {"selected": True, "vcolors": True, "evaluation_mode": "RENDER"},
        "wm.alembic_import",
        {"as_background_job": False},
    ),
}


def through(suffix, path, more=None):
    """Write what is selected to a file, and read it into an empty one; the objects that have points."""
    name, options, importer, how = EXPORTERS[suffix]
    target = str(path / f"out.{suffix}")
    operator(name)(filepath=target, **options | (more or {}))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    operator(importer)(filepath=target, **how)
    bpy.context.view_layer.update()
    return [obj for obj in bpy.data.objects if obj.type in {"MESH", "CURVE", "CURVES"} and len(points_of(obj))]


def points_of(obj):
    return obj.data.points if obj.type == "CURVES" else obj.data.splines if obj.type == "CURVE" else obj.data.vertices


@pytest.fixture
def moving():
    """A tube with shape keys, coloured, and where its vertices are at some frames."""
    obj = add_trefoil(30)
    obj.location, obj.rotation_euler = (1, 2, 3), (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    relax(max_iterations=5, timing="EVEN", length=20)
    bpy.ops.curve.mobius_flow_tube_mesh(color="strand_distance", sides=6, radius=0.3)
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, 20
    tube = bpy.context.object
    return [in_world(tube, evaluated(tube, frame)) for frame in FRAMES]


@pytest.mark.parametrize("suffix", EXPORTERS)
def test_a_tube_keeps_its_motion_and_its_colours_and_usd_attributes_too(suffix, moving, tmp_path):
    mesh, attributes = bpy.context.object.data, {"component", "strand_distance", "energy_density"}
    expected = colours(mesh)
    assert attributes < set(mesh.attributes.keys())
    assert np.abs(moving[0] - moving[-1]).max() > 0.1
    (tube,) = through(suffix, tmp_path)
    for frame, points in zip(FRAMES, moving, strict=True):
        np.testing.assert_allclose(in_world(tube, evaluated(tube, frame + LATER.get(suffix, 0))), points, atol=5e-6)
    np.testing.assert_allclose(colours(tube.data), expected, atol=0.02)
    assert attributes & set(tube.data.attributes.keys()) == (attributes if suffix == "usdc" else set())


def colours(mesh):
    """Mean colour at each vertex."""
    (attribute,) = mesh.color_attributes
    found = np.empty((len(attribute.data), 4), dtype=np.float32)
    attribute.data.foreach_get("color", found.ravel())
    if attribute.domain == "CORNER":
        corners = np.empty(len(mesh.loops), dtype=np.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        at_vertices = np.empty((len(mesh.vertices), 4))
        at_vertices[corners] = found
        found = at_vertices
    return found[:, :3]


def test_fbx_as_it_is_set_by_default_has_no_motion(moving, tmp_path):
    (tube,) = through("fbx", tmp_path, dict.fromkeys(MOTION_SETTINGS, True))
    np.testing.assert_allclose(evaluated(tube, 1), evaluated(tube, 20), atol=1e-6)
