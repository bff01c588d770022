"""The event loop of the Relax operator, driven by a double of the operator that is fed events by hand.

Without a window Blender runs ``execute`` instead of ``invoke``; ``tests/window`` has the real thing.
"""

import time
from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from blender_scenes import add_curve, add_hopf_link, add_trefoil, stored  # noqa: E402
from mobius_flow.addon import keyframes  # noqa: E402
from mobius_flow.addon.live import registry, worker  # noqa: E402
from mobius_flow.addon.operators import CURVE_OT_mobius_flow_relax  # noqa: E402
from mobius_flow.addon.properties import SETTINGS  # noqa: E402
from mobius_flow.addon.session import State  # noqa: E402
from mobius_flow.addon.snapshot import Snapshot  # noqa: E402
from processes import PATIENCE  # noqa: E402
from shapes import hopf_link, torus_trefoil  # noqa: E402


class Operator:
    """A double of the operator: Blender does not let anybody else make one."""

    modal = CURVE_OT_mobius_flow_relax.modal
    cancel = CURVE_OT_mobius_flow_relax.cancel
    begin = CURVE_OT_mobius_flow_relax.begin

    def __init__(self, **values):
        self.loop, self.reports, self.values = None, [], values

    def report(self, kind, message):
        self.reports.append((kind, message))

    def start(self):
        manager = SimpleNamespace(
            event_timer_add=lambda *_, **__: object(),
            event_timer_remove=lambda _: None,
            modal_handler_add=lambda _: None,
            windows=[],
        )
        self.context = SimpleNamespace(
            window_manager=manager,
            window=None,
            active_object=bpy.context.active_object,
            selected_objects=bpy.context.selected_objects,
            scene=bpy.context.scene,
        )
        bpy.context.view_layer.update()
        scene = bpy.context.scene.mobius_flow
        return self.begin(self.context, {name: getattr(scene, name) for name in SETTINGS} | self.values)

    def event(self, kind="TIMER", **keys):
        modifiers = {"ctrl": False, "shift": False, "oskey": False} | keys
        event = SimpleNamespace(type=kind, value="NOTHING" if kind == "TIMER" else "PRESS", **modifiers)
        event.mouse_x = event.mouse_y = 0
        return self.modal(self.context, event)

    @property
    def run(self):
        return self.loop.run

    def until(self, condition):
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end
            result = self.event()
            time.sleep(0.002)
            if self.run.state.over:
                return result
        return None

    def reach(self, index):
        self.until(lambda: self.run.last is not None and self.run.last.index >= index)


@pytest.fixture
def operator():
    double = Operator(vertices=120)
    yield double
    if double.loop is not None:
        double.run.cancel()
        assert not double.run._worker._thread.is_alive()
    assert registry.current() is None


def restored(obj, before):
    after = Snapshot(obj.data)
    for old, new in zip(before._splines, after._splines, strict=True):
        assert (old.type, old.count, old.settings) == (new.type, new.count, new.settings)
        assert all(np.array_equal(old.points[name], new.points[name]) for name in old.points)


def keys(obj):
    return np.array([[p.co[:] for p in block.data] for block in obj.data.shape_keys.key_blocks])


def test_the_same_curve_as_the_headless_job(operator):
    live, headless = add_trefoil(), add_trefoil()
    live.select_set(False)
    bpy.ops.curve.mobius_flow_relax(vertices=120)
    headless.select_set(False)
    live.select_set(True)
    assert operator.start() == {"RUNNING_MODAL"}
    assert operator.until(lambda: False) == {"FINISHED"}
    np.testing.assert_array_equal(keys(live), keys(headless))
    np.testing.assert_array_equal(stored(live.data), stored(headless.data))
    assert live.data.bevel_depth == headless.data.bevel_depth > 0
    assert operator.reports[-1][0] == {"INFO"}


@pytest.mark.parametrize("kind", ["POLY", "BEZIER", "NURBS"])
def test_esc_restores_bit_for_bit(operator, kind):
    rng = np.random.default_rng(7)
    obj = add_curve([torus_trefoil(24).vertices + 3 * k for k in (0, 4)], kind=kind)
    for spline in obj.data.splines:
        for point in spline.bezier_points if kind == "BEZIER" else spline.points:
            point.radius, point.tilt = rng.random(2)
    obj.data.splines[1].material_index, obj.data.splines[0].use_smooth = 2, False
    before = Snapshot(obj.data)
    operator.values["vertices"] = 0
    operator.start()
    operator.reach(2)
    assert obj.data.splines[0].type == "POLY"
    assert operator.event("ESC") == {"CANCELLED"}
    restored(obj, before)
    assert operator.run.state is State.CANCELLED


def test_every_iterate_is_shown(operator):
    obj = add_trefoil()
    operator.start()
    shown = []
    operator.until(lambda: operator.run.last is not None and shown.append(operator.run.last.index))
    assert sorted(set(shown)) == list(range(operator.run.last.index + 1))
    assert obj.data.shape_keys is not None


def test_pause_and_enter_keep_what_is_shown(operator):
    obj = add_hopf_link()
    operator.start()
    operator.reach(2)
    operator.run.pause()
    shown = stored(obj.data)
    for _ in range(20):
        operator.event()
    np.testing.assert_array_equal(stored(obj.data), shown)
    operator.event("RET")
    assert operator.until(lambda: False) == {"FINISHED"}
    np.testing.assert_array_equal(stored(obj.data), shown)
    assert "stopped after 2 iterations" in operator.run.message
    assert bpy.context.scene.frame_current_final == pytest.approx(operator.run.report.last_frame)


def test_undo_key_is_esc(operator):
    obj = add_trefoil()
    before = Snapshot(obj.data)
    operator.start()
    operator.reach(1)
    assert operator.event("Z", ctrl=True) == {"CANCELLED"}
    restored(obj, before)


def test_other_events_pass_through(operator):
    add_trefoil()
    operator.start()
    assert operator.event("MOUSEMOVE") == operator.event("G") == operator.event() == {"PASS_THROUGH"}


def test_one_at_a_time(operator):
    add_trefoil()
    operator.start()
    second = Operator()
    assert second.start() == {"CANCELLED"}
    assert "is being relaxed; stop that first" in second.reports[0][1]


def test_another_object_has_to_wait(operator):
    obj = add_trefoil()
    before = Snapshot(obj.data)
    operator.start()
    operator.reach(1)
    other = add_hopf_link()
    untouched = Snapshot(other.data)
    second = Operator()
    assert second.start() == {"CANCELLED"}
    assert second.reports == [({"ERROR"}, f"'{obj.name}' is being relaxed; stop that first")]
    operator.event("ESC")
    restored(obj, before)
    restored(other, untouched)


def test_a_bad_curve_is_refused_untouched(operator):
    points = torus_trefoil(30).vertices.copy()
    points[3] = points[2]
    obj = add_curve([points])
    before = Snapshot(obj.data)
    operator.start()
    assert operator.until(lambda: False) == {"CANCELLED"}
    assert operator.reports[-1][0] == {"ERROR"}
    restored(obj, before)


def test_deletion(operator):
    obj = add_trefoil()
    data, before = obj.data, stored(obj.data)
    operator.start()
    operator.reach(1)
    bpy.data.objects.remove(obj)
    assert operator.event() == {"CANCELLED"}
    assert operator.run.state is State.LOST
    np.testing.assert_array_equal(stored(data), before)


def test_a_new_name_does_not_matter(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(1)
    obj.name, obj.data.name = "Other", "Other"
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.names == ("Other",)


def test_topology_change_leaves_what_somebody_made(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(1)
    obj.data.splines[0].points.add(1)
    count = len(obj.data.splines[0].points)
    assert operator.event() == {"CANCELLED"}
    assert len(obj.data.splines[0].points) == count


def test_shape_keys_of_somebody_else_are_left_alone(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(1)
    obj.shape_key_add(name="Mine")
    shown, key = stored(obj.data), keys(obj)
    assert operator.event() == {"CANCELLED"}
    assert operator.run.state is State.LOST
    np.testing.assert_array_equal(stored(obj.data), shown)
    np.testing.assert_array_equal(keys(obj), key)


def test_edit_mode(operator):
    obj = add_trefoil()
    before = Snapshot(obj.data)
    operator.start()
    operator.reach(1)
    bpy.ops.object.mode_set(mode="EDIT")
    assert operator.event() == {"CANCELLED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    restored(obj, before)


def test_a_saved_file_has_the_curve_as_it_was(operator, tmp_path):
    obj = add_trefoil()
    before = stored(obj.data)
    operator.start()
    operator.reach(1)
    shown = stored(obj.data)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"), copy=True)
    np.testing.assert_array_equal(stored(obj.data), shown)
    operator.run.cancel()
    with bpy.data.libraries.load(str(tmp_path / "a.blend")) as (_, loaded):
        loaded.curves = [obj.data.name]
    np.testing.assert_array_equal(stored(loaded.curves[0]), before)


def test_loading_a_file(operator):
    add_trefoil()
    operator.start()
    operator.reach(1)
    bpy.ops.wm.read_homefile(use_empty=True)
    assert operator.run.state is State.CANCELLED
    assert operator.run._worker.process.poll() is not None
    operator.cancel(operator.context)


def test_disabling_ends_the_run(operator, addon):
    obj = add_trefoil()
    before = Snapshot(obj.data)
    operator.start()
    operator.reach(1)
    addon.unregister()
    addon.register()
    assert operator.run.state is State.CANCELLED
    restored(obj, before)


def test_a_worker_that_dies_loses_nothing(operator):
    obj = add_trefoil()
    operator.values["vertices"] = 400
    operator.start()
    operator.reach(1)
    operator.run._worker.process.kill()
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.failed
    assert operator.reports[-1][0] == {"WARNING"}
    assert obj.data.shape_keys is not None


def test_without_a_process_a_thread(operator, monkeypatch):
    monkeypatch.setattr(worker, "_start", lambda: None)
    add_trefoil()
    operator.start()
    assert operator.run._worker.process is None
    assert operator.until(lambda: False) == {"FINISHED"}


def test_esc_while_keys_are_written(operator):
    obj = add_trefoil()
    before = Snapshot(obj.data)
    actions = len(bpy.data.actions)
    operator.start()
    operator.until(lambda: operator.run._writing is not None or operator.run.state is State.FINISHING)
    end = time.monotonic() + PATIENCE
    while operator.run._prepared is None:
        assert time.monotonic() < end
        time.sleep(0.01)
    operator.run._writing = operator.run._session.writing(operator.run._prepared)
    next(operator.run._writing)
    operator.event("ESC")
    restored(obj, before)
    assert obj.data.shape_keys is None
    assert len(bpy.data.actions) == actions


@pytest.fixture
def rings():
    """Two linked rings, each an object, both selected."""
    vertices = hopf_link(24).vertices
    first = add_curve([vertices[:24]], "A")
    second = add_curve([0.5 * vertices[24:] - [0, 2, 0]], "B")
    second.scale, second.location = (2, 2, 2), (0, 4, 0)
    bpy.context.view_layer.update()
    return first, second


def test_two_objects_are_the_headless_job_too(operator, rings):
    bpy.ops.object.duplicate()
    copies = bpy.context.selected_objects
    for obj in copies:
        obj.data = obj.data.copy()
    bpy.ops.curve.mobius_flow_relax(vertices=120)
    for obj in copies:
        obj.select_set(False)
    for obj in rings:
        obj.select_set(True)
    assert operator.start() == {"RUNNING_MODAL"}
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.names == ("A", "B")
    assert "with themselves and each other" in operator.reports[-1][1]
    for live, headless in zip(rings, sorted(copies, key=lambda obj: obj.name), strict=True):
        np.testing.assert_array_equal(keys(live), keys(headless))
        assert live.data.bevel_depth == headless.data.bevel_depth > 0


def test_the_worker_proves_what_is_stored(operator, rings, monkeypatch):
    """Nothing is proved twice: the motions of rounded points of all objects come proved from the worker."""
    again = []
    monkeypatch.setattr(worker, "is_free", lambda *_: again.append(1) or True)
    operator.start()
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.certified
    assert len(again) <= 1, "only the rounding of the start"


def test_esc_restores_all_objects(operator, rings):
    before = [Snapshot(obj.data) for obj in rings]
    operator.start()
    operator.reach(2)
    assert all(len(obj.data.splines[0].points) > 24 for obj in rings)
    assert operator.event("ESC") == {"CANCELLED"}
    for obj, each in zip(rings, before, strict=True):
        restored(obj, each)


def remove(obj):
    bpy.data.objects.remove(obj)
    return "'B' was deleted"


def edit(obj):
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")  # of all selected objects
    return "'A' is being edited"


def give_keys(obj):
    obj.shape_key_add(name="Mine")
    return "'B' was given shape keys"


def add_point(obj):
    obj.data.splines[0].points.add(1)
    return "Points of 'B' were added or removed"


def move(obj):
    obj.location.x += 1e-3
    bpy.context.view_layer.update()
    return "'B' was moved against the others"


def give_data(obj):
    obj.data = obj.data.copy()
    return "'B' was given other curve data"


@pytest.mark.parametrize("act", [remove, edit, give_keys, add_point, move, give_data], ids=lambda act: act.__name__)
def test_what_happens_to_one_object_restores_the_others(operator, rings, act):
    first, second = rings
    before = Snapshot(first.data)
    operator.start()
    operator.reach(2)
    said = act(second)
    assert operator.event() == {"CANCELLED"}
    assert operator.run.state is State.LOST
    rest = "every curve is as it was" if act in (edit, move) else "the others are as they were"
    assert operator.reports[-1][1] == f"{said}; the relaxation has ended, and {rest}"
    restored(first, before)
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    if act in (edit, move):
        assert len(second.data.splines[0].points) == 24


def test_a_single_object_may_be_moved_meanwhile(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(1)
    obj.location.x += 1
    bpy.context.view_layer.update()
    assert operator.until(lambda: False) == {"FINISHED"}


def test_a_file_saved_meanwhile_has_all_objects_as_they_were(operator, rings, tmp_path):
    before = [stored(obj.data) for obj in rings]
    operator.start()
    operator.reach(2)
    shown = [stored(obj.data) for obj in rings]
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"), copy=True)
    for obj, points in zip(rings, shown, strict=True):
        np.testing.assert_array_equal(stored(obj.data), points)
    assert operator.event() == {"PASS_THROUGH"}, "saving does not end the run"
    operator.run.cancel()
    with bpy.data.libraries.load(str(tmp_path / "a.blend")) as (_, loaded):
        loaded.curves = ["A", "B"]
    for data, points in zip(loaded.curves, before, strict=True):
        np.testing.assert_array_equal(stored(data), points)


def test_esc_while_keys_of_the_second_object_are_written(operator, rings):
    before = [Snapshot(obj.data) for obj in rings]
    operator.start()
    operator.until(lambda: operator.run.state is State.FINISHING)
    while operator.run._prepared is None:
        time.sleep(0.01)
    operator.run._writing = operator.run._session.writing(operator.run._prepared)
    while rings[1].data.shape_keys is None:
        next(operator.run._writing)
    operator.event("ESC")
    for obj, each in zip(rings, before, strict=True):
        restored(obj, each)
        assert obj.data.shape_keys is None
        assert obj.data.bevel_depth == 0
    assert len(bpy.data.actions) == 0


def test_an_error_while_keys_are_written_loses_nothing(operator, rings, monkeypatch):
    before = [Snapshot(obj.data) for obj in rings]

    def failing(*arguments):
        yield next(keyframes._shape_keys(arguments[0], arguments[1], arguments[2].scene_frames(arguments[1])))
        raise MemoryError

    monkeypatch.setattr(keyframes, "writing", failing)
    operator.start()
    assert operator.until(lambda: False) == {"CANCELLED"}
    assert operator.reports[-1] == ({"ERROR"}, "Memory ran out; all is as it was")
    for obj, each in zip(rings, before, strict=True):
        restored(obj, each)
        assert obj.data.shape_keys is None
