"""Fit Tube and Color Components; what is fitted is in test_bevel."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_hopf_link, add_trefoil, contents, relax, sentence
from mobius_flow.addon.curves import bevel
from mobius_flow.core.keys.colours import PALETTE
from shapes import hopf_link, lattice_knot

BUTTONS = ("fit_tube", "color_components", "tube_mesh", "smooth_curve")


def press(name, **options):
    return getattr(bpy.ops.curve, f"mobius_flow_{name}")(**options)


def colours(obj):
    """The colour of each spline."""
    materials = [obj.data.materials[spline.material_index] for spline in obj.data.splines]
    shaders = [next(n for n in each.node_tree.nodes if n.type == "BSDF_PRINCIPLED") for each in materials]
    return [tuple(shader.inputs["Base Color"].default_value)[:3] for shader in shaders]


def test_each_component_gets_a_colour():
    obj = add_hopf_link()
    obj.data.materials.append(bpy.data.materials.new("Mine"))
    assert press("color_components") == {"FINISHED"}
    assert obj.data.materials[0].name == "Mine", "one's own slots stay"
    assert colours(obj) == [pytest.approx(colour) for colour in PALETTE[:2]]
    assert press("color_components") == {"FINISHED"}
    assert len(obj.data.materials) == 3


def test_components_are_numbered_through_all_objects():
    first, second = (add_curve([part], name) for part, name in zip(hopf_link(24).components, "AB", strict=True))
    press("color_components")
    assert colours(first) + colours(second) == [pytest.approx(colour) for colour in PALETTE[:2]]


def test_more_components_than_colours():
    ring = hopf_link(12).components[0]
    obj = add_curve([ring + np.array([0, 0, 3 * k]) for k in range(7)])
    press("color_components")
    assert len(obj.data.materials) == len(PALETTE)
    assert colours(obj)[5:] == colours(obj)[:2]


def test_colours_and_keys_do_not_mind_each_other():
    obj = add_hopf_link()
    relax(max_iterations=3)
    press("color_components")
    press("fit_tube")
    before = colours(obj)
    relax(max_iterations=2)
    assert colours(obj) == before


def thicknesses(obj):
    """How thick the tube is drawn at each key."""
    data = obj.data
    return data.bevel_depth * np.array([block.data[0].radius for block in data.shape_keys.key_blocks])


def test_a_tube_of_constant_thickness_stays_one_until_it_is_fitted_otherwise():
    obj = add_curve([lattice_knot("4_1").vertices])
    relax(max_iterations=8, vertices=120)
    for constant in (False, True, False):
        press("fit_tube", constant=constant)  # which acts on the finished film
        for _ in range(2):
            assert (np.ptp(thicknesses(obj)) < 1e-6) == constant == bevel.is_constant(obj.data)
            bpy.ops.curve.mobius_flow_relax(max_iterations=8, vertices=120, timing="ITERATE")


def nothing():
    bpy.ops.object.select_all(action="DESELECT")


def edited():
    add_trefoil()
    bpy.ops.object.mode_set(mode="EDIT")


def flat():
    add_trefoil().data.dimensions = "2D"


def infinite():
    add_trefoil().data.splines[0].points[3].co[0] = float("inf")


@pytest.mark.parametrize("name", BUTTONS)
@pytest.mark.parametrize(
    ("arrange", "said"),
    [
        (nothing, "Select a curve object first"),
        (edited, "'Knot' is being edited; go back to Object Mode first"),
        (flat, "'Knot' is a 2D curve; set its Shape to 3D first"),
    ],
)
def test_refusals_say_what_to_do(name, arrange, said):
    arrange()
    before = contents()
    with pytest.raises(RuntimeError) as error:
        press(name)
    assert said in sentence(error.value)
    assert contents() == before


@pytest.mark.parametrize("name", [name for name in BUTTONS if name != "color_components"])
def test_what_cannot_be_read_is_left_alone(name):
    infinite()
    before = contents()
    with pytest.raises(RuntimeError, match="is not finite"):
        press(name)
    assert contents() == before


CROSSED = np.array([[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]])


def test_no_tube_fits_a_curve_that_touches_itself():
    add_curve([CROSSED + 9.0])
    before = contents()
    with pytest.raises(RuntimeError) as error:
        press("fit_tube")
    said = "segment 1 of spline 1 of 'Knot' and segment 3 of spline 1 of 'Knot' touch or cross near (10, 10, 9)"
    assert sentence(error.value).lower().startswith(said.lower())
    assert contents() == before


def test_no_tube_fits_curves_that_touch_each_other():
    ring = hopf_link(24).components[0]
    for name in "AB":
        add_curve([ring], name)
    with pytest.raises(RuntimeError, match=r"spline 1 of 'A' and .* spline 1 of 'B' touch or cross"):
        press("fit_tube")


@pytest.mark.parametrize("name", ["fit_tube", "color_components"])
def test_shared_data_is_not_changed(name):
    obj = add_trefoil()
    twin = bpy.data.objects.new("Twin", obj.data)
    bpy.context.scene.collection.objects.link(twin)
    with pytest.raises(RuntimeError, match="shares its curve data"):
        press(name)


@pytest.mark.parametrize("name", BUTTONS)
def test_tooltips_are_sentences(name):
    description = getattr(bpy.ops.curve, f"mobius_flow_{name}").get_rna_type().description
    assert 20 < len(description) < 300
    assert "\n" not in description
    assert not description.endswith(".")
    assert "  " not in description
