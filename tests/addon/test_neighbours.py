"""What is not relaxed stays as it is: other objects, animation that is there already, other files."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from blender_scenes import add_hopf_link, add_trefoil, fcurves, relax, show, stored  # noqa: E402


def keyed(block):
    """All numbers of a datablock's F-curves."""
    return [(curve.data_path, [tuple(point.co) for point in curve.keyframe_points]) for curve in fcurves(block)]


def test_what_is_not_selected_stays():
    other = add_hopf_link()
    other.select_set(False)
    before = stored(other.data)
    obj = add_trefoil()
    moving = stored(obj.data)
    relax(max_iterations=3)
    np.testing.assert_array_equal(stored(other.data), before)
    assert other.data.shape_keys is None
    assert stored(obj.data).shape != moving.shape or not np.array_equal(stored(obj.data), moving)


def test_two_objects_one_after_the_other():
    first, second = add_trefoil(), add_hopf_link()
    first.select_set(False)
    relax(max_iterations=3)
    result = stored(second.data)
    first.select_set(True)
    second.select_set(False)
    relax(max_iterations=3)
    np.testing.assert_array_equal(stored(second.data), result)
    assert {obj.data.shape_keys is not None for obj in (first, second)} == {True}


def test_the_objects_own_animation_stays():
    obj = add_trefoil()
    for frame, x in ((1, 0.0), (20, 3.0)):
        obj.location.x = x
        obj.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(1)
    before = keyed(obj)
    relax(max_iterations=3)
    assert keyed(obj) == before
    bpy.context.scene.frame_set(20)
    assert obj.location.x == pytest.approx(3.0)


@pytest.mark.parametrize("keyframes", ["SHAPE_KEYS", "FCURVES"])
def test_keys_that_are_there_are_never_overwritten(keyframes):
    obj = add_trefoil()
    relax(max_iterations=3, keyframes=keyframes)
    block = obj.data.shape_keys if keyframes == "SHAPE_KEYS" else obj.data
    before, points = keyed(block), stored(obj.data)
    with pytest.raises(RuntimeError, match="without"):
        relax(max_iterations=3)
    assert keyed(block) == before
    np.testing.assert_array_equal(stored(obj.data), points)


def test_a_library_is_never_written_to(tmp_path):
    add_trefoil()
    library = tmp_path / "library.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(library))
    contents = library.read_bytes()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(library), link=True) as (_, linked):
        linked.objects = ["Knot"]
    (obj,) = linked.objects
    show(obj)
    before = stored(obj.data)
    with pytest.raises(RuntimeError, match="linked from another file"):
        relax()
    np.testing.assert_array_equal(stored(obj.data), before)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "mine.blend"))
    assert library.read_bytes() == contents
