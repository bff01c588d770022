"""Every look can be built, shows what is what, and burns nothing."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_hopf_link, add_trefoil, contents
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector
from mobius_flow.addon.pictures import export, rendering, staging
from mobius_flow.addon.pictures.looks import DEFAULT, LOOKS
from mobius_flow.core.keys.key_options import Playing
from mobius_flow.core.keys.recording import Key, Keys
from shapes import hopf_link, regular_polygon, torus_trefoil

SIZE = (96, 54)


def composed(curve, look):
    """A scene of one key, and its points."""
    scene = rendering.empty_scene()
    rendering.use_cycles(scene, LOOKS[look], *SIZE, 4)
    points = curve.vertices.astype(np.float32)
    export.compose(scene, Keys((Key(0.0, points),), 0), np.ones(1), curve.mesh, Playing(look))
    return scene, points


def rendered(scene, path):
    """The picture as it is seen, from the bottom; (height, width, 3)."""
    rendering.render_still(scene, path)
    image = bpy.data.images.load(str(path))
    return np.array(image.pixels[:]).reshape(image.size[1], image.size[0], -1)[..., :3]


@pytest.mark.parametrize("look", LOOKS)
def test_components_and_the_ground_are_told_apart_and_nothing_is_burnt(look, tmp_path):
    curve = hopf_link(120)
    scene, points = composed(curve, look)
    picture = rendered(scene, tmp_path / "a.png")
    seen = np.array([world_to_camera_view(scene, scene.camera, Vector(p))[:2] for p in points])
    rows, columns = (seen[:, ::-1] * picture.shape[:2]).astype(int).T
    one, other = (np.median(picture[rows[piece], columns[piece]], axis=0) for piece in curve.mesh.slices)
    ground = np.median(picture[[0, -1]].reshape(-1, 3), axis=0)
    for a, b in ((one, other), (one, ground), (other, ground)):
        assert np.abs(a - b).max() > 0.15
    assert (picture.min(axis=2) > 0.97).mean() < 0.005


def test_what_is_symmetric_is_seen_from_one_side_whatever_rounding_says():
    """A Hopf link extends as much in two directions, and is seen as well from two sides."""
    curve, rng = hopf_link(120), np.random.default_rng(1)
    seen = []
    for size in (0.0, 1e-6, 1e-6, 1e-6, 1e-6):
        noise = size * rng.normal(size=curve.vertices.shape)
        scene, _ = composed(curve.with_vertices(curve.vertices + noise), DEFAULT)
        seen.append(np.array(scene.camera.matrix_world))
    assert np.ptp(seen, axis=0).max() < 0.01


@pytest.mark.parametrize("look", LOOKS)
def test_nodes_are_linked_and_a_single_component_has_its_gradient(look):
    scene, _ = composed(torus_trefoil(60), look)
    (material,) = bpy.data.objects["Curve"].data.materials
    tree = material.node_tree
    assert all(link.is_valid for link in tree.links)
    assert "tint" not in tree.nodes
    assert bool(LOOKS[look].gradient) == (tree.nodes.active.name == "gradient")
    assert scene.camera.data.dof.use_dof


def test_files_with_a_stage_are_saved_without_a_warning(tmp_path, capfd):
    add_trefoil().data.bevel_depth = 0.1
    bpy.ops.curve.mobius_flow_set_up_stage()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "staged.blend"))
    said = "".join(capfd.readouterr())
    assert "staged.blend" in said
    assert "clipboard" not in said, (
        "assets saved by bpy.data.libraries.write() are marked as copied; save them as a file"
    )


def test_another_look_replaces_stage_and_materials_and_leaves_no_trace():
    add_trefoil().data.bevel_depth = 0.1
    scene, obj = bpy.context.scene, bpy.context.object
    before = contents()
    scene.mobius_flow_film.look = "NEON"
    bpy.ops.curve.mobius_flow_set_up_stage()
    assert [each.name for each in obj.data.materials] == ["Neon 6"]
    scene.mobius_flow_film.look = "ROPE"
    assert [each.name for each in obj.data.materials] == ["Rope 1"]
    assert len([each for each in scene.objects if each.type == "LIGHT"]) == 2
    scene.mobius_flow_film.look = "QUICK"
    assert staging.own_stage(scene)
    bpy.ops.curve.mobius_flow_remove_stage()
    assert contents() == before
    assert not obj.data.materials
    assert not bpy.data.images


def test_materials_of_your_own_stay():
    obj = add_hopf_link()
    mine = bpy.data.materials.new("Mine")
    obj.data.materials.append(mine)
    staging.set_up(bpy.context.scene, [obj], look="GLASS")
    assert list(obj.data.materials) == [mine]
    staging.strike(bpy.context.scene)
    assert list(obj.data.materials) == [mine]


@pytest.mark.parametrize("look", ["PAPER", "STUDIO"])
def test_cut_out_there_is_nothing_but_the_curve_from_above_and_its_shadow(look, tmp_path):
    export.write_picture(tmp_path / "a.png", regular_polygon(40), 64, 64, look, 4, cut_out=True)
    image = bpy.data.images.load(str(tmp_path / "a.png"))
    picture = np.array(image.pixels[:]).reshape(64, 64, 4)
    distance = np.hypot(*(np.indices((64, 64)) - 31.5))
    tube = picture[..., 3] > 0.98
    assert 0.8 < distance[tube].min() / distance[tube].max() < 1.0  # a circle, and in the middle
    assert picture[[0, 0, -1, -1], [0, -1, 0, -1], 3].max() < 0.2
    shadow = picture[~tube & (distance < 0.8 * distance[tube].min())]
    assert shadow[:, :3].max() < 0.02
    assert shadow[:, 3].min() < 0.9
