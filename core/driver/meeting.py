"""Where two relaxed curves meet: Möbius images of both, aligned, and a straight way from one to the other, as ropes.

All Möbius images of a curve have the same energy.  The images that bend least are few, so that curves at the same
minimum have one in common, up to a similarity.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import islice, pairwise, product
from typing import ClassVar

import numpy as np

from ..base import FloatArray
from ..collision import is_rope, survives_rounding, walk
from ..curve import Alignment, Curve, Freedom, Mesh, Obstacle, alignments, bending, refined_alike
from ..io.trajectory import Iterate
from .moves.balance import MoebiusImages, least_bending, turn

Radius = tuple[float, ...] | None  # of each component as a rope; None if the curve is none


def min_radius(one: Radius, other: Radius) -> Radius:
    return None if one is None or other is None else tuple(map(min, one, other))


@dataclass(frozen=True, eq=False)
class Image:
    """A Möbius image of a curve at rest, or that itself, with motions there: one for each sign of the map, if any."""

    end: Iterate
    curve: Curve
    motions: tuple[Callable[[float], FloatArray], ...] = ()  # from a share of the way to vertices
    angle: float = 0.0  # by which half the sphere turns
    step: ClassVar[float] = 0.02  # of that in a leg

    def way(self, most: float) -> list[Iterate] | None:
        """The iterates from the curve at rest as a rope of at most that radius, 0 for none; None if none is proved."""
        radius = self.end.radius if most else None
        thin = replace(self.end, radius=radius and tuple(min(each, most) for each in radius))
        proved = (prove_legs(thin, self.end.curve, at, self.step / self.angle) for at in self.motions)
        legs = next((legs for legs in proved if legs), None)
        return [thin, *follow(thin, legs or ())] if legs or not self.motions else None


def images(end: Iterate, obstacles: Sequence[Obstacle]) -> list[Image]:
    """A curve at rest, and its Möbius images that bend least."""
    curve, made = end.curve, [Image(end, end.curve)]
    if curve.mesh.all_closed and not obstacles:
        found = MoebiusImages(curve, curve.edge_lengths)

        def motion(q: FloatArray) -> tuple[float, Callable[[float], FloatArray]]:
            angle, map_of = turn(q)
            return angle, lambda share: found.at(map_of(share * angle)).vertices

        # maps that rotate the sphere by more than 0.002 radians
        maps = [q for q in least_bending(found, curve.dimension) if np.linalg.norm(q[1:]) > 1e-3]
        for q in sorted(maps, key=lambda q: bending(found.at(q)))[:3]:
            (angle, there), (_, around) = motion(q), motion(-q)  # the pole may come from either side
            made.append(Image(end, curve.with_vertices(there(1.0)), (there, around), angle))
    return made


def meeting(
    ours: Sequence[Image], theirs: Sequence[Image], obstacles: Sequence[Obstacle], gives_way: bool
) -> tuple[Alignment, list[Iterate] | None]:
    """How one curve aligns with another, by an image of each, and the iterates to the other, renamed to match.

    The way is that of the thinner rope, or of one that gives way.  Without any the iterates are None, and the alignment
    is the best one.
    """
    # similarities that may be tried: open components are held at their ends, and walls may be in the way
    curve = ours[0].end.curve
    tries = 8  # to join two curves, the best alignment first
    still = Freedom(np.zeros(3), fixed=np.zeros(3))
    freedoms: tuple[Freedom, ...] = (still,)
    if curve.mesh.all_closed:
        free = Freedom(np.array([0.0, 0.0, 1.0]) if curve.dimension == 2 else None)
        freedoms = (still, free) if obstacles else (free,)
    elif curve.dimension == 3 and len(curve.components) == 1:
        start, end = curve.vertices[[0, -1]]
        freedoms = still, Freedom((end - start) / np.linalg.norm(end - start), fixed=start)
    pairs = [
        (alignment, one, other)
        for one, other in product(ours, theirs)
        for freedom in freedoms
        for alignment in alignments(one.curve, other.curve, freedom)[:tries]
    ]
    # to save a leg of a Möbius map shapes may be further apart by so many radii of gyration
    pairs.sort(key=lambda each: each[0].cost + 3e-4 / Image.step * (each[1].angle + each[2].angle))
    way_to = cache(Image.way)
    thinner = min(max(each[0].end.radius or (0.0,)) for each in (ours, theirs))
    for share in (1.0, 0.8, 0.6, 0.4, 0.2, 0.0) if gives_way and thinner else (1.0,):
        reached = (
            (alignment, way, [rename(each, alignment) for each in back])
            for alignment, one, other in pairs
            if (way := way_to(one, share * thinner)) and (back := way_to(other, share * thinner))
        )
        for alignment, way, back in islice(reached, tries):
            radius = min_radius(way[-1].radius, back[-1].radius)
            x, y = (replace(each[-1], radius=radius) for each in (way, back))
            if joint := _join(x, y, alignment, obstacles):
                return alignment, [*way[1:], *joint, *run_back(back)]
    return pairs[0][0], None


def _join(x: Iterate, y: Iterate, alignment: Alignment, obstacles: Sequence[Obstacle]) -> list[Iterate] | None:
    """The iterates from one aligned curve to another, that one included; None if they are not proved."""
    curve, ends = x.curve, x.curve.mesh.ends

    def turned(share: float) -> FloatArray:
        moved = alignment.moved(curve.vertices, share)
        moved[ends] = curve.vertices[ends]
        return moved

    longest = 0.2  # radians in a leg
    turning = prove_legs(x, curve, turned, longest / max(alignment.angle, longest), obstacles)
    if turning is None:
        return None
    start, goal = refined_alike(curve.with_vertices(turning[-1]), y.curve, alignment.begins)
    if not all(survives_rounding(each, obstacles) for each in (start, goal)):
        return None
    a, b = start.vertices, goal.vertices
    legs = prove_legs(x, start, lambda t: b if t == 1.0 else a + t * (b - a), 0.125, obstacles)
    if legs is None:
        return None
    refined = change_mesh(y, start, tuple(start.mesh.ends.ravel().tolist()))
    return [*follow(x, turning), refined, *follow(refined, legs), change_mesh(y, y.curve, y.pins)]


def prove_legs(
    rope: Iterate, start: Curve, at: Callable[[float], FloatArray], stride: float, obstacles: Sequence[Obstacle] = ()
) -> list[FloatArray] | None:
    """Ends of proved legs from a curve along a motion, which maps a share of it to vertices; None if one is not proved.

    The curve is a rope as an iterate is.  ``stride`` is the largest share of a leg; those not proved are halved.
    """
    legs, reached, radius = [start.vertices], 0.0, None if rope.radius is None else np.array(rope.radius)

    def moved(share: float, stride: float) -> FloatArray | None:
        end = at(min(share + stride, 1.0))
        return end if is_rope(start.mesh, legs[-1], end, radius, obstacles) else None

    end = at(1.0)
    if not is_rope(start.mesh, end, end, radius, obstacles):  # as is soon told
        return None
    for share, end in walk(moved, 1.0, stride, 5e-5):
        reached = share
        legs.append(end)
    return legs[1:] if reached >= 1.0 else None


def follow(before: Iterate, legs: Sequence[FloatArray]) -> Iterator[Iterate]:
    """The iterates that follow another one along legs on its mesh."""
    for leg in legs:
        yield replace(before, curve=before.curve.with_vertices(leg), path=(leg,), step_size=0.0)


def change_mesh(before: Iterate, curve: Curve, pins: tuple[int, ...]) -> Iterate:
    """The iterate that follows another one with the same polygon on another mesh."""
    return replace(before, curve=curve, path=(), step_size=0.0, pins=pins)


def run_back(way: Sequence[Iterate]) -> Iterator[Iterate]:
    """The iterates that follow the last one, back along the same way to the first: vertices that came go."""
    for last, before in pairwise(reversed(way)):
        path = (*last.path[-2::-1], before.curve.vertices) if last.path else ()
        yield replace(before, path=path, step_size=last.step_size)


def rename(iterate: Iterate, alignment: Alignment) -> Iterate:
    """The same iterate with components in another order; those run through backwards keep their first vertex."""
    if alignment.as_given:
        return iterate
    mesh, parts = iterate.curve.mesh, []
    for component, backwards in zip(alignment.order, alignment.backwards, strict=True):
        part = np.arange(mesh.size)[mesh.slices[component]]
        parts.append(np.roll(part[::-1], 1) if backwards else part)
    names = np.concatenate(parts)
    sizes = tuple(mesh.component_sizes[k] for k in alignment.order)
    closed = tuple(mesh.closed[k] for k in alignment.order)
    curve = Curve(iterate.curve.vertices[names], Mesh(sizes, closed))
    pins = tuple(np.flatnonzero(np.isin(names, iterate.pins)).tolist())
    radius = None if iterate.radius is None else tuple(iterate.radius[k] for k in alignment.order)
    return replace(iterate, curve=curve, path=tuple(leg[names] for leg in iterate.path), pins=pins, radius=radius)
