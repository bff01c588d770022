"""Where two relaxed curves meet: Möbius images of both, aligned, and a straight way from one to the other.

All Möbius images of a curve have the same energy.  The images that bend least are few, so that curves at the same
minimum have one in common, up to a similarity.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise, product

import numpy as np

from ..base.types import FloatArray
from ..collision import is_free, survives_rounding, walk
from ..curve import Alignment, Curve, Freedom, Mesh, Obstacle, alignments, bending, refined_alike
from ..driver.moves.balance import MoebiusImages, least_bending, turn
from ..io.trajectory import Iterate


def images(end: Iterate, obstacles: Sequence[Obstacle]) -> list[list[Iterate]]:
    """The iterates from a curve at rest to each of its Möbius images that bend least and are reached; itself first."""
    curve, ways = end.curve, [[end]]
    if curve.mesh.all_closed and not obstacles:
        found = MoebiusImages(curve, curve.edge_lengths)
        # maps that rotate the sphere by more than 0.002 radians
        maps = [q for q in least_bending(found, curve.dimension) if np.linalg.norm(q[1:]) > 1e-3]
        for q in sorted(maps, key=lambda q: bending(found.at(q)))[:3]:
            # each map with both its signs: the pole may come from either side
            legs = _turn_sphere(curve, found, q) or _turn_sphere(curve, found, -q)
            ways += [[end, *follow(end, legs)]] if legs else []
    return ways


def _turn_sphere(curve: Curve, found: MoebiusImages, q: FloatArray) -> list[FloatArray] | None:
    """Ends of proved legs to the image of q; None if strands interfere."""
    angle, map_of = turn(q)
    return prove_legs(curve, lambda share: found.at(map_of(share * angle)).vertices, 0.02 / angle)


def meeting(
    ours: Sequence[list[Iterate]], theirs: Sequence[list[Iterate]], obstacles: Sequence[Obstacle]
) -> tuple[Alignment, list[Iterate] | None]:
    """How one curve aligns with another, by the ways to their images, and the iterates to the other, renamed to match.

    Without a way that is free of contact the iterates are None, and the alignment is the best one.
    """
    # similarities that may be tried: open components are held at their ends, and walls may be in the way
    curve = ours[0][0].curve
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
        (alignment, way, other)
        for way, other in product(ours, theirs)
        for freedom in freedoms
        for alignment in alignments(way[-1].curve, other[-1].curve, freedom)[:tries]
    ]
    # to save a leg of a Möbius map shapes may be further apart by so many radii of gyration
    pairs.sort(key=lambda each: each[0].cost + 3e-4 * (len(each[1]) + len(each[2])))
    for alignment, way, other in pairs[:tries]:
        renamed = [rename(each, alignment) for each in other]
        joint = _join(way[-1], renamed[-1], alignment, obstacles)
        if joint is not None:
            return alignment, [*way[1:], *joint, *run_back(renamed)]
    return pairs[0][0], None


def _join(x: Iterate, y: Iterate, alignment: Alignment, obstacles: Sequence[Obstacle]) -> list[Iterate] | None:
    """The iterates from one aligned curve to another, that one included; None if they are not proved free."""
    curve, ends = x.curve, x.curve.mesh.ends

    def turned(share: float) -> FloatArray:
        moved = alignment.moved(curve.vertices, share)
        moved[ends] = curve.vertices[ends]
        return moved

    longest = 0.2  # radians in a leg
    turning = prove_legs(curve, turned, longest / max(alignment.angle, longest), obstacles)
    if turning is None:
        return None
    start, goal = refined_alike(curve.with_vertices(turning[-1]), y.curve, alignment.begins)
    if not all(survives_rounding(each, obstacles) for each in (start, goal)):
        return None
    a, b = start.vertices, goal.vertices
    legs = prove_legs(start, lambda t: b if t == 1.0 else a + t * (b - a), 0.125, obstacles)
    if legs is None:
        return None
    refined = change_mesh(y, start, tuple(start.mesh.ends.ravel().tolist()))
    return [*follow(x, turning), refined, *follow(refined, legs), change_mesh(y, y.curve, y.pins)]


def prove_legs(
    start: Curve, at: Callable[[float], FloatArray], stride: float, obstacles: Sequence[Obstacle] = ()
) -> list[FloatArray] | None:
    """Ends of proved legs from a curve along a motion, which maps a share of it to vertices; None if one is not free.

    ``stride`` is the largest share of a leg; where legs are not free, they are halved.
    """
    legs, reached = [start.vertices], 0.0

    def moved(share: float, stride: float) -> FloatArray | None:
        end = at(min(share + stride, 1.0))
        return end if is_free(start.mesh, legs[-1], end, obstacles) else None

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
    return replace(iterate, curve=curve, path=tuple(leg[names] for leg in iterate.path), pins=pins)
