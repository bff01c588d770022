"""Whatever ends a run in a window, nothing of it is left and the curve is whole; undo and redo find it so, too."""

import os

import bpy
import numpy as np
from case import Steps, picture, until
from hands import here, key, window
from interruption import is_whole, over, relax, undo
from scene import is_, iterate, knot, latest, obj, points, reaches, ready, run, undone

FILE = os.path.join(os.environ["ROOM"], "saved.blend")


def undo_and_redo() -> Steps:
    """By key or from the menu, undo ends the run and puts the curve back."""
    yield from ready()
    before = points()
    yield from relax()
    yield from picture("undo-1-running")
    yield from key("Z", ctrl=True)
    yield from over("Ctrl-Z")
    is_whole(before)
    yield from picture("undo-2-ctrl-z", differs_from="undo-1-running")
    yield from relax()
    undo()
    yield from over("Edit > Undo")
    is_whole(before)
    with here():  # no new undo step, or there would be nothing to redo
        bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT")
    yield from reaches(2)
    with here():
        bpy.ops.ed.redo()
    yield from over("Edit > Redo")
    is_whole(before)


def undo_of_something_else() -> Steps:
    """What was done during the run is undone first, and the run goes on."""
    yield from ready()
    before = points()
    yield from relax()
    for by_key in (True, False):
        yield from something_else(by_key)
    yield from picture("undo-3-of-something-else")
    yield from key("Z", ctrl=True)
    yield from over("Ctrl-Z when there is nothing else to undo")
    is_whole(before)

    yield from relax()  # and given up over other steps, of which the first has a preview
    for what in ("Something else", "And another"):
        with here():
            bpy.ops.ed.undo_push(message=what)
        yield from reaches(iterate() + 1)
    yield from key("ESC")
    yield from over("Esc after other undo steps")
    is_whole(before)
    for _ in range(2):
        yield from key("Z", ctrl=True)
        yield
        is_whole(before)
        assert len(bpy.data.curves) == 1
    with here():
        bpy.ops.ed.redo()
    is_whole(before)


def something_else(by_key: bool) -> Steps:
    """Add an object and take it away again while the run goes on."""
    count = len(bpy.data.objects)
    with here():
        bpy.ops.object.empty_add("EXEC_DEFAULT", True)
        window().view_layer.objects.active = bpy.data.objects["5_2"]
    yield from reaches(iterate() + 1)
    if by_key:
        yield from key("Z", ctrl=True)
    else:
        undo()
    yield from until(lambda: len(bpy.data.objects) == count, "undo of something else")
    assert run(), latest().message
    yield from reaches(iterate() + 2)
    window().view_layer.objects.active = bpy.data.objects["5_2"]


def on_a_film() -> Steps:
    """On a baked curve undo brings the keys back, and undo of something else does not end the run."""
    yield from ready()
    before = points()
    yield from relax()
    run().keep()
    yield from is_("done")
    yield from until(lambda: obj().data.shape_keys is not None, "the keys")
    yield from relax()
    assert obj().data.shape_keys is None
    undo()
    yield from over("Edit > Undo on a film")
    assert obj().data.shape_keys is not None, "the keys are there as before the run"
    assert not obj().data.use_fake_user
    yield from picture("film-1-undone")
    yield from relax()
    yield from something_else(by_key=True)
    assert obj().data.shape_keys is None, "the run goes on"
    undo()
    yield from over("undo of what was before the run")
    window().view_layer.objects.active = bpy.data.objects["5_2"]
    assert obj().data.shape_keys is not None
    with here():
        obj().select_set(True)
        bpy.ops.curve.mobius_flow_clear()
    assert np.array_equal(points(), before)


def deletion() -> Steps:
    """Deleting the curve ends the run, and undo brings the whole curve back as it was before."""
    yield from ready()
    before = points()
    yield from relax()
    yield from key("X")
    yield from key("RETURN")  # Blender asks
    yield from over("X", "lost")
    assert not bpy.data.objects[:]
    yield from picture("deletion-1-deleted")
    yield from undone(lambda: obj() is not None, "the deletion")
    is_whole(before)
    for what in ("the object", "its data"):  # the object goes with it
        yield from relax()
        if what == "the object":
            bpy.data.objects.remove(obj())
        else:
            bpy.data.curves.remove(obj().data)
        yield from over(f"removal of {what}", "lost")
        with here():
            bpy.ops.ed.undo_push(message="Removed")
        undo()
        yield from until(lambda: obj() is not None, "undo to bring the curve back")
        is_whole(before)
    yield from picture("deletion-2-whole")


def names_and_files() -> Steps:
    """New names, another frame, another run that is refused and saving do not disturb a run; loading ends it."""
    yield from ready()
    before = points()
    bpy.ops.wm.save_as_mainfile(filepath=FILE)
    yield from relax()
    obj().name, obj().data.name = "Renamed", "Renamed too"
    window().scene.frame_set(7)
    knot("3_1")
    with here():
        assert not bpy.ops.curve.mobius_flow_relax.poll()
    yield from picture("names-1-one-at-a-time")
    bpy.data.objects.remove(obj())
    window().view_layer.objects.active = bpy.data.objects["Renamed"]
    obj().select_set(True)
    yield from reaches(run().last.index + 2)
    assert run().name == "'Renamed'"
    yield from key("ESC")
    yield from over("Esc after new names and another frame")
    is_whole(before)
    assert (obj().name, obj().data.name, window().scene.frame_current) == ("Renamed", "Renamed too", 7)

    for what, load in (
        ("opening a file", lambda: bpy.ops.wm.open_mainfile(filepath=FILE)),
        ("going back to the saved file", bpy.ops.wm.revert_mainfile),
        ("a new file", lambda: bpy.ops.wm.read_homefile(app_template="")),
    ):
        yield from relax()
        load()
        yield from over(what, "none")
        yield
        if what != "a new file":
            is_whole(before)
    assert obj().name == "Cube"
    yield from picture("names-2-new")


PARTS = (undo_and_redo, undo_of_something_else, on_a_film, deletion, names_and_files)
