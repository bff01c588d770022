"""A stage in an artist's scene: in a collection of its own, replaced when it is set up anew, gone without a trace.

What belongs to it is marked. A scene's own camera and world stay in the file while the stage's are used instead: its
collection holds on to them, and gives them back.
"""

from collections.abc import Sequence
from contextlib import suppress

import bpy
import numpy as np

from ...core import CurveError
from ...core.keys.colours import COMPONENT
from ..curves.assets import bundled
from ..curves.doors import copy_of
from ..curves.recorded import world_motion
from ..curves.splines import read
from ..curves.surroundings import STAGE, TUBE_OF, WITHOUT_SHAPE
from . import stage
from .looks import LOOKS, ON_STAGE
from .materials import colour_components

_NAME = "Stage"
# of its collection: what the scene had before, and what it was set up around
_CAMERA, _WORLD, _SHOWN = "mobius_flow_camera", "mobius_flow_world", "mobius_flow_shown_"
_LOOK, HIDDEN = "mobius_flow_look", "mobius_flow_hidden_"


def set_up(
    scene: bpy.types.Scene,
    objects: Sequence[bpy.types.Object],
    use_camera: bool = True,
    use_world: bool = True,
    look: str = ON_STAGE,
    hide_others: bool = True,
) -> bpy.types.Collection:
    """Put a camera, lights and a floor around curve objects for as long as they move; an existing stage is replaced.

    The objects' transforms are evaluated. ``use_camera`` and ``use_world`` say whether the scene is rendered by the
    stage's camera and under its sky, instead of its own, ``hide_others`` whether renders leave out all else that has a
    shape, but for what curves avoid. Curves without materials of their own get those of the ``look``, `ON_STAGE` where
    it is none of `LOOKS`. All that lasts until the stage is struck. Raises CurveError if splines cannot be read, or are
    a single point; nothing has changed then.
    """
    frames, seen, points, radii = world_motion(scene, objects)
    ground = stage.Ground.around(seen, np.array([0.0, 0.0, 1.0]))
    if not ground.size:
        raise CurveError("All points of the curves are the same; move them apart")
    strike(scene)
    collection = bpy.data.collections.new(_NAME)
    scene.collection.children.link(collection)
    look = look if look in LOOKS else ON_STAGE
    style = LOOKS[look]
    collection[STAGE], collection[_LOOK] = _aspect(scene), look
    # what renders would show besides curves, their tubes and what they avoid
    around = scene.mobius_flow_surroundings
    spared = {*objects, *map(copy_of, objects), *(tube for obj in objects for tube in _tubes(obj)), around.container}
    spared |= set(around.avoid.all_objects) if around.avoid is not None else set()
    for k, obj in enumerate(scene.objects if hide_others else ()):
        if not (obj.hide_render or obj in spared or obj.type in {*WITHOUT_SHAPE, "EMPTY"}):
            collection[f"{HIDDEN}{k}"], obj.hide_render = obj, True
    floor = stage.build(collection, ground, style)
    floor.hide_select = True  # it is in the way of every click
    eye = stage.follow(collection, (_aspect(scene), 1.0), ground, floor, seen, points, radii, frames)
    for obj in collection.objects:
        obj[STAGE] = True
    _paint(objects, look)
    for k, obj in enumerate(objects):
        collection[f"{_SHOWN}{k}"] = obj
    if use_camera:
        collection[_CAMERA], scene.camera = scene.camera, eye
    if use_world:
        collection[_WORLD], scene.world = scene.world, bundled("worlds", style.label)
        scene.world.name, scene.world[STAGE] = _NAME, True
    return collection


def strike(scene: bpy.types.Scene) -> None:
    """Take a scene's stage away, if it has one; what somebody else put into its collection stays."""
    collection = own_stage(scene)
    if collection is None:
        return
    if scene.camera is not None and STAGE in scene.camera:
        scene.camera = collection.get(_CAMERA)
    if scene.world is not None and STAGE in scene.world:
        sky, scene.world = scene.world, collection.get(_WORLD)
        bpy.data.batch_remove([sky])
    for obj in [each for each in collection.objects if STAGE in each]:
        # with all that nothing else uses: its data, their materials, its motion
        data, animation = obj.data, obj.animation_data
        parts = [data, *getattr(data, "materials", ()), animation.action if animation is not None else None]
        bpy.data.batch_remove([obj])
        for block in parts:
            if block is not None and not block.users:
                bpy.data.batch_remove([block])
    for made in [each for each in _undressed(kept(collection, _SHOWN)) if not each.users]:
        bpy.data.batch_remove([made, *(node.image for node in made.node_tree.nodes if node.type == "TEX_IMAGE")])
    for obj in kept(collection, HIDDEN):
        obj.hide_render = False
    for name in [each for each in collection.keys() if each.startswith("mobius_flow")]:  # noqa: SIM118
        del collection[name]
    if not collection.all_objects:
        bpy.data.batch_remove([collection])


def renew(scene: bpy.types.Scene, look: str = "") -> None:
    """Set up a scene's stage again, if it has one, as it is or in another look; in the look named it is left alone.

    Curves that are gone, or no longer curves, are left out.
    """
    collection = own_stage(scene)
    if collection is None or look == collection.get(_LOOK):
        return
    objects = [obj for obj in kept(collection, _SHOWN) if obj.name in scene.objects]
    look, hidden = look or collection.get(_LOOK, ON_STAGE), bool(kept(collection, HIDDEN))
    camera_used, world_used = (block is not None and STAGE in block for block in (scene.camera, scene.world))
    with suppress(CurveError):
        set_up(scene, objects, camera_used, world_used, look, hidden)


def kept(collection: bpy.types.Collection, which: str) -> list[bpy.types.Object]:
    """The objects that a stage's collection holds on to under a name, but for those that were deleted."""
    found = [value for name, value in collection.items() if name.startswith(which)]
    return [obj for obj in found if obj is not None]


def _paint(objects: Sequence[bpy.types.Object], look: str) -> None:
    """Give curves that have no materials those of a look; components are numbered through all of them."""
    first = 0
    alone = sum(len(obj.data.splines) for obj in objects) == 1
    for obj in objects:
        if not any(obj.data.materials):
            colour_components(obj.data, first, look, np.linspace(0.0, 1.0, 2) if alone else None)
            for made in obj.data.materials:
                made[STAGE] = True
        for tube in _tubes(obj):
            if not any(tube.data.materials):
                # let it have the materials that the curve's splines have
                for material in obj.data.materials:
                    tube.data.materials.append(material)
                component = read(tube.data.attributes[COMPONENT].data, "value").astype(np.intp)
                first_corners = read(tube.data.polygons, "loop_start", 1, np.int32)
                corner = read(tube.data.loops, "vertex_index", 1, np.int32)[first_corners]
                slots = np.array([spline.material_index for spline in obj.data.splines], dtype=np.int32)
                tube.data.polygons.foreach_set("material_index", slots[(component - component.min())[corner]])
        first += len(obj.data.splines)


def _tubes(obj: bpy.types.Object) -> list[bpy.types.Object]:
    """The meshes that were made of a curve's tube."""
    meshes = (each for each in bpy.data.objects if each.type == "MESH" and each.get(TUBE_OF) == obj)
    return [each for each in meshes if each.data.polygons]  # and not of struts


def _undressed(objects: Sequence[bpy.types.Object]) -> list[bpy.types.Material]:
    """Take a stage's materials from curves that have no others, and from their tubes; return them."""
    taken = []
    for obj in [*objects, *(tube for each in objects for tube in _tubes(each))]:
        materials = [each for each in obj.data.materials if each is not None and STAGE in each]
        if materials and len(materials) == len(obj.data.materials):
            obj.data.materials.clear()
            taken += materials
    return list(dict.fromkeys(taken))


def own_stage(scene: bpy.types.Scene) -> bpy.types.Collection | None:
    return next((each for each in scene.collection.children_recursive if STAGE in each), None)


def fits(scene: bpy.types.Scene) -> bool:
    """Whether a scene renders pictures of the shape that its stage's camera was made for, if it has one."""
    collection = own_stage(scene)
    if collection is None or scene.camera is None or STAGE not in scene.camera:
        return True
    return bool(np.isclose(collection[STAGE], _aspect(scene)))


def _aspect(scene: bpy.types.Scene) -> float:
    render = scene.render
    return float(render.resolution_x * render.pixel_aspect_x / (render.resolution_y * render.pixel_aspect_y))
