"""A baked curve that is relaxed again: set aside whole while other curve data stands in for it.

Nothing happens to what is set aside until all is written: to put it back is to give everything back, keys too.
"""

from typing import TYPE_CHECKING, Any

from . import bake
from .exchange import write_points
from .fcurves import own_action
from .keyframes import end_of, erase

if TYPE_CHECKING:
    import bpy


class StandIn:
    """Curve data shown by an object in place of its baked curve.

    Parameters
    ----------
    obj
        A baked curve object.
    continues
        Whether the stand-in is the end of the animation; otherwise it is the curve before it was baked.

    Attributes
    ----------
    continues
        The same.
    """

    def __init__(self, obj: "bpy.types.Object", continues: bool) -> None:
        self.continues = continues
        self._name, self._uid = obj.data.name, obj.data.session_uid
        self._kept = bool(obj.data.use_fake_user)
        end = end_of(obj.data)
        self._set_aside(obj, obj.data.copy())
        try:
            if continues:
                bake.forget(obj)
                write_points(obj.data, end)
            else:
                bake.clear(obj)
        except BaseException:
            self.put_back(obj, obj.data)
            raise

    @property
    def baked(self) -> "bpy.types.Curve":
        """What was set aside."""
        import bpy

        return found(bpy.data.curves, self._name, self._uid)

    def _set_aside(self, obj: "bpy.types.Object", data: "bpy.types.Curve") -> None:
        self.baked.use_fake_user = True  # or purging unused data would remove it
        obj.data = data

    def take_keys(self, obj: "bpy.types.Object") -> None:
        """Where the animation goes on, make the stand-in a copy of the baked curve with its keys, to be added to."""
        if self.continues:
            preview = obj.data
            obj.data = self.baked.copy()
            own_action(obj.data.shape_keys or obj.data)
            _remove(preview)

    def step_aside(self, obj: "bpy.types.Object") -> None:
        """Show the baked curve for a moment, because the file is being saved."""
        self.baked.use_fake_user = self._kept
        obj.data = self.baked

    def step_forward(self, obj: "bpy.types.Object", data: "bpy.types.Curve") -> None:
        """Show the stand-in again after `step_aside`."""
        self._set_aside(obj, data)

    def put_back(self, obj: "bpy.types.Object | None", data: "bpy.types.Curve") -> None:
        """Give the baked curve back to its object, if that is still there, and remove the stand-in."""
        if obj is not None:
            self.step_aside(obj)
        _remove(data)

    def replace(self, data: "bpy.types.Curve") -> None:
        """Remove the baked curve for good; the stand-in takes over its names and its users."""
        baked = self.baked
        names = {kind: block.name for kind, block in _blocks(baked).items()}
        _remove_keys(baked)
        baked.user_remap(data)
        baked.use_fake_user, data.use_fake_user = False, self._kept
        _remove(baked)
        for kind, block in _blocks(data).items():
            block.name = names.get(kind, block.name)


def found(blocks: "bpy.types.bpy_prop_collection", name: str, uid: int) -> Any:
    """A datablock by its identity; it is looked up by its last name first, as there may be thousands."""
    block = blocks.get(name)
    if block is not None and block.session_uid == uid:
        return block
    return next((block for block in blocks if block.session_uid == uid), None)


def _remove(data: "bpy.types.Curve") -> None:
    """Remove curve data with its keys, and the actions that nothing else uses."""
    import bpy

    _remove_keys(data)
    bpy.data.curves.remove(data)


def _remove_keys(data: "bpy.types.Curve") -> None:
    """Remove the keys of curve data that no object has any more: Blender does so for objects only."""
    import bpy

    bare = bpy.data.objects.new(data.name, data)
    erase(bare)
    bpy.data.objects.remove(bare)


def _blocks(data: "bpy.types.Curve") -> dict[str, "bpy.types.ID"]:
    """What belongs to curve data and has a name: itself, its shape keys, and their action or its own."""
    owner = data.shape_keys or data
    action = owner.animation_data.action if owner.animation_data else None
    blocks = {"curve": data, "keys": data.shape_keys, "action": action}
    return {kind: block for kind, block in blocks.items() if block is not None}
