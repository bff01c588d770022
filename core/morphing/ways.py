"""Ways of curves as iterates: straight legs along a given motion, ways back, and other names for vertices."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..collision import is_free
from ..curve import Curve, Mesh
from ..curve.alignment import Alignment
from ..deadline import check_time
from ..driver import Iterate
from ..obstacle import Obstacle
from ..types import FloatArray

SHORTEST = 1e-4  # share of a motion in one leg, with which it is given up


def followed(
    start: Curve, at: Callable[[float], FloatArray], stride: float, obstacles: Sequence[Obstacle] = ()
) -> list[FloatArray] | None:
    """Ends of proved legs from a curve along a motion, which gives vertices at a share of it; None if one is not free.

    ``stride`` is the largest share of a leg; where legs are not free, they are halved.
    """
    legs, share, longest = [start.vertices], 0.0, stride
    while share < 1.0:
        check_time()
        further = min(share + stride, 1.0)
        end = at(further)
        if is_free(start.mesh, legs[-1], end, obstacles):
            legs.append(end)
            share, stride = further, min(2.0 * stride, longest)
        elif stride < SHORTEST:
            return None
        else:
            stride *= 0.5
    return legs[1:]


def gone(before: Iterate, legs: Sequence[FloatArray]) -> Iterator[Iterate]:
    """The iterates after another one at the ends of legs on its mesh."""
    for leg in legs:
        yield replace(before, curve=before.curve.with_vertices(leg), path=(leg,), step_size=0.0)


def on_mesh(before: Iterate, curve: Curve, pins: tuple[int, ...]) -> Iterate:
    """The iterate after another one that is the same polygon on another mesh."""
    return replace(before, curve=curve, path=(), step_size=0.0, pins=pins)


def back(way: Sequence[Iterate]) -> Iterator[Iterate]:
    """The iterates after the last one on the same way back to the first: vertices that came go."""
    for here, there in pairwise(reversed(way)):
        path = (*here.path[-2::-1], there.curve.vertices) if here.path else ()
        yield replace(there, path=path, step_size=here.step_size)


def renamed(iterate: Iterate, alignment: Alignment) -> Iterate:
    """The same with components in another order; those that are run through backwards keep their first vertex."""
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
