"""Relax twice, Cancel, Recover, Continue, Set Scene Range and Clear by mouse clicks; each is one undo step."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import button, key, window
from scene import is_, look, obj, points, reaches, ready, run


def case() -> Steps:
    yield from ready(vertices=400)
    before = points()
    yield from baked("curve.mobius_flow_relax", "baking-1-relaxed")
    first = keys()

    yield from button("curve.mobius_flow_relax")
    yield from reaches(3)
    run().toggle_pause()  # finding a button takes a while
    assert obj().data.shape_keys is None, "the original stands in for the baked curve"
    yield from picture("baking-2-relaxed-again", differs_from="baking-1-relaxed")
    yield from button("curve.mobius_flow_cancel")
    yield from is_("cancelled")
    assert np.array_equal(keys(), first), "the baked curve is there again"
    yield from picture("baking-3-cancelled", differs_from="baking-2-relaxed-again")

    yield from button("curve.mobius_flow_recover")
    yield from is_("done")
    assert len(keys()) < len(first)
    assert np.array_equal(keys(), first[: len(keys())]), "what had been reached when it was cancelled"
    yield from picture("baking-4-recovered", differs_from="baking-3-cancelled")
    recovered = keys()

    yield from baked("curve.mobius_flow_continue", "baking-5-continued")
    assert np.array_equal(keys()[: len(recovered)], recovered)
    assert len(keys()) > len(recovered)
    yield from button("curve.mobius_flow_scene_range")
    assert window().scene.frame_start == 1
    assert 250 < window().scene.frame_end <= 500
    yield from picture("baking-6-scene-range")

    yield from baked("curve.mobius_flow_relax", "baking-7-baked-again")
    assert np.array_equal(keys(), first)
    yield from button("curve.mobius_flow_clear")
    yield from until(lambda: obj().data.shape_keys is None, "Clear")
    assert np.array_equal(points(), before)
    assert not bpy.data.actions
    assert not bpy.data.shape_keys
    yield from look()
    yield from picture("baking-8-cleared", differs_from="baking-7-baked-again")

    yield from undone_to(first, "Clear")
    yield from undone_to(recovered, "Relax", part=len(recovered))
    yield from key("Z", ctrl=True)  # Set Scene Range
    yield from until(lambda: window().scene.frame_end == 250, "undo of Set Scene Range")
    yield from undone_to(recovered, "Continue")
    yield from undone_to(first, "Recover")
    yield from key("Z", ctrl=True)
    yield from until(lambda: obj().data.shape_keys is None, "undo of Relax")
    assert np.array_equal(points(), before)
    yield from picture("baking-9-undone")


def baked(operator: str, name: str) -> Steps:
    """Press a button and wait until all is done."""
    yield from button(operator)
    yield from until(lambda: run() is not None, f"{operator} to begin")
    yield from is_("done")
    yield from look()
    yield from picture(name)


def undone_to(wanted: np.ndarray, what: str, part: int | None = None) -> Steps:
    """Press Ctrl-Z once and see which keys are there then, or the first of them."""
    yield from key("Z", ctrl=True)
    yield from until(lambda: np.array_equal(keys()[:part], wanted), f"undo of {what}")


def keys() -> np.ndarray:
    """The keys of the knot; shape (keys, n, 3)."""
    if obj().data.shape_keys is None:
        return np.empty((0, 0, 3))
    return np.array([[p.co[:] for p in block.data] for block in obj().data.shape_keys.key_blocks])
