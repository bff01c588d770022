"""Each kind of object that shows curves × what its relaxation promises."""

import inspect
import sys

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, contents, sentence, stored
from families import crossed
from mobius_flow.addon.curves.doors import copy_of
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.addon.curves.strands import Strands
from mobius_flow.addon.scripting import Relaxation
from other_kinds import KINDS, KNOT, POINTS, STROKES, THICK, TINT, add_edges, add_hair, add_loop, nodes, points
from processes import finished

FEW = {"max_iterations": 3, "timing": "ITERATE", "radius": "none"}
SEVERAL = ["poly", "edges", *(["strokes"] if STROKES else [])]


def there(points, wanted):
    """The numbers of the points that are at wanted places, (k, 3)."""
    distances = np.linalg.norm(points[:, None] - wanted[None], axis=2)
    assert (distances.min(axis=0) < 1e-5).all()
    return distances.argmin(axis=0)


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_shown_in_motion_with_all_that_it_had(kind):
    source = KINDS[kind]()
    source.location = (1, 2, 3)
    read = Strands.of(source)
    assert bpy.ops.curve.mobius_flow_relax(**FEW) == {"FINISHED"}
    carrier = bpy.context.object
    copy = copy_of(carrier)
    assert carrier.type == "CURVE"
    assert copy.type == source.type
    assert (source.visible_get(), source.hide_render, copy.hide_render) == (False, True, False)
    assert [each.name for each in copy.data.materials] == ["Own"]
    keys = BakedKeys([carrier])
    for frame, key in ((1, 0), (250, -1)):
        bpy.context.scene.frame_set(frame)
        shown = points(copy) @ np.array(copy.matrix_world)[:3, :3].T + np.array(copy.matrix_world)[:3, 3]
        np.testing.assert_allclose(shown, keys.curves[key].vertices, atol=1e-5)
    bpy.context.scene.frame_set(1)
    old = there(points(copy), np.concatenate(read.components))
    for name in {"tint", "radius"} & set(read.attributes):
        np.testing.assert_allclose(points(copy, name, "value", 1)[old, 0], read.attributes[name].values, rtol=1e-5)
    if kind in ("poly", "edges", "strokes"):
        old = there(points(copy), POINTS)
        np.testing.assert_allclose(points(copy, "tint", "value", 1)[old, 0], TINT, atol=1e-6)
        np.testing.assert_allclose(points(copy, "radius", "value", 1)[old, 0], THICK, rtol=1e-5)
    if kind == "loop":
        shown = copy.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        assert "radius" not in shown.attributes, "nodes that come after would make tubes of no thickness"
    if kind == "made":
        assert not any(modifier.name == "Nodes" for modifier in copy.modifiers), "what it made is in the points"
        there(points(copy), KNOT + np.float32([0, 0, 2])) if hasattr(bpy.types.Curves, "set_types") else None


def test_what_is_relaxed_a_second_time_is_rendered_as_well():
    source = KINDS["poly"]()
    for _ in range(2):
        source.hide_set(False)
        bpy.ops.object.select_all(action="DESELECT")
        source.select_set(True)
        bpy.context.view_layer.objects.active = source
        bpy.ops.curve.mobius_flow_relax(**FEW)
        assert (source.hide_render, copy_of(bpy.context.object).hide_render) == (True, False)


def test_a_source_stays_hidden_until_the_last_carrier_is_cleared():
    source = KINDS["poly"]()
    bpy.ops.curve.mobius_flow_relax(**FEW)
    first = bpy.context.object
    bpy.ops.object.duplicate()
    bpy.ops.curve.mobius_flow_bake_again(**FEW)
    assert copy_of(first).visible_get()
    for there in (True, False):
        bpy.ops.curve.mobius_flow_clear()
        assert source.visible_get() is not there
        if there:
            first.select_set(True)


@pytest.mark.parametrize("kind", SEVERAL)
def test_clearing_gives_everything_back(kind):
    source = KINDS[kind]()
    before, data = contents(), source.data
    bpy.ops.curve.mobius_flow_relax(**FEW)
    bpy.ops.curve.mobius_flow_continue(**FEW)
    copy_of(bpy.context.object).select_set(True)
    bpy.context.object.select_set(False)
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}, "its copy will do"
    assert contents() == before
    assert (source.data, source.visible_get(), source.hide_render) == (data, True, False)
    assert bpy.context.object == source


def test_it_moves_and_is_rendered_where_there_is_no_extension(tmp_path):
    made = []
    for k, (kind, add) in enumerate(KINDS.items()):
        bpy.ops.object.select_all(action="DESELECT")
        source = add()
        source.location.x = 8 * k
        made.append(kind)
        bpy.ops.curve.mobius_flow_relax(length=20, **FEW)
        copy_of(bpy.context.object).name = kind
    bpy.context.scene.frame_set(20)
    expected = {kind: points(bpy.data.objects[kind]) for kind in made}
    np.savez(tmp_path / "expected.npz", **expected)
    bpy.context.scene.frame_set(1)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "doors.blend"))
    program = f"""
import sys
import bpy
import numpy as np
{inspect.getsource(points)}
bpy.ops.wm.open_mainfile(filepath={str(tmp_path / "doors.blend")!r})
bpy.context.scene.frame_set(20)
for kind, wanted in np.load({str(tmp_path / "expected.npz")!r}).items():
    np.testing.assert_array_equal(points(bpy.data.objects[kind]), wanted)
assert "mobius_flow" not in sys.modules
print("shown")
"""
    done = finished([sys.executable, "-P", "-c", program])
    assert done.stdout.endswith("shown\n"), done.stderr


def morph(source):
    bpy.ops.object.select_all(action="DESELECT")
    goal = {"CURVES": add_hair, "MESH": add_edges}.get(source.type, KINDS.get("strokes"))()
    goal.name, owner = "Goal", goal.data
    if hasattr(owner, "layers"):
        owner = owner.layers[0].frames[0].drawing
    owner.attributes["position"].data[3].vector *= 1.1
    source.select_set(True)
    return bpy.ops.curve.mobius_flow_morph(**FEW)


def pack(source):
    bpy.ops.mesh.primitive_cube_add(size=20)
    bpy.context.scene.mobius_flow_surroundings.container = bpy.context.object
    bpy.context.object.select_set(False)
    source.select_set(True)
    return bpy.ops.curve.mobius_flow_pack(**FEW)


def tighten(source):
    """Pull the knot tight alone: the open curve goes."""
    data = source.data
    if source.type == "MESH":
        data.clear_geometry()
        data.from_pydata(KNOT.tolist(), [(k - 1, k) for k in range(1, len(KNOT))] + [(len(KNOT) - 1, 0)], [])
    elif source.type == "CURVES":
        source.data = data = bpy.data.hair_curves.new("Source")  # 4.2 removes none
        data.add_curves([len(KNOT)])
        data.attributes["position"].data.foreach_set("vector", KNOT.ravel())
        data.attributes.new("cyclic", "BOOLEAN", "CURVE").data.foreach_set("value", [True])
    else:
        data.layers.remove(data.layers[1])
    return bpy.ops.curve.mobius_flow_tighten(vertices=100)


VERBS = {
    "Grab": lambda _: bpy.ops.curve.mobius_flow_grab(**FEW),
    "Pack": pack,
    "Separate": lambda _: bpy.ops.curve.mobius_flow_separate(),
    "Morph": morph,
    "Tighten": tighten,
    "again": lambda _: (
        bpy.ops.curve.mobius_flow_relax(**FEW) and bpy.ops.curve.mobius_flow_bake_again(max_iterations=2)
    ),
    "still": lambda _: bpy.ops.curve.mobius_flow_relax(keyframes="RESULT", **FEW),
}


@pytest.mark.parametrize(("kind", "verb"), crossed(SEVERAL, VERBS))
def test_every_verb_takes_it(kind, verb):
    source = KINDS[kind]()
    assert VERBS[verb](source) == {"FINISHED"}
    (copy,) = (each for each in map(copy_of, bpy.data.objects) if each is not None)
    (carrier,) = (obj for obj in bpy.data.objects if copy_of(obj) == copy)
    assert copy.type == source.type
    bpy.context.scene.frame_set(250)
    np.testing.assert_allclose(points(copy), stored(carrier.data), atol=1e-5)


def empty():
    add_hair().data = bpy.data.hair_curves.new("Empty")


def gone():
    add_hair().modifiers.new("Nodes", "NODES").node_group = nodes("GeometryNodeDeleteGeometry")
    bpy.context.object.data = bpy.data.hair_curves.new("Empty")


def shorn():
    tree = nodes("GeometryNodeDeleteGeometry")
    add_hair().modifiers.new("Nodes", "NODES").node_group = tree
    return tree


def cut():
    shorn().nodes.new("GeometryNodeSetPosition")  # which might move something


def dot():
    data = bpy.data.hair_curves.new("Dot")
    data.add_curves([5, 1])
    data.attributes["position"].data.foreach_set("vector", np.arange(18, dtype=np.float32))
    add_hair().data = data


def far():
    add_hair().data.attributes["position"].data[30].vector = (np.inf, 0, 0)


def doubled():
    points = add_loop().data.vertices
    points[1].co = points[0].co


def fur():
    data = bpy.data.hair_curves.new("Fur")
    data.add_curves([4] * 100_000)
    add_hair().data = data


def branch():
    mesh = bpy.data.meshes.new("Tree")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1), (0, 2), (0, 3)], [])
    add_edges().data = mesh


def blank():
    data = KINDS["strokes"]().data
    data.layers.remove(data.layers[0])
    group = data.layer_groups.new("Hidden")
    data.layers.move_to_layer_group(data.layers[0], group)
    group.hide = True


def edit():
    add_loop()
    bpy.ops.object.mode_set(mode="EDIT")


def flat():
    add_hair().scale.z = 0


BAD = {
    empty: "'Source' shows no curves; draw some, or see what its modifiers do",
    gone: "'Source' shows no curves; draw some, or see what its modifiers do",
    shorn: "'Source' shows no curves; draw some, or see what its modifiers do",
    cut: "'Source' shows no curves; draw some, or see what its modifiers do",
    dot: "Spline 2 of 'Source' has fewer than 2 points; give it more, or delete it",
    far: " of spline 2 of 'Source' is not finite, or further away than anything; repair or delete it",
    doubled: " of spline 1 of 'Source'",
    fur: "'Source' has 100000 curves, and at most 1000 are relaxed together; make an object of a few",
    branch: "Edges of 'Source' branch, or none is selected beside faces; choose loops or paths",
    **({blank: "'Source' shows no curves; draw some, or see what its modifiers do"} if STROKES else {}),
    edit: "'Source' is being edited; go back to Object Mode first",
    flat: "'Source' is scaled to nothing in some direction; give it a scale other than 0",
}


@pytest.mark.parametrize("spoil", BAD, ids=lambda spoil: spoil.__name__)
def test_bad_input_is_one_sentence_and_changes_nothing(spoil):
    spoil()
    bpy.context.view_layer.update()
    before = contents()
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.curve.mobius_flow_relax(**FEW)
    assert BAD[spoil] in sentence(caught.value)
    assert contents() == before


def test_edges_without_a_thickness_are_no_ropes():
    add_loop()
    with pytest.raises(RuntimeError, match="'Source' has no thickness; give its points an attribute named radius"):
        bpy.ops.curve.mobius_flow_separate()


@pytest.mark.skipif(not STROKES, reason="this Blender has other strokes")
def test_layers_without_an_attribute_have_its_usual_value():
    source = KINDS["strokes"]()
    first, second = (layer.frames[0].drawing for layer in source.data.layers)
    second.attributes.remove(second.attributes["radius"])
    first.attributes.new("opacity", "FLOAT", "POINT").data.foreach_set("value", np.full(len(KNOT), 0.5, np.float32))
    second.set_types(type="NURBS") if hasattr(second, "set_types") else None
    read = Strands.of(source)
    size = len(read.components[0])
    for name, usual in (("radius", 0.01), ("opacity", 1.0)):
        np.testing.assert_allclose(read.attributes[name].values[size:], usual, rtol=1e-5)
    bpy.ops.curve.mobius_flow_relax(**FEW)
    assert points(copy_of(bpy.context.object), "opacity", "value", 1)[-1] == pytest.approx(1.0)


def test_modifiers_come_after_the_motion():
    source = add_edges()
    source.modifiers.new("Skin", "SKIN")
    report = Relaxation(source).relax(**FEW)
    assert report.modified
    assert [each.type for each in copy_of(bpy.context.object).modifiers] == ["NODES", "SKIN"]


def test_a_curve_object_that_is_selected_too_leaves_solids_alone():
    solid, knot = add_loop(), add_trefoil()
    solid.select_set(True)
    bpy.ops.curve.mobius_flow_relax(**FEW)
    assert knot.data.shape_keys is not None
    assert solid.visible_get()


def test_another_source_is_refused():
    source = add_hair()
    bpy.ops.curve.mobius_flow_relax(**FEW)
    source.data = add_hair("POLY").data.copy()
    bpy.context.object.select_set(False)
    data = bpy.data.hair_curves.new("Other")
    data.add_curves([5])
    data.attributes["position"].data.foreach_set("vector", np.arange(15, dtype=np.float32) ** 2)
    source.data = data
    bpy.data.objects["Source Keys"].select_set(True)
    before = contents()
    with pytest.raises(RuntimeError, match="has other points than what it was made of; delete it, and relax that"):
        bpy.ops.curve.mobius_flow_bake_again(**FEW)
    assert contents() == before


def ended(way, operator, path):
    """End a run, or let it be disturbed and then end it."""
    if way == "saved":
        bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    elif way == "dragged":
        operator.run.session.hide()
        operator.run.session.resume()
    elif way == "deleted":
        bpy.data.objects.remove(bpy.data.objects["Source Keys"])
        operator.event()
    operator.run.cancel()


@pytest.mark.parametrize(("kind", "way"), crossed(SEVERAL, ["cancelled", "saved", "dragged", "deleted"]))
def test_a_run_that_ends_without_a_result_leaves_no_trace(operator, tmp_path, kind, way):
    source = KINDS[kind]()
    before, operator.given["vertices"] = contents(), 0
    operator.start()
    operator.reach(2)
    assert copy_of(bpy.context.object) is not None, "it is seen to move"
    ended(way, operator, str(tmp_path / "saved.blend"))
    assert contents() == before
    assert source.visible_get()
    assert not source.hide_render
    if way == "saved":
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "saved.blend"))
        assert contents() == before
