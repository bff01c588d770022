"""What every button promises: it says what it does, and where it cannot be used it says why and changes nothing."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, contents, linked, relax, sentence, show
from mobius_flow.addon import registration
from mobius_flow.addon.curves import pins
from modal_operator import everything
from shapes import hopf_link, regular_polygon, torus_trefoil

OPERATORS = {
    cls.bl_idname.removeprefix("curve.mobius_flow_"): cls
    for cls in registration.CLASSES
    if issubclass(cls, bpy.types.Operator)
}
BLENDERS = ("rna_type", "align", "location", "rotation")


def operator_of(name):
    return getattr(bpy.ops.curve, f"mobius_flow_{name}")


@pytest.mark.parametrize("name", [name for name in OPERATORS if not name.startswith("preset")])
def test_tooltips_are_sentences(name):
    shown = operator_of(name).get_rna_type()
    own = [each for each in shown.properties if each.identifier not in BLENDERS and "HIDDEN" not in each.tags]
    for said in (shown.description, *(each.description for each in own if not each.is_hidden)):
        assert 5 < len(said) < 320
        assert "\n" not in said
        assert "  " not in said
        assert not said.endswith(".")


def nothing():
    add_trefoil()
    bpy.ops.object.select_all(action="DESELECT")


def empty():
    show(bpy.data.objects.new("Empty", None))


def edited():
    add_trefoil()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curve.select_all(action="DESELECT")


def flat():
    add_trefoil().data.dimensions = "2D"


def infinite():
    add_trefoil().data.splines[0].points[3].co[0] = float("inf")


def shared():
    twin = bpy.data.objects.new("Twin", add_trefoil().data)
    bpy.context.scene.collection.objects.link(twin)


def touching():
    add_curve([np.array([[9.0, 9.0, 9.0], [11.0, 11.0, 9.0], [11.0, 9.0, 9.0], [9.0, 11.0, 9.0]])])


def touching_each_other():
    for name in "AB":
        add_curve([hopf_link(24).components[0]], name)


def baked():
    add_trefoil()
    return relax(max_iterations=3)


def keyed_otherwise():
    baked().shape_key_add(name="Mine")


def keys_edited():
    baked().data.shape_keys.key_blocks[2].data[7].co.x += 0.125


def loop():
    add_trefoil()
    relax(max_iterations=3, timing="EVEN", length=50, loop=True)


def unequal():
    baked().select_set(False)
    add_curve([torus_trefoil(20).vertices + 9.0])
    relax(max_iterations=2)
    bpy.data.objects["Knot"].select_set(True)


def pinned():
    pins.pin(add_trefoil().data.splines[0], np.arange(30) < 2)


def pinned_and_baked():
    pinned()
    relax(max_iterations=2)


def small_container():
    bpy.ops.mesh.primitive_ico_sphere_add(radius=0.5)
    bpy.context.scene.mobius_flow_surroundings.container = bpy.context.object
    bpy.context.object.select_set(False)
    add_curve([regular_polygon(40).vertices])


def hidden_container():
    small_container()
    bpy.data.objects["Icosphere"].scale = (3, 3, 3)
    bpy.context.view_layer.update()
    bpy.data.objects["Icosphere"].hide_set(True)


SELECT = "Select a curve object first"
SMOOTH, BAKES = ("fit_tube", "tube_mesh", "smooth_curve"), ("continue", "bake_again", "clear", "keep_size")
RELAXING = ("relax", "grab", "pack", "morph", "separate", "tighten")
SHAPES = ("lay_flat", "face_camera", "color_components", *SMOOTH)
CASES = {
    nothing: {
        **dict.fromkeys(("pin", "unpin", "set_up_stage", *RELAXING, *BAKES, *SHAPES), SELECT),
        "draw_knot": "Draw a flat curve and select it first",
        "scene_range": "Select a curve that was baked first",
        "avoid": "Nothing near the selected curves is left to avoid",
    },
    empty: dict.fromkeys(("relax", *BAKES, *SHAPES), "'Empty' is of type Empty; select a curve object"),
    edited: {
        **dict.fromkeys(("relax", *SHAPES), "'Knot' is being edited; go back to Object Mode first"),
        **dict.fromkeys(("add_knot", "pick_knot", "draw_knot", "stroke"), "Go back to Object Mode first"),
        "pin": "No points are selected; select some to pin",
        "unpin": "No points of the selected curves are pinned",
    },
    flat: dict.fromkeys(("relax", "set_up_stage", *SHAPES), "'Knot' is a 2D curve; set its Shape to 3D first"),
    infinite: dict.fromkeys(("relax", "lay_flat", *SMOOTH), "is not finite"),
    shared: dict.fromkeys(("relax", "pin", "fit_tube", "color_components"), "shares its curve data 'Knot' with other"),
    touching: dict.fromkeys(
        ("relax", *SMOOTH),
        "egment 1 of spline 1 of 'Knot' and segment 3 of spline 1 of 'Knot' touch or cross near (10, 10, 9)",
    ),
    touching_each_other: dict.fromkeys(("relax", *SMOOTH), "of spline 1 of 'B' touch"),
    add_trefoil: {
        **dict.fromkeys(BAKES, "'Knot' has no keys of Möbius Flow; press Relax first"),
        "scene_range": "Select a curve that was baked first",
        "face_camera": "The scene has no camera; add one first",
        "render_film": "The scene has no camera; press Set Up Stage first",
        "remove_stage": "The scene has no stage; press Set Up Stage first",
        "play_film": "There is no film at this place; press Render Film first",
        "pin": "All splines are closed and have no ends; go to Edit Mode and select the points to pin",
        "unpin": "No points of the selected curves are pinned",
        "morph": "Select a curve, and then the one that it is to become",
        "pack": "Pick a mesh as the container first",
        "separate": "'Knot' has no bevel depth; set it to the rope's radius first",
        "stroke": "Draw in a 3D view",
        "show": "This curve has no problem to show",
        "recover": "No relaxation was cancelled",
        **dict.fromkeys(("pause", "stop", "cancel"), "Nothing is being relaxed"),
    },
    keyed_otherwise: dict.fromkeys(
        ("relax", *BAKES), "'Knot' has other keys or points than it was baked with; undo that, or relax a copy"
    ),
    keys_edited: dict.fromkeys(
        ("relax", *BAKES), "Keys of 'Knot' were edited; undo that, or remove the keys to relax the curve as it is"
    ),
    loop: {"continue": "'Knot' ends where it begins; switch Loop off first"},
    unequal: {"keep_size": "were not baked together; select one of them at a time"},
    pinned_and_baked: {"keep_size": "Scaling would move pinned points; unpin them first"},
    small_container: {"pack": "Put the curves inside the container first"},
    hidden_container: {"pack": "'Icosphere' is hidden; show it first"},
}


@pytest.mark.parametrize("arrange", CASES, ids=lambda arrange: arrange.__name__)
def test_what_cannot_be_done_is_said_and_nothing_changes(arrange):
    arrange()
    bpy.context.view_layer.update()
    before = everything()
    for name, said in CASES[arrange].items():
        with pytest.raises(RuntimeError) as error:
            operator_of(name)()
        assert said in sentence(error.value), name
        assert everything() == before, name


def test_while_curves_are_relaxed_others_have_to_wait(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(1)
    add_curve([torus_trefoil(12).vertices + 9.0], cyclic=False)
    for name in ("mend", "fit_tube", "lay_flat", "set_up_stage", "avoid", "relax"):
        with pytest.raises(RuntimeError, match=f"'{obj.name}' is being relaxed; stop that first"):
            operator_of(name)()
    assert not operator_of("show").poll()


def test_what_is_in_another_file_stays_as_it_is_there(tmp_path):
    baked()
    show(linked(tmp_path / "a.blend", "objects", "Knot"))
    before = contents()
    for name in ("relax", "clear", "color_components", "pin"):
        with pytest.raises(RuntimeError, match="'Knot' is linked from another file; make it local first"):
            operator_of(name)()
    assert contents() == before
