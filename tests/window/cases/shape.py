"""The panel Shape by mouse clicks: a relaxed knot is balanced, kept in size, laid flat; undo step by step."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, button, core, here, key, open_panels, open_sidebar, window
from scene import clear, is_, knot, look, obj, points


def case() -> Steps:
    open_panels("shape")
    clear()
    knot("5_2", vertices=400)
    window().scene.mobius_flow.length = 100
    yield from open_sidebar()
    yield from look()
    yield from button("curve.mobius_flow_relax")
    yield from is_("done")
    yield from look()
    yield from picture("shape-1-relaxed")
    keys, unbalanced = count(), bending()
    with here():
        bpy.ops.curve.mobius_flow_continue("INVOKE_DEFAULT", balance=True)
    yield from until(lambda: addon("live.registry").current() is not None, "the run")
    yield from is_("done")
    assert count() > keys + 20
    assert bending() < 0.8 * unbalanced
    yield from look()
    yield from picture("shape-2-balanced", differs_from="shape-1-relaxed")

    window().scene.mobius_flow.keep_size = "BOX"
    before = points()
    yield from button("curve.mobius_flow_keep_size")
    yield from until(lambda: not np.array_equal(points(), before), "the keys to be scaled")
    yield from picture("shape-3-kept", differs_from="shape-2-balanced")

    yield from button("curve.mobius_flow_lay_flat")
    yield from until(lambda: height() < 0.9 * width(), "the knot to lie flat")
    yield from look()
    yield from picture("shape-4-flat", differs_from="shape-3-kept")
    yield from key("Z", ctrl=True)
    yield from until(lambda: tuple(obj().rotation_euler) == (0, 0, 0), "undo of Lay Flat")
    yield from key("Z", ctrl=True)
    yield from until(lambda: np.array_equal(points(), before), "undo of Keep Size")
    assert addon("curves.bake").is_baked(obj().data)
    assert not addon("curves.bake").is_edited(obj().data)
    yield from picture("shape-5-undone")


def count() -> int:
    """Number of keys."""
    return len(obj().data.shape_keys.key_blocks)


def bending() -> float:
    """That of the last key."""
    last = addon("curves.recorded").BakedKeys([obj()]).curves[-1]
    return float(core("curve.measures").bending(last))


def _extents() -> np.ndarray:
    with here():
        curve = addon("curves.recorded").BakedKeys([obj()]).curves[-1]
    return np.ptp(curve.vertices, axis=0)


def height() -> float:
    """Extent upwards at the last key."""
    return float(_extents()[2])


def width() -> float:
    """The lesser extent sideways."""
    return float(_extents()[:2].min())
