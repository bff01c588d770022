"""Buttons of the panel Shape, where there is no curve."""

import bpy
import pytest
from blender_scenes import show


@pytest.mark.parametrize("name", ["keep_size", "lay_flat", "face_camera", "continue"])
def test_without_a_curve_the_buttons_say_so(name):
    show(bpy.data.objects.new("Empty", None))
    with pytest.raises(RuntimeError, match="is of type Empty; select a curve object"):
        getattr(bpy.ops.curve, f"mobius_flow_{name}")()
