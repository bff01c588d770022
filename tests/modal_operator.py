"""A double of the Relax operator that is fed events by hand, and what curves are compared by afterwards."""

import sys
import time
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, contents
from mobius_flow.addon.buttons.relaxing import CURVE_OT_mobius_flow_relax
from mobius_flow.addon.curves.splines import Splines
from mobius_flow.addon.properties import SETTINGS
from mobius_flow.core import MobiusFlowError
from processes import PATIENCE
from shapes import hopf_link


class Operator:
    """A double of the operator: Blender does not let anybody else make one."""

    modal = CURVE_OT_mobius_flow_relax.modal
    cancel = CURVE_OT_mobius_flow_relax.cancel
    begin = CURVE_OT_mobius_flow_relax.begin
    listen = CURVE_OT_mobius_flow_relax.listen
    session = CURVE_OT_mobius_flow_relax.session
    moving = CURVE_OT_mobius_flow_relax.moving
    more = CURVE_OT_mobius_flow_relax.more
    fail = CURVE_OT_mobius_flow_relax.fail
    sample_splines = True

    in_process = False  # the worker

    def __init__(self, continues=False, **values):
        self.events, self.reports, self.continues = None, [], continues
        self.given = {"view_every": 1, "avoid": ()} | values

    def report(self, kind, message):
        self.reports.append((kind, message))

    def start(self, stays=False):
        self.stays = stays
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
        self.values = lambda _context: {name: getattr(scene, name) for name in SETTINGS} | self.given
        with pytest.MonkeyPatch.context() as patch:
            if not self.in_process:
                patch.setattr(sys, "executable", "")  # then there is no Python to start
            try:
                return self.begin(self.context)
            except MobiusFlowError as error:
                return self.fail(error)

    def event(self, kind="TIMER", mouse=(0, 0), value="PRESS", **keys):
        modifiers = {"ctrl": False, "shift": False, "alt": False, "oskey": False} | keys
        event = SimpleNamespace(type=kind, value="NOTHING" if kind == "TIMER" else value, **modifiers)
        event.mouse_x, event.mouse_y = mouse
        return self.modal(self.context, event)

    @property
    def run(self):
        return self.events.run

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


def restored(obj, before):
    """See that an object's splines are as they were, bit for bit."""
    assert splines_of(obj.data) == before


def splines_of(data):
    """All there is to know of the splines of curve data, to be compared."""
    return [
        (each.type, each.count, each.settings, {name: array.tobytes() for name, array in each.points.items()})
        for each in Splines.of(data).each
    ]


def everything():
    """All that a run that is not kept must leave alone: names, curves, keys, and what would be purged."""
    users = {data.name: (data.users, data.use_fake_user) for data in bpy.data.curves}
    return contents() | {"users": users, "all": {data.name: splines_of(data) for data in bpy.data.curves}}


def keys(obj):
    return np.array([[p.co[:] for p in block.data] for block in obj.data.shape_keys.key_blocks])


def rings():
    """Two linked rings, each an object, both selected, one of them scaled."""
    vertices = hopf_link(24).vertices
    pair = [add_curve([vertices[:24]], "A"), add_curve([0.5 * vertices[24:] - [0, 2, 0]], "B")]
    pair[1].scale, pair[1].location = (2, 2, 2), (0, 4, 0)
    bpy.context.view_layer.update()
    return pair


def ring_and_torus():
    """A stretched ring around a mesh, selected, and the mesh."""
    bpy.ops.mesh.primitive_torus_add(major_radius=1, minor_radius=0.25)
    torus = bpy.context.object
    torus.select_set(False)
    return add_curve([hopf_link(24).vertices[24:] * [1.0, 1.0, 4.0]], "Ring"), torus
