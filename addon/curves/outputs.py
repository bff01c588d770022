"""Objects made of curve objects, in the same place and shown instead of them."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy

# a matrix in their stead would be split into these anew, and lose shear and the last bits
_PLACE = (
    "rotation_mode",
    "location",
    "rotation_euler",
    "rotation_quaternion",
    "rotation_axis_angle",
    "scale",
    "delta_location",
    "delta_rotation_euler",
    "delta_rotation_quaternion",
    "delta_scale",
    "parent_type",
    "parent",
    "parent_bone",
    "parent_vertices",
    "matrix_parent_inverse",
)


def object_like(obj: "bpy.types.Object", data: "bpy.types.ID") -> "bpy.types.Object":
    """Make an object of other data with the place and the parent of an object, but not its animation."""
    import bpy

    made = bpy.data.objects.new(data.name, data)
    for name in _PLACE:
        setattr(made, name, getattr(obj, name))
    return made


def put_beside(made: "bpy.types.Object", obj: "bpy.types.Object", hide: bool) -> None:
    """Put a new object into the collections of the one that it is made of, and select it instead."""
    import bpy

    for collection in obj.users_collection:
        collection.objects.link(made)
    made.select_set(True)
    obj.select_set(False)
    layer = bpy.context.view_layer.objects
    if layer.active is None or not layer.active.select_get():
        layer.active = made
    if hide:
        obj.hide_set(True)
        obj.hide_render = True
