"""However a run in a window ends, what is not kept is as it was before, and the last words say why."""

import re
import sys
import threading

import bpy
import mobius_flow
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, contents, evaluated, relax, stored
from families import crossed
from mobius_flow.addon.curves import keyframes
from mobius_flow.addon.live import handlers, registry
from mobius_flow.addon.live.modal import status_line
from mobius_flow.addon.live.run import RunState
from mobius_flow.core.keys.recording import Kind
from mobius_flow.core.ropes import tightening
from modal_operator import Operator, everything, restored, ring_and_torus, rings, splines_of
from shapes import lattice_knot, torus_trefoil


def smooth(kind):
    """A link whose points and splines have settings of their own."""
    rng = np.random.default_rng(7)
    obj = add_curve([torus_trefoil(14).vertices + 3 * k for k in (0, 4)], kind=kind)
    for spline in obj.data.splines:
        for point in spline.bezier_points if kind == "BEZIER" else spline.points:
            point.radius, point.tilt = rng.random(2)
            if kind == "BEZIER":
                point.handle_left_type = point.handle_right_type = "AUTO"
    obj.data.splines[1].material_index, obj.data.splines[0].use_smooth = 2, False
    return {"vertices": 0}


def beside():
    return {"avoid": [ring_and_torus()[1]]}


def film(**values):
    """A baked curve, drawn at its first frame."""
    add_trefoil()
    relax(max_iterations=3)
    bpy.context.scene.frame_set(1)
    return {"vertices": 0} | values


SCENES = {
    "curve": add_trefoil,
    "POLY": lambda: smooth("POLY"),
    "BEZIER": lambda: smooth("BEZIER"),
    "NURBS": lambda: smooth("NURBS"),
    "rings": rings,
    "beside a torus": beside,
    "film": film,
    "film that goes on": lambda: film(continues=True),
}


def begin(operator, scene, steps=2):
    given = scene()
    operator.given |= given if isinstance(given, dict) else {}
    operator.continues = operator.given.pop("continues", False)
    before = everything()
    assert operator.start() == {"RUNNING_MODAL"}
    operator.reach(steps)
    return before


def edit(_operator):
    bpy.ops.object.mode_set(mode="EDIT")  # of all selected objects
    return "is being edited"


def disable(_operator):
    mobius_flow.unregister()
    mobius_flow.register()
    return "Möbius Flow was disabled; all is as it was"


def close(operator):
    operator.cancel(operator.context)
    return "The window was closed; all is as it was"


def press(*key, **modifiers):
    def act(operator):
        assert operator.event(*key, **modifiers) == {"CANCELLED"}
        return "Cancelled; all is as it was"

    return act


ENDINGS = {"Esc": press("ESC"), "Ctrl Z": press("Z", ctrl=True), "edit": edit, "disable": disable, "close": close}


@pytest.mark.parametrize(("scene", "ending"), crossed(SCENES, ENDINGS))
def test_all_is_put_back(operator, scene, ending):
    before = begin(operator, SCENES[scene])
    said = ENDINGS[ending](operator)
    assert operator.event() == {"CANCELLED"}
    assert operator.run.state is (RunState.LOST if ending == "edit" else RunState.CANCELLED)
    assert said in operator.reports[-1][1]
    if ending == "edit":
        assert bpy.context.mode == "EDIT_CURVE"
        bpy.ops.object.mode_set(mode="OBJECT")  # which leaves the points of the active key in a film's curve
    kept = [name for name in before if ending != "edit" or "film" not in scene or name not in ("splines", "all")]
    after = everything()
    assert {name: after[name] for name in kept} == {name: before[name] for name in kept}


def test_points_that_were_added_meanwhile_are_taken_away(operator):
    operator.given |= {"tolerance": 1e-3}
    before = begin(operator, lambda: add_curve([lattice_knot("5_1").vertices]) and {"vertices": 0}, 1)
    spline = bpy.context.object.data.splines[0]
    given = len(spline.points)
    operator.until(lambda: len(bpy.context.object.data.splines[0].points) > given)
    operator.event("ESC")
    assert everything() == before


def test_keys_that_are_half_written_are_taken_away(operator, monkeypatch):
    written = keyframes.write

    def failing(*arguments):
        written(*arguments)
        if arguments[0].name == "B":
            raise MemoryError

    monkeypatch.setattr(keyframes, "write", failing)
    before = begin(operator, rings)
    operator.until(lambda: False)
    assert operator.reports[-1] == ({"ERROR"}, "Memory ran out; all is as it was")
    assert everything() == before


def remove(obj):
    bpy.data.objects.remove(obj)
    return "was deleted"


def enter(obj):
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    return "is being edited"


def give_keys(obj):
    obj.shape_key_add(name="Mine")
    return "was given shape keys"


def add_point(obj):
    obj.data.splines[0].points.add(1)
    return "were added or removed"


def move(obj):
    obj.location.x += 1e-3
    bpy.context.view_layer.update()
    return "was moved against the others"


def give_data(obj):
    obj.data = obj.data.copy()
    return "was given other curve data"


ALL, OTHERS = ", and every curve is as it was", ", and the others are as they were"
TO_CURVES = (remove, give_keys, add_point, give_data)


@pytest.mark.parametrize(
    ("scene", "name", "act", "rest"),
    [
        *(("rings", "B", act, OTHERS) for act in TO_CURVES),
        *(("curve", "Knot", act, "") for act in TO_CURVES),
        ("rings", "B", move, ALL),
        ("beside a torus", "Ring", move, ALL),
        *(("beside a torus", "Torus", act, ALL) for act in (remove, enter, move)),
    ],
)
def test_what_somebody_does_is_left_and_ends_the_run(operator, scene, name, act, rest):
    before = begin(operator, SCENES[scene])
    obj = bpy.data.objects[name]
    said = act(obj)
    theirs = None if act is remove or obj.type != "CURVE" else (obj.data, splines_of(obj.data))
    assert operator.event() == {"CANCELLED"}
    assert operator.run.state is RunState.LOST
    assert re.fullmatch(f"(Points of )?'{name}' {said}; the relaxation has ended{rest}", operator.reports[-1][1])
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for each in (each for each in bpy.data.objects if each.type == "CURVE" and (each.name != name or rest == ALL)):
        restored(each, before["all"][each.name])
    if theirs is not None and act is not move:
        assert (obj.data, splines_of(obj.data)) == theirs


def test_a_curve_that_avoids_nothing_may_be_moved_and_renamed(operator):
    begin(operator, add_trefoil)
    obj = bpy.context.object
    obj.location.x += 1
    obj.name, obj.data.name = "Other", "Other"
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.names == ("Other",)
    assert obj.data.name == "Other", "it was given to a stand-in"
    operator.start()
    operator.reach(1)
    obj.data.name = "Another"
    operator.run.cancel()
    assert obj.data.name == "Another"


@pytest.mark.parametrize("operator", ["process"], indirect=True)
def test_loading_a_file_ends_the_worker(operator):
    begin(operator, add_trefoil)
    bpy.ops.wm.read_homefile(use_empty=True)
    assert operator.run.state is RunState.CANCELLED
    assert operator.run._worker.process.poll() is not None
    operator.cancel(operator.context)


@pytest.mark.parametrize("operator", ["process"], indirect=True)
def test_a_worker_that_dies_loses_nothing(operator):
    operator.given["vertices"] = 400
    begin(operator, add_trefoil, 1)
    operator.run._worker.process.kill()
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.failed
    assert operator.reports[-1][0] == {"WARNING"}
    assert bpy.context.object.data.shape_keys is not None


def test_undo_of_something_else_does_not_end_a_run(operator):
    """Blender runs no undo without a window; the handlers are called as it would call them."""
    before = begin(operator, add_trefoil)["all"]["Knot"]
    obj = bpy.context.object
    registry.history.others = 2
    assert operator.event("Z", ctrl=True) == {"PASS_THROUGH"}
    handlers.HANDLERS["undo_pre"]()
    restored(obj, before)
    shown = operator.run.shown.curve.vertices.astype(np.float32)
    handlers.HANDLERS["undo_post"]()
    np.testing.assert_array_equal(stored(obj.data), shown)
    operator.reach(operator.run.last.index + 1)
    for name in ("redo_pre", "redo_post", "undo_pre", "undo_post"):
        handlers.HANDLERS[name]()
    assert (registry.history.others, registry.history.undone) == (1, 1)
    registry.history.others = 0
    handlers.HANDLERS["undo_pre"]()
    assert registry.current() is None
    restored(obj, before)


def recover():
    return bpy.ops.curve.mobius_flow_recover()


@pytest.mark.parametrize("scene", ["curve", "film", "beside a torus"])
def test_a_cancelled_run_is_recovered(operator, scene):
    operator.given |= {"vertices": 0, "fit_bevel": False}
    before = begin(operator, SCENES[scene], 3)
    obj = bpy.context.object if scene != "beside a torus" else bpy.data.objects["Ring"]
    last = operator.run.last.curve.vertices.astype(np.float32)
    operator.event("ESC")
    assert recover() == {"FINISHED"}
    np.testing.assert_array_equal(evaluated(obj, 250), last)
    assert operator.run.report.certified
    assert operator.run.report.kinds[Kind.STEP] == operator.run.last.index + 1
    with pytest.raises(RuntimeError, match="No relaxation was cancelled"):
        recover()
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    if scene != "film":
        restored(obj, before["all"][obj.name])
    assert len(stored(obj.data)) == (24 if obj.name == "Ring" else 30)


@pytest.mark.parametrize(
    ("scene", "change"),
    [
        ("curve", lambda: setattr(bpy.data.objects["Knot"].data.splines[0].points[3].co, "y", 0.25)),
        ("curve", lambda: bpy.data.objects.remove(bpy.data.objects["Knot"])),
        ("beside a torus", lambda: setattr(bpy.data.objects["Torus"].location, "x", 1)),
    ],
    ids=["a point", "deleted", "what is avoided"],
)
def test_what_has_changed_is_not_recovered(operator, scene, change):
    begin(operator, SCENES[scene])
    operator.event("ESC")
    change()
    bpy.context.view_layer.update()
    before = contents()
    with pytest.raises(RuntimeError, match=r"'.*' changed since the relaxation ended; relax anew"):
        recover()
    assert contents() == before


@pytest.mark.parametrize("drawings", [False, True])
def test_keep_among_several_starts_keeps_the_shortest_so_far(drawings, monkeypatch):
    reached = threading.Event()

    def drawn(curve, *_):
        reached.set()
        while True:
            yield curve

    monkeypatch.setattr(sys.modules[tightening.__module__], "redrawn", drawn)
    obj = add_trefoil()
    before, operator = everything(), Operator(vertices=100)
    operator.more = lambda _context: {"starts": 9}
    assert operator.start() == {"RUNNING_MODAL"}
    if drawings:
        operator.until(reached.is_set)
    operator.run.toggle_pause()
    assert operator.run.last is None
    operator.event("RET")
    operator.event("RET")  # it has been heard
    assert "stopping" in status_line(operator.run)
    if drawings:
        operator.reach(0)
        operator.event("RET")
    assert operator.until(lambda: False) == {"FINISHED" if drawings else "CANCELLED"}
    if drawings:
        assert operator.run.energies[-1] < 34.0, "the way to the end"
        assert len(obj.data.shape_keys.key_blocks) > 2
    else:
        assert operator.run.message == "Stopped before anything had moved"
        assert everything() == before
