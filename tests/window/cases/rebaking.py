"""A run on a baked curve that ends by undo from the menu, by a new file, or with something else to be undone."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import here, key, window
from interruption import over, relax, undo
from scene import is_, obj, points, ready, run


def case() -> Steps:
    yield from ready()
    before = points()
    yield from baked()
    yield from relax()
    assert obj().data.shape_keys is None
    undo()
    yield from over("Edit > Undo")
    assert obj().data.shape_keys is not None, "the keys are there as before the run"
    assert not obj().data.use_fake_user
    yield from picture("rebaking-1-undone")

    yield from relax()
    with here():
        bpy.ops.object.empty_add("EXEC_DEFAULT", True)
        window().view_layer.objects.active = bpy.data.objects["5_2"]
    for _ in range(5):
        yield
    yield from key("Z", ctrl=True)
    yield from over("undo of something else while a baked curve is set aside")
    window().view_layer.objects.active = bpy.data.objects["5_2"]
    assert len(bpy.data.objects) == 1
    yield from key("Z", ctrl=True)
    yield
    window().view_layer.objects.active = bpy.data.objects["5_2"]
    assert obj().data.shape_keys is not None
    with here():
        bpy.data.objects["5_2"].select_set(True)
        bpy.ops.curve.mobius_flow_clear()
    assert np.array_equal(points(), before)

    yield from baked()
    yield from relax()
    bpy.ops.wm.read_homefile(app_template="")
    yield from over("a new file", "none")
    yield from picture("rebaking-2-new-file")


def baked() -> Steps:
    """Relax for a moment and keep."""
    yield from relax()
    run().keep()
    yield from is_("done")
    yield from until(lambda: obj().data.shape_keys is not None, "the keys")
