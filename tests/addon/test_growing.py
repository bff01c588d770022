"""Curves that grow are keyed: where edges are split on the way, those of earlier keys are split too."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from blender_scenes import add_curve, relax  # noqa: E402
from mobius_flow.addon.curves.baked_keys import BakedKeys  # noqa: E402
from shapes import regular_polygon  # noqa: E402

SHORT = {"grow": 1.2, "max_iterations": 8}


def add_ring():
    return add_curve([regular_polygon(40).vertices * [1.0, 0.8, 1.0]])


def test_keys_grow_and_are_proved():
    obj = add_ring()
    relax(**SHORT)
    keys = BakedKeys([obj])
    lengths = [curve.length for curve in keys.curves]
    assert lengths[-1] == pytest.approx(1.2 * lengths[0], rel=1e-3)
    assert keys.unproved == 0


def test_a_size_that_is_kept_is_kept_while_they_grow():
    obj = add_ring()
    relax(**SHORT, keep_size="BOX")
    keys = BakedKeys([obj])
    boxes = [np.ptp(curve.vertices, axis=0).max() for curve in keys.curves]
    np.testing.assert_allclose(boxes, boxes[0], rtol=1e-5)
    assert keys.unproved == 0
