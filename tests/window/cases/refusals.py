"""One run at a time, and nothing of other files or with keys of its own: the panel says why in one sentence."""

import os

import bpy
import numpy as np
from case import Steps, picture
from hands import here, key, open_sidebar, window
from interruption import is_whole, over, relax
from scene import clear, knot, obj, points, ready

FILE = os.path.join(os.environ["ROOM"], "library.blend")


def case() -> Steps:
    yield from ready()
    before = points()
    first = obj()
    yield from relax()
    refused("'5_2' is being relaxed; stop that first")
    knot("3_1")
    second, untouched = obj(), points()
    assert second != first
    refused("'5_2' is being relaxed; stop that first")
    yield from picture("refusals-1-one-at-a-time")
    yield from key("ESC")
    yield from over("Esc after asking for another run")
    assert np.array_equal(points(), untouched)
    window().view_layer.objects.active = first
    is_whole(before)
    bpy.data.objects.remove(second)

    first.shape_key_add(name="Mine")
    first.select_set(True)
    refused("'5_2' has shape keys; remove them or relax a copy without them")
    yield from picture("refusals-2-shape-keys")
    assert [block.name for block in first.data.shape_keys.key_blocks] == ["Mine"]
    first.shape_key_clear()

    bpy.ops.wm.save_as_mainfile(filepath=FILE, copy=True)
    clear()
    with bpy.data.libraries.load(FILE, link=True) as (_, linked):
        linked.objects = ["5_2"]
    (theirs,) = linked.objects
    window().scene.collection.objects.link(theirs)
    window().view_layer.objects.active = theirs
    theirs.select_set(True)
    yield from open_sidebar()
    refused("'5_2' is linked from another file; make it local first (Object > Relations > Make Local)")
    is_whole(before)
    yield from picture("refusals-3-linked")


def refused(sentence: str) -> None:
    """See that Relax is refused with this sentence."""
    said = ""
    with here():
        try:
            bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT")
        except RuntimeError as error:
            said = str(error).strip()
    assert said.endswith(sentence), said or "not refused"
