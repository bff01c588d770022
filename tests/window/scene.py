"""A knot to relax, and what is going on with it."""

from typing import Any

import bpy
import numpy as np
from case import Steps, until
from hands import addon, here, open_sidebar, window


def knot(name: str = "5_2", vertices: int = 400) -> None:
    """Add a knot and look at it."""
    window().scene.mobius_flow.vertices = vertices
    window().scene.mobius_flow.timing = "DISTANCE"  # its keys are the iterates
    with here():
        bpy.ops.curve.mobius_flow_add_knot(knot=name)
        bpy.ops.ed.undo_push(message="Knot added")


def clear() -> None:
    """Remove what the factory's file has."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)


def ready(name: str = "5_2", vertices: int = 400) -> Steps:
    """A knot, selected, and the sidebar open."""
    clear()
    knot(name, vertices)
    yield from open_sidebar()
    yield from look()


def look() -> Steps:
    """Look at the knot as it is now."""
    with here():
        bpy.ops.view3d.view_selected()
    yield


def endless() -> None:
    """Let runs not be over by themselves, however slowly Blender draws."""
    settings = window().scene.mobius_flow
    settings.method, settings.tolerance, settings.max_iterations = "flow-l2", 1e-9, 1_000_000


def obj() -> bpy.types.Object:
    """The knot; found anew every time, as undo makes it anew."""
    return window().view_layer.objects.active


def points() -> np.ndarray:
    """All coordinates of the knot, bit for bit."""
    return np.array([p.co[:] for spline in obj().data.splines for p in spline.points], dtype=np.float32)


def seen() -> np.ndarray:
    """Points of the knot in the world, where a constraint scales it; shape (n, 3)."""
    matrix = np.array(obj().matrix_world)
    return points()[:, :3] @ matrix[:3, :3].T + matrix[:3, 3]


def run() -> Any:
    """The run that is going on, or None."""
    return addon("live.registry").current()


def state() -> str:
    """How the latest run is, or 'none'."""
    latest = addon("live.registry").latest()
    return latest.state.name.lower() if latest else "none"


def iterate() -> int:
    """Number of the iterate that is shown, -1 before the first."""
    latest = addon("live.registry").latest()
    return latest.last.index if latest and latest.last else -1


def reaches(index: int) -> Steps:
    """Wait until an iterate is shown."""
    yield from until(lambda: iterate() >= index, f"iterate {index}")


def is_(wanted: str) -> Steps:
    """Wait until the run is in a state."""
    yield from until(lambda: state() == wanted, f"the run to be {wanted}, not {state()}")
