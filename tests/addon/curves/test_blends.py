"""In a morph splines take on the materials of what they become, in plain materials, keyed as the motion is."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve
from mobius_flow import Relaxation
from mobius_flow.addon.curves.blends import copied
from mobius_flow.addon.curves.keyframes import fcurves_of

SHORT = {"vertices": 12, "length": 31, "untangle": "never"}
RECTANGLE = np.array([(0.0, 0, 0), (3, 0, 0), (3, 1, 0), (0, 1, 0)])
ZIGZAG = np.array([(0.0, 0, 0), (1, 0, 0.5), (2, 0, 0), (2, 2, -0.5), (1, 1, -1), (0, 2, 0)])
FAR = np.array([9.0, 0, 0])


def material(name, tint):
    made = bpy.data.materials.new(name)
    if made.node_tree is None:
        made.use_nodes = True
    made.diffuse_color = (*tint, 1.0)
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*tint, 1.0)
    return made


def painted(components, *materials):
    obj = add_curve(components)
    for k, each in enumerate(materials):
        obj.data.materials.append(each)
        obj.data.splines[k].material_index = k
    return obj


@pytest.fixture
def red():
    return material("Red", (0.8, 0.0, 0.1))


@pytest.fixture
def blue():
    return material("Blue", (0.0, 0.2, 0.8))


def shares(blend, frame):
    """What Solid shading shows at a frame, and how much of each of the others' shaders there is."""
    flat = [curve.evaluate(frame) for curve in fcurves_of(blend)][:3]
    return flat, [curve.evaluate(frame) for curve in fcurves_of(blend.node_tree)]


def test_a_curve_takes_on_the_materials_on_the_way_and_clear_gives_its_own_back(red, blue):
    moving, there = painted([RECTANGLE], red), painted([ZIGZAG + FAR], blue)
    Relaxation(moving).morph(there, add_curve([RECTANGLE - FAR]), **SHORT)
    blend = moving.material_slots[moving.data.splines[0].material_index].material
    assert blend.name == "Red to Blue to Default"
    (middle,) = [curve.keyframe_points[1].co[0] for curve in fcurves_of(blend) if curve.array_index == 0]
    for frame, flat, share in (
        (1, (0.8, 0.0, 0.1), [0, 0]), (middle, (0.0, 0.2, 0.8), [1, 0]), (31, (0.8, 0.8, 0.8), [1, 1])
    ):  # fmt: skip
        assert shares(blend, frame) == (pytest.approx(flat), pytest.approx(share))
    mixes = [node for node in blend.node_tree.nodes if node.type == "MIX_SHADER"]
    assert [link.to_node.name for mix in mixes for link in mix.outputs[0].links] == [mixes[1].name, "Material Output"]
    tints = [[*mix.inputs[2].links[0].from_node.inputs["Base Color"].default_value] for mix in mixes]
    assert tints == [pytest.approx([0.0, 0.2, 0.8, 1.0]), pytest.approx([0.8, 0.8, 0.8, 1.0])]

    Relaxation(moving).clear()
    assert [*moving.data.materials] == [red]
    assert moving.data.splines[0].material_index == 0
    assert {each.name for each in bpy.data.materials} == {"Red", "Blue"}
    assert not bpy.data.actions


def test_a_loop_takes_them_off_again(red, blue):
    moving = painted([RECTANGLE], red)
    Relaxation(moving).morph(painted([ZIGZAG], blue), loop=True, **SHORT | {"length": 60})
    blend = moving.data.materials[1]
    assert [shares(blend, frame)[1] for frame in (1, 31, 61)] == [[0], pytest.approx([1]), pytest.approx([0])]


def test_each_spline_takes_on_that_of_the_one_it_becomes(red, blue):
    """A large ring and a small one are linked, and come in the other order in what they become."""
    angles = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    large = np.stack([2.0 * np.cos(angles), 2.0 * np.sin(angles), 0.0 * angles], axis=1)
    small = np.stack([2.0 + 0.5 * np.cos(angles), 0.0 * angles, 0.5 * np.sin(angles)], axis=1)
    moving = painted([large, small], red, blue)
    there = painted([small + FAR, large + FAR], blue, red)
    Relaxation(moving).morph(there, **SHORT | {"vertices": 40})
    assert [*moving.data.materials] == [red, blue]
    there.data.splines[0].material_index, there.data.splines[1].material_index = 1, 0
    Relaxation(moving).morph(there, **SHORT | {"vertices": 40})
    worn = [moving.data.materials[spline.material_index].name for spline in moving.data.splines]
    assert worn == ["Red to Blue", "Blue to Red"]


def test_without_keys_it_has_the_last_one(red, blue):
    moving = painted([RECTANGLE], red)
    Relaxation(moving).morph(painted([ZIGZAG], blue), keyframes="RESULT", **SHORT)
    assert moving.data.materials[moving.data.splines[0].material_index] == blue


def test_baking_again_takes_a_blend_off(red, blue):
    moving = painted([RECTANGLE], red)
    Relaxation(moving).morph(painted([ZIGZAG], blue), **SHORT)
    Relaxation(moving).relax(**SHORT)
    assert [*moving.data.materials] == [red]


def test_nodes_are_copied_with_all_that_they_have(blue):
    tree = blue.node_tree
    frame, ramp, curve = (tree.nodes.new(f"ShaderNode{kind}" if kind != "NodeFrame" else kind) for kind in (
        "NodeFrame", "ValToRGB", "RGBCurve"
    ))  # fmt: skip
    ramp.parent, ramp.location, ramp.label = frame, (30, 40), "Stops"
    ramp.color_ramp.interpolation = "CONSTANT"
    ramp.color_ramp.elements[0].color = (0.1, 0.2, 0.3, 1.0)
    ramp.color_ramp.elements.new(0.3).color = (1.0, 0.0, 0.0, 1.0)
    curve.mapping.curves[3].points.new(0.25, 0.75)
    curve.mapping.update()
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image, image.image_user.frame_start = bpy.data.images.new("Picture", 2, 2), 7
    value = tree.nodes.new("ShaderNodeValue")
    value.outputs[0].default_value = 0.4
    group = tree.nodes.new("ShaderNodeGroup")
    group.node_tree = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
    tree.links.new(value.outputs[0], ramp.inputs[0])
    tree.links.new(ramp.outputs[0], curve.inputs[1])

    other = bpy.data.node_groups.new("Other", "ShaderNodeTree")
    copies = copied(tree, other)
    assert len(other.nodes) == len(tree.nodes)
    assert len(other.links) == len(tree.links)
    twin = copies[ramp]
    assert (twin.parent, tuple(twin.location), twin.label) == (copies[frame], (30, 40), "Stops")
    assert twin.color_ramp.interpolation == "CONSTANT"
    stops = [(stop.position, tuple(stop.color)) for stop in ramp.color_ramp.elements]
    assert [(stop.position, tuple(stop.color)) for stop in twin.color_ramp.elements] == stops
    mapping = copies[curve].mapping
    assert [tuple(p.location) for p in mapping.curves[3].points] == [(0, 0), (0.25, 0.75), (1, 1)]
    assert mapping.evaluate(mapping.curves[3], 0.25) == pytest.approx(0.75, abs=1e-3)
    assert (copies[image].image, copies[image].image_user.frame_start) == (image.image, 7)
    assert copies[value].outputs[0].default_value == pytest.approx(0.4)
    assert copies[group].node_tree == group.node_tree
    assert copies[ramp].inputs[0].links[0].from_node == copies[value]
    shader = next(copy for node, copy in copies.items() if node.type == "BSDF_PRINCIPLED")
    assert [*shader.inputs["Base Color"].default_value] == pytest.approx([0.0, 0.2, 0.8, 1.0])
