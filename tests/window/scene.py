"""Curves to relax, and what is going on with them."""

from typing import Any

import bpy
import numpy as np
from case import Steps, until
from hands import addon, core, here, key, open_sidebar, window


def knot(name: str = "5_2", vertices: int = 400) -> None:
    """Add a knot and look at it."""
    window().scene.mobius_flow.vertices = vertices
    window().scene.mobius_flow.timing = "DISTANCE"  # its keys are the iterates
    with here():
        bpy.ops.curve.mobius_flow_add_knot(knot=name)
        bpy.ops.ed.undo_push(message="Knot added")


def clear() -> None:
    """Remove what the factory's file has."""
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)


def ready(name: str = "5_2", vertices: int = 400) -> Steps:
    """A knot, selected, and the sidebar open."""
    clear()
    knot(name, vertices)
    yield from open_sidebar()
    yield from look()


def add(name: str, *components: Any, cyclic: bool = True, bevel: float = 0.0) -> bpy.types.Object:
    """A curve object with these splines, selected and active."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions, data.bevel_depth = "3D", bevel
    for points in components:
        spline = data.splines.new("POLY")
        spline.points.add(len(points) - 1)
        spline.use_cyclic_u = cyclic
        spline.points.foreach_set("co", np.pad(points, ((0, 0), (0, 1)), constant_values=1.0).ravel())
    made = bpy.data.objects.new(name, data)
    window().scene.collection.objects.link(made)
    window().view_layer.objects.active = made
    made.select_set(True)
    return made


def look() -> Steps:
    """Look at the knot as it is now."""
    with here():
        bpy.ops.view3d.view_selected()
    yield


def endless() -> None:
    """Let runs not be over by themselves, however slowly Blender draws."""
    settings = window().scene.mobius_flow
    settings.method, settings.tolerance, settings.max_iterations = "flow-l2", 1e-9, 1_000_000


def obj(name: str = "") -> bpy.types.Object:
    """The knot, or the object of that name; found anew every time, as undo makes it anew."""
    return bpy.data.objects[name] if name else window().view_layer.objects.active


def points(name: str = "") -> np.ndarray:
    """All coordinates of the knot, bit for bit."""
    return np.array([p.co[:] for spline in obj(name).data.splines for p in spline.points], dtype=np.float32)


def keys(name: str = "") -> list[np.ndarray]:
    """Shapes of the keys, bit for bit; (n, 3) each."""
    blocks = obj(name).data.shape_keys.key_blocks if obj(name).data.shape_keys else ()
    return [np.array([p.co[:] for p in block.data], dtype=np.float32) for block in blocks]


def steps() -> list[np.ndarray]:
    """Those of the keys that are iterates, changes of mesh among them, without what is shown in between."""
    blocks = obj().data.shape_keys.key_blocks if obj().data.shape_keys else ()
    return [each for each, block in zip(keys(), blocks, strict=True) if not block.name.startswith("Between")]


def in_world(name: str = "", local: Any = None) -> np.ndarray:
    """Points of the knot in the world, by default those that are stored; shape (n, 3)."""
    matrix = np.array(obj(name).matrix_world)
    return (points(name) if local is None else local)[:, :3].astype(float) @ matrix[:3, :3].T + matrix[:3, 3]


def linking_number(a: np.ndarray, b: np.ndarray) -> int:
    """That of two closed polygons."""
    (number,) = core("knots.diagrams").linking_numbers(core().Curve.from_components([a, b]))
    return int(number)


def latest() -> Any:
    """The run that is going on, or else the last one, or None."""
    return addon("live.registry").latest()


def run() -> Any:
    """The run that is going on, or None."""
    return addon("live.registry").current()


def said() -> str:
    """The message of the last run, once it is over."""
    return str(latest().message) if run() is None else ""


def state() -> str:
    """How the latest run is, or 'none'."""
    return latest().state.name.lower() if latest() else "none"


def iterate() -> int:
    """Number of the iterate that is shown, -1 before the first."""
    return latest().last.index if latest() and latest().last else -1


def reaches(index: int) -> Steps:
    """Wait until an iterate is shown."""
    yield from until(lambda: iterate() >= index, f"iterate {index}")


def is_(wanted: str) -> Steps:
    """Wait until the run is in a state."""
    yield from until(lambda: state() == wanted, f"the run to be {wanted}, not {state()}", 200)


def undone(condition: Any, what: str) -> Steps:
    """Press Ctrl-Z once, and wait until something is undone."""
    yield from key("Z", ctrl=True)
    yield from until(condition, f"undo of {what}")
