"""A stage in an artist's scene: in a collection of its own, replaced when it is set up anew, gone without a trace.

What belongs to it is marked. A scene's own camera and world stay in the file while the stage's are used instead: its
collection holds on to them, and gives them back.
"""

from collections.abc import Sequence
from contextlib import suppress

import bpy
import numpy as np

from ...core import CurveError
from ..curves.recorded import WorldMotion
from ..curves.splines import read
from ..curves.surroundings import STAGE, TUBE_OF
from ..engine.colours import COMPONENT
from . import stage
from .looks import DEFAULT, LOOKS
from .materials import colour_components

_NAME = "Stage"
# of its collection: what the scene had before, and what it was set up around
_CAMERA, _WORLD, _SHOWN = "mobius_flow_camera", "mobius_flow_world", "mobius_flow_shown_"


def set_up(
    scene: bpy.types.Scene,
    objects: Sequence[bpy.types.Object],
    use_camera: bool = True,
    use_world: bool = True,
    look: str = DEFAULT,
) -> bpy.types.Collection:
    """Put a camera, lights and a floor around curve objects for as long as they move; an existing stage is replaced.

    The objects' transforms are evaluated. ``use_camera`` and ``use_world`` say whether the scene is rendered by the
    stage's camera and under its sky, instead of its own. Curves without materials of their own get those of the
    ``look`` until the stage is struck, if it is one of `LOOKS`. Raises CurveError if splines cannot be read, or are a
    single point; nothing has changed then.
    """
    motion = WorldMotion.of(scene, objects)
    ground = stage.Stage.around(motion.points, np.array([0.0, 0.0, 1.0]))
    if not ground.size:
        raise CurveError("All points of the curves are the same; move them apart")
    strike(scene)
    collection = bpy.data.collections.new(_NAME)
    scene.collection.children.link(collection)
    style = LOOKS.get(look, LOOKS[DEFAULT])
    collection[STAGE] = _aspect(scene)
    floor = stage.build(collection, ground, style)
    floor.hide_select = True  # it is in the way of every click
    eye = stage.follow(collection, _shape(scene), ground, floor, motion.points, motion.radii, motion.frames)
    for obj in collection.objects:
        obj[STAGE] = True
    if look in LOOKS:
        _paint(objects, look)
    for k, obj in enumerate(objects):
        collection[f"{_SHOWN}{k}"] = obj
    if use_camera:
        collection[_CAMERA], scene.camera = scene.camera, eye
    if use_world:
        collection[_WORLD], scene.world = scene.world, bpy.data.worlds.new(_NAME)
        scene.world[STAGE] = True
        stage.add_sky(scene.world, style)
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
        _remove(sky)
    for obj in [each for each in collection.objects if STAGE in each]:
        _remove_object(obj)
    _strip(_shown(collection))
    for name in [each for each in collection.keys() if each.startswith("mobius_flow")]:  # noqa: SIM118
        del collection[name]
    if not collection.all_objects:
        _remove(collection)


def restyle(scene: bpy.types.Scene, look: str) -> None:
    """Give a scene's stage, if it has one, another look; curves that are gone, or no longer curves, are left out."""
    collection = own_stage(scene)
    if collection is None or look not in LOOKS:
        return
    objects = [obj for obj in _shown(collection) if obj.name in scene.objects]
    camera_used, world_used = (block is not None and STAGE in block for block in (scene.camera, scene.world))
    with suppress(CurveError):
        set_up(scene, objects, camera_used, world_used, look)


def _shown(collection: bpy.types.Collection) -> list[bpy.types.Object]:
    """The curves that a stage was set up around, but for those that were deleted."""
    found = [value for name, value in collection.items() if name.startswith(_SHOWN)]
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
                _wear(tube.data, obj.data)
        first += len(obj.data.splines)


def _tubes(obj: bpy.types.Object) -> list[bpy.types.Object]:
    """The meshes that were made of a curve's tube."""
    return [each for each in bpy.data.objects if each.type == "MESH" and each.get(TUBE_OF) == obj]


def _wear(tube: bpy.types.Mesh, curve: bpy.types.Curve) -> None:
    """Give a tube's mesh the materials that its curve's splines have."""
    for material in curve.materials:
        tube.materials.append(material)
    component = read(tube.attributes[COMPONENT].data, "value").astype(np.intp)
    corner = read(tube.loops, "vertex_index", 1, np.int32)[read(tube.polygons, "loop_start", 1, np.int32)]
    slots = np.array([spline.material_index for spline in curve.splines], dtype=np.int32)
    tube.polygons.foreach_set("material_index", slots[(component - component.min())[corner]])


def _strip(objects: Sequence[bpy.types.Object]) -> None:
    """Take a stage's materials from curves, and those that nothing else uses out of the file, with their images."""
    for obj in [*objects, *(tube for each in objects for tube in _tubes(each))]:
        materials = [each for each in obj.data.materials if each is not None and STAGE in each]
        if materials and len(materials) == len(obj.data.materials):
            obj.data.materials.clear()
        for made in [each for each in materials if not each.users]:
            images = [node.image for node in made.node_tree.nodes if node.type == "TEX_IMAGE"]
            bpy.data.batch_remove([made, *images])


def own_stage(scene: bpy.types.Scene) -> bpy.types.Collection | None:
    return next((each for each in scene.collection.children_recursive if STAGE in each), None)


def key_direction(scene: bpy.types.Scene) -> "Sequence[float] | None":
    """Where the key light of a scene's stage shines from, if there is one; a direction of the world."""
    collection = own_stage(scene)
    lights = [obj for obj in collection.objects if obj.type == "LIGHT" and STAGE in obj] if collection else []
    return tuple(lights[0].matrix_world.col[2][:3]) if lights else None


def fits(scene: bpy.types.Scene) -> bool:
    """Whether a scene renders pictures of the shape that its stage's camera was made for, if it has one."""
    collection = own_stage(scene)
    if collection is None or scene.camera is None or STAGE not in scene.camera:
        return True
    return bool(np.isclose(collection[STAGE], _aspect(scene)))


def _shape(scene: bpy.types.Scene) -> tuple[float, float]:
    render = scene.render
    return render.resolution_x * render.pixel_aspect_x, render.resolution_y * render.pixel_aspect_y


def _aspect(scene: bpy.types.Scene) -> float:
    width, height = _shape(scene)
    return width / height


def _remove_object(obj: bpy.types.Object) -> None:
    """Remove an object with all that nothing else uses: its data, their materials, its motion."""
    data, animation = obj.data, obj.animation_data
    materials = list(getattr(data, "materials", ()))
    action = animation.action if animation is not None else None
    _remove(obj)
    for block in (data, *materials, action):
        if block is not None and not block.users:
            _remove(block)


def _remove(block: bpy.types.ID) -> None:
    bpy.data.batch_remove([block])
