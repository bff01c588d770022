"""A run on a baked curve that ends by undo from the menu, or by a new file; undo of something else does not end it."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import here, key, window
from interruption import over, relax, undo
from scene import is_, iterate, obj, points, reaches, ready, run


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
    yield from reaches(iterate() + 1)
    yield from key("Z", ctrl=True)
    yield from until(lambda: len(bpy.data.objects) == 1, "undo of something else")
    yield from reaches(iterate() + 2)
    window().view_layer.objects.active = bpy.data.objects["5_2"]
    assert obj().data.shape_keys is None, "the run goes on"
    undo()
    yield from over("undo of what was before the run")
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
