"""Where two relaxed curves meet: Möbius images of both, laid upon each other, and a straight way from one to the other.

All curves that they come to by Möbius maps have the same energy.  The images that bend least are few, so that curves at
the same minimum have one in common, up to a similarity.
"""

from itertools import product

import numpy as np

from ..collision import survives_rounding
from ..curve import Curve
from ..curve.measures import bending
from ..driver import Iterate
from ..driver.interventions.balance import MoebiusImages, least_bending, turn
from ..task import Task
from ..types import FloatArray
from .alignment import Alignment, Freedom, alignments
from .joint import refined_alike
from .ways import back, followed, gone, on_mesh, renamed

IMAGES = 3  # of each curve, those that bend least, besides itself
TRIES = 8  # to join them, the best alignment first
MOEBIUS, TURN, ACROSS = 0.02, 0.2, 0.125  # legs at most: radians in the sphere and in space, share of the straight way
LEG = 3e-4  # radii of gyration by which shapes may be further apart to save a leg of a Möbius map
NEAR = 1e-3  # half the angle of rotation, in radians, of a Möbius map that is hardly any
STILL = Freedom(rotates=False, fixed=np.zeros(3))


class Shape:
    """A curve at rest in a task, the last iterate of its way, and its Möbius images that bend least and are reached.

    ``ways``: the iterates from the curve to each image, both included, and at first to the curve itself.
    """

    def __init__(self, end: Iterate, task: Task) -> None:
        self.end, self.task = end, task
        self.ways = [[end]]
        if end.curve.mesh.all_closed and not task.obstacles:
            images = MoebiusImages(end.curve, end.curve.edge_lengths)
            maps = [q for q in least_bending(images, end.curve.dimension) if np.linalg.norm(q[1:]) > NEAR]
            maps = sorted(maps, key=lambda q: bending(images.at(q)))[:IMAGES]
            # each map by both its signs: the pole comes from the one side or from the other
            legs = (_rotated(end.curve, images, q) or _rotated(end.curve, images, -q) for q in maps)
            self.ways += [[end, *gone(end, each)] for each in legs if each]


def _rotated(curve: Curve, images: MoebiusImages, q: FloatArray) -> list[FloatArray] | None:
    """Ends of proved legs to the image of q; None if strands interfere."""
    angle, map_of = turn(q)
    return followed(curve, lambda share: images.at(map_of(share * angle)).vertices, MOEBIUS / angle)


def meeting(x: Shape, y: Shape) -> tuple[Alignment, list[Iterate]] | None:
    """How one shape was aligned with another, and the iterates from it to that one, which are named as it is.

    None if no way was found that is free of contact.
    """
    pairs = [
        (alignment, way, other)
        for way, other in product(x.ways, y.ways)
        for freedom in _freedoms(x.task)
        for alignment in alignments(way[-1].curve, other[-1].curve, freedom)[:TRIES]
    ]
    pairs.sort(key=lambda each: each[0].cost + LEG * (len(each[1]) + len(each[2])))
    for alignment, way, other in pairs[:TRIES]:
        other = [renamed(each, alignment) for each in other]
        if (joint := _joint(way[-1], other[-1], alignment, x.task)) is not None:
            return alignment, [*way[1:], *joint, *back(other)]
    return None


def _freedoms(task: Task) -> tuple[Freedom, ...]:
    """Similarities that may be tried: open components are held at their ends, and walls may be in the way."""
    curve = task.curve
    if not curve.mesh.all_closed:
        start, end = curve.vertices[[0, -1]]
        single = curve.dimension == 3 and len(curve.mesh.component_sizes) == 1
        return (STILL, Freedom(axis=(end - start) / np.linalg.norm(end - start), fixed=start)) if single else (STILL,)
    free = Freedom(axis=np.array([0.0, 0.0, 1.0]) if curve.dimension == 2 else None)
    return (STILL, free) if task.obstacles else (free,)


def _joint(x: Iterate, y: Iterate, alignment: Alignment, task: Task) -> list[Iterate] | None:
    """The iterates from one aligned curve to another, that one included; None if they are not proved free."""
    curve, ends = x.curve, x.curve.mesh.ends

    def turned(share: float) -> FloatArray:
        moved = alignment.moved(curve.vertices, share)
        moved[ends] = curve.vertices[ends]
        return moved

    turning = followed(curve, turned, TURN / max(alignment.angle, TURN), task.obstacles)
    if turning is None:
        return None
    start, goal = refined_alike(curve.with_vertices(turning[-1]), y.curve, alignment.begins)
    if not all(survives_rounding(each, task.obstacles) for each in (start, goal)):
        return None
    a, b = start.vertices, goal.vertices
    legs = followed(start, lambda t: b if t == 1.0 else a + t * (b - a), ACROSS, task.obstacles)
    if legs is None:
        return None
    begun = on_mesh(y, start, tuple(start.mesh.ends.ravel().tolist()))
    return [*gone(x, turning), begun, *gone(begun, legs), on_mesh(y, y.curve, y.pins)]
