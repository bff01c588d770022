"""Curves whose mesh changes on the way, as by strand moves, are shown and keyed like all others."""

import bpy
import pytest
from blender_scenes import add_curve, relax, stored
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.core.knots import knot

MOVES = {"untangle": "always", "max_iterations": 3}


@pytest.mark.parametrize(("keyframes", "size"), [("SHAPE_KEYS", "AUTO"), ("SHAPE_KEYS", "LENGTH"), ("FCURVES", "BOX")])
def test_strand_moves_are_keyed(keyframes, size, capfd):
    obj = add_curve([knot("goeritz").vertices])
    start = stored(obj.data)
    relax(**MOVES, keyframes=keyframes, keep_size=size, max_keys=60)
    assert "proved free of contact with itself" in capfd.readouterr().out
    keys = BakedKeys([obj])
    assert len(keys.frames) >= 60
    assert keys.unproved == 0
    assert {tuple(point) for point in start} <= {tuple(point) for point in keys.frames[0]}


def test_tubes_are_fitted_at_all_keys():
    obj = add_curve([knot("goeritz").vertices])
    obj.data.bevel_depth = 0.1
    relax(**MOVES, fit_bevel=True)
    assert min(block.data[0].radius for block in obj.data.shape_keys.key_blocks) > 0.0


def test_strand_moves_are_shown(operator):
    obj = add_curve([knot("goeritz").vertices])
    operator.given |= MOVES
    operator.start()
    counts = set()
    operator.until(lambda: counts.add(len(obj.data.splines[0].points)))
    assert operator.run.report.certified
    assert len(counts) < 8  # points change only where there come more
    assert obj.data.shape_keys
    assert bpy.ops.curve.mobius_flow_continue(max_iterations=3, untangle="always") == {"FINISHED"}
    assert BakedKeys([obj]).unproved == 0
