"""Curve objects over time: their shapes at their keys, or their only shape, and where these are in the world."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import bpy
import numpy as np
from mathutils import Matrix

from ...core import Curve, CurveError, MobiusFlowError
from ...core.base import FloatArray, Message
from ...core.collision import check_embedded, is_free
from ...core.curve import Mesh, interpolated
from ...core.driver.words import in_blenders_words, named, spline_names
from ...core.keys.markers import along
from ...core.keys.placement import Frame, Link, Measure, Similarity, framed
from ...core.keys.planes import Turn, orthonormal
from . import bake, pins
from .keyframes import fcurves_of, keyed_points
from .moving import what_moves
from .sizes import placement, resume, suspend
from .splines import depth, mesh_of, radii, read
from .strands import Strands, read_link


@dataclass(frozen=True, eq=False)
class Recorded:
    """The shapes of one curve object as they are shown, linear in between, in its own coordinates."""

    mesh: Mesh  # its splines as polygons, a component each
    frames: FloatArray  # scene frames of the shapes, (keys,); a curve that was not baked here has one shape at frame 0
    points: FloatArray  # vertices, (keys, n, 3)
    radii: FloatArray  # their radii relative to the bevel depth, (keys, n)
    keys: FloatArray  # vertices at shape keys, which may be at other frames; (shapes, n, 3)

    @classmethod
    def of(cls, obj: bpy.types.Object) -> "Recorded":
        """Read the splines of a curve object; raises CurveError if they cannot be read."""
        data = obj.data
        if not bake.is_baked(data):
            mesh, points = (each := Strands.of(obj)).mesh, np.concatenate(each.components)[None]
            pieces = zip(data.splines, mesh.component_sizes, strict=True)
            thickness = np.concatenate([along(radii(each), size, each.use_cyclic_u) for each, size in pieces])
            return cls(mesh, np.zeros(1), points, thickness[None], points)
        mesh = mesh_of(data)
        (curve,) = fcurves_of(data.shape_keys)
        # frames between which it runs straight: those of its keys, or all where somebody has bent it
        frames = np.unique(read(curve.keyframe_points, "co", 2)[:, 0]).astype(np.float64)
        if any(point.interpolation != "LINEAR" for point in curve.keyframe_points):
            frames = np.union1d(frames[[0, -1]], np.arange(np.ceil(frames[0]), np.floor(frames[-1]) + 1))
        keyed = list(zip(bake.sizes(data), data.shape_keys.key_blocks, strict=True))
        points = np.stack([size.of(read(block.data, "co", 3).astype(np.float64)) for size, block in keyed])
        thickness = np.stack([size.factor * read(block.data, "radius").astype(np.float64) for size, block in keyed])
        place = np.array([curve.evaluate(frame) for frame in frames]).clip(0, len(points) - 1)
        return cls(mesh, frames, interpolated(points, place), interpolated(thickness, place), points)

    def at(self, places: FloatArray) -> "Recorded":
        """The shapes at places among the keys, see `interpolated`."""
        frames, points, thickness = (interpolated(array, places) for array in (self.frames, self.points, self.radii))
        return replace(self, frames=frames, points=points, radii=thickness)


def in_world(objects: Sequence[bpy.types.Object], recorded: Sequence[Recorded], shapes: Sequence[FloatArray]) -> Curve:
    """Shapes of several objects, (n, 3) each, as one link in world space; raises CurveError where they touch."""
    components = [
        placement(obj).to_world(points[piece])
        for obj, each, points in zip(objects, recorded, shapes, strict=True)
        for piece in each.mesh.slices
    ]
    link = Curve.from_components(components, [flag for each in recorded for flag in each.mesh.closed])
    try:
        check_embedded(link)
    except CurveError as error:
        counts = [len(each.mesh.component_sizes) for each in recorded]
        said = in_blenders_words(str(error), spline_names([obj.name for obj in objects], counts))
        raise CurveError(said) from error
    return link


def world_motion(
    scene: bpy.types.Scene, objects: Sequence[bpy.types.Object]
) -> tuple[FloatArray, list[FloatArray], list[FloatArray], FloatArray]:
    """Sample curve objects at all their keys; where something moves them, at all frames of the scene too.

    Returns ascending scene frames, (frames,), the points of all objects at each of them, (n, 3), first as they are
    `framed`, and the radius of the thickest tube there. In between, points move straight, or nearly so if something
    moves the objects. Modifiers are ignored. Raises CurveError if splines cannot be read.
    """
    recorded = [Recorded.of(obj) for obj in objects]
    moving = any(what_moves(obj) for obj in objects)
    keyed = [each.frames for each in recorded if len(each.frames) > 1]
    every = [np.arange(scene.frame_start, scene.frame_end + 1, dtype=np.float64)] if moving else []
    frames = np.unique(np.concatenate([*keyed, *every] or [np.array([float(scene.frame_start)])]))
    placements = [[placement(obj) for obj in objects]] * len(frames)
    frame_shown = scene.frame_current, scene.frame_subframe
    try:
        for k, frame in enumerate(frames if moving and len(frames) > 1 else ()):
            scene.frame_set(int(frame // 1), subframe=float(frame % 1))
            placements[k] = [placement(obj) for obj in objects]
    finally:
        if (scene.frame_current, scene.frame_subframe) != frame_shown:
            scene.frame_set(frame_shown[0], subframe=frame_shown[1])
    shown = [each.at(np.interp(frames, each.frames, np.arange(len(each.frames)))) for each in recorded]
    mesh = Mesh(*(sum((getattr(each.mesh, part) for each in recorded), ()) for part in ("component_sizes", "closed")))
    points = []
    for k, places in enumerate(placements):
        placed = [place.to_world(each.points[k]) for place, each in zip(places, shown, strict=True)]
        points.append(np.concatenate(placed))
    seen = [framed(Curve(each, mesh)) for each in points]
    radii = [drawn_radius(obj) * each.radii.max(axis=1) for obj, each in zip(objects, shown, strict=True)]
    return frames, seen, points, np.max(radii, axis=0)


def drawn_radius(obj: bpy.types.Object) -> float:
    """How far what is drawn around an object's curve reaches from it where the radius is 1, in the world."""
    data = obj.data
    return float((depth(data) + data.extrude + abs(data.offset)) * placement(obj).stretch)


class BakedKeys:
    """Baked curve objects, their transforms evaluated, at each of their keys.

    ``frames``: points as stored, (n, 3); ``sizes``: how they are shown, in each object's coordinates. Raises
    MobiusFlowError if their numbers of keys differ: then they were not baked together.
    """

    def __init__(self, objects: Sequence[bpy.types.Object]) -> None:
        self.mesh = mesh_of(*(obj.data for obj in objects))
        self.link = Link(tuple(map(placement, objects)), tuple(len(obj.data.splines) for obj in objects))
        self.sizes = [bake.sizes(obj.data) for obj in objects]
        keys = [keyed_points(obj.data) for obj in objects]
        if len({len(each) for each in keys}) > 1:
            title = named([obj.name for obj in objects])
            raise MobiusFlowError(Message("{names} were not baked together; select one of them at a time", names=title))
        self.frames: list[Frame] = [np.concatenate(each) for each in zip(*keys, strict=True)]

    @property
    def curves(self) -> list[Curve]:
        """The link at each key as it is shown, in the world."""
        pieces = list(zip(self.link.placements, self.link.slices(self.mesh), self.sizes, strict=True))
        stored = enumerate(frame.astype(np.float64) for frame in self.frames)
        shown = ([place.to_world(sizes[k].of(p[s])) for place, s, sizes in pieces] for k, p in stored)
        return [Curve(np.concatenate(world), self.mesh) for world in shown]

    @property
    def unproved(self) -> int:
        """Number of straight motions from key to key, as stored, that are not proved free of contact."""
        common = [self.link.to_common(self.mesh, frame) for frame in self.frames]
        return sum(not is_free(self.mesh, a, b) for a, b in pairwise(common))


def keep_size(objects: Sequence[bpy.types.Object], measure: Measure, reference: int) -> BakedKeys:
    """Show all keys scaled about their barycenters to the size of one of them, and the tubes drawn around them alike.

    Points stay as stored, and `core.keys.placement` says why that makes no contact. Raises MobiusFlowError if the
    objects were not baked together, or points of them are pinned.
    """
    if any(pins.count(obj.data) for obj in objects):
        raise MobiusFlowError(Message("Scaling would move pinned points; unpin them first"))
    keys = BakedKeys(objects)
    curves = keys.curves
    changes = [Similarity.giving(measure, measure.of(curves[reference]), curve) for curve in curves]
    for obj, place, shown in zip(objects, keys.link.placements, keys.sizes, strict=True):
        local = [place.similarity(change) for change in changes]
        bake.resize(obj, [more.after(size) for more, size in zip(local, shown, strict=True)])
    return keys


def turn(objects: Sequence[bpy.types.Object], camera: bpy.types.Object | None = None) -> int:
    """Turn curves, at the end of their animation if they are baked, so that they extend least upwards.

    With a camera, so that it sees their widest side, the longest axis across the picture.  Returns the number of
    motions of keys that are not proved any more. Raises MobiusFlowError if something moves one of the objects, or its
    parent's scale would shear it, or if all points are the same.
    """
    baked = all(bake.is_baked(obj.data) for obj in objects)
    shape = BakedKeys(objects).curves[-1] if baked else read_link(objects)[0]
    turn = Turn.onto(shape, np.eye(3))
    if camera is not None:
        view = np.array(camera.matrix_world, dtype=np.float64)
        axes = view[:3, :3].T.copy()
        if camera.data.type != "ORTHO":
            axes[2] = view[:3, 3] - turn.center
        turn = Turn.onto(shape, orthonormal(axes))
    for obj in objects:
        if mover := what_moves(obj):
            sentence = "'{name}' is moved by {mover}; remove that first"
            raise MobiusFlowError(Message(sentence, name=obj.name, mover=mover))
        if obj.parent and not any(obj in each.children_recursive for each in objects):
            # whether a location, rotation and scale under the parent give the turned object; angles of matrices that
            # Blender has rounded count as right to 1e-5
            matrix, own = (np.array(each, dtype=np.float64)[:3, :3] for each in (obj.matrix_world, obj.matrix_basis))
            columns = np.linalg.solve(matrix @ np.linalg.inv(own), turn.rotation @ matrix)
            columns /= np.linalg.norm(columns, axis=0)
            if not np.allclose(columns.T @ columns, np.eye(3), atol=1e-5):
                sentence = "'{name}' would change its shape, as its parent's scale is uneven; remove that first"
                raise MobiusFlowError(Message(sentence, name=obj.name))
    for obj in objects:
        suspend(obj)
    there = {obj: Matrix(turn.matrix.tolist()) @ obj.matrix_world for obj in objects}
    for obj in sorted(objects, key=lambda each: -len(each.children_recursive)):  # parents carry their children along
        obj.matrix_world = there[obj]
        bpy.context.view_layer.update()
    for obj in objects:
        resume(obj)
    bpy.context.view_layer.update()
    # a single object may go anywhere; the positions of several relative to each other are rounded anew
    return BakedKeys(objects).unproved if baked and len(objects) > 1 else 0
