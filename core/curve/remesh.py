"""Adaptive meshes: split and collapse edges so that neighbours stay nearer than strands (Section 6.1.3 of [RS21]).

A split puts vertices on an edge.  A collapse first moves a vertex onto the chord of its neighbours, a motion to be
proved free of contact like any other, and then removes it.
"""

from dataclasses import dataclass

import numpy as np

from ..types import FloatArray, IntArray
from .curve import Curve
from .mesh import Mesh
from .pins import NO_PINS, NOWHERE, Pins, arcs, holds
from .refine import Resolution, subdivide, target_spacing

SPLIT = 1.5  # edges longer than this many times the spacing wanted are split
COLLAPSE = 0.5  # two edges are joined if each is shorter than this many times the spacing
GRADING = 1.3  # ratio of the spacings wanted on neighbouring edges, at most
EDGES_PER_CLEARANCE = 2.0  # of obstacles: a curve bends as tightly as it is near to them
MIN_VERTICES = 16  # edges that a component, or an arc between pins, keeps if it had as many


def graded_spacing(curve: Curve, resolution: Resolution) -> FloatArray:
    """Edge length wanted on every edge, varying by a bounded ratio from edge to edge; shape (edges,)."""
    spacing = np.minimum(target_spacing(curve, resolution), resolution.clearance(curve) / EDGES_PER_CLEARANCE)
    for part, closed in zip(curve.mesh.edge_slices, curve.mesh.closed, strict=True):
        # one sweep each way, twice round where the component is closed, spreads every minimum as far as it reaches
        for direction in (1, -1):
            local = np.tile(spacing[part][::direction], 2 if closed else 1)
            steps = np.log(GRADING) * np.arange(len(local))
            local = np.exp(np.minimum.accumulate(np.log(local) - steps) + steps)
            spacing[part] = local[part.start - part.stop :][::direction]
    return spacing


def superfluous(curve: Curve, spacing: FloatArray, kept: IntArray = NOWHERE) -> IntArray:
    """Vertices that may be removed, no two of them neighbours or next but one, and no ends or vertices to be kept."""
    mesh, before, after = curve.mesh, curve.mesh.incoming, curve.mesh.outgoing
    joined = curve.edge_lengths < COLLAPSE * spacing
    short = joined[before] & joined[after] & (before != after) & ~holds(mesh, kept)
    arc_of, room = np.empty(mesh.edges, dtype=np.intp), []
    for number, arc in enumerate(arcs(mesh, kept)):
        arc_of[arc] = number
        room.append(len(arc) - min(len(arc), MIN_VERTICES))
    chosen: list[int] = []
    for part in mesh.slices:
        size, last, first = part.stop - part.start, -3, None
        for k in np.flatnonzero(short[part]):
            wraps = first is not None and first + size - k < 3
            arc = arc_of[after[part.start + k]]
            if room[arc] > 0 and k - last >= 3 and not wraps:
                chosen.append(part.start + int(k))
                first = int(k) if first is None else first
                last = int(k)
                room[arc] -= 1
    return np.array(chosen, dtype=np.intp)


def onto_chords(curve: Curve, vertices: IntArray) -> FloatArray:
    """All vertices after the given ones have moved onto the chords of their neighbours; shape (n, m)."""
    mesh = curve.mesh
    moved = curve.vertices.copy()
    before = curve.vertices[mesh.tails[mesh.incoming[vertices]]]
    after = curve.vertices[mesh.heads[mesh.outgoing[vertices]]]
    chord = after - before
    along = np.einsum("ij,ij->i", curve.vertices[vertices] - before, chord) / np.einsum("ij,ij->i", chord, chord)
    moved[vertices] = before + np.clip(along, 0.2, 0.8)[:, None] * chord
    return moved


@dataclass(frozen=True, eq=False)
class Remeshed:
    """A change of mesh."""

    moved: Curve  # the old polygon after its superfluous vertices have moved onto their chords
    curve: Curve  # the new one: the same set of points, up to rounding
    lengths: FloatArray  # wanted on the new mesh; they add up to the total of each arc between pins; shape (edges',)
    pins: Pins  # the old ones on the new mesh


def remesh(
    curve: Curve, resolution: Resolution, removable: IntArray, spacing: FloatArray, pins: Pins = NO_PINS
) -> Remeshed:
    """Remove the given vertices after moving them onto their chords, and split edges that are too long."""
    moved = curve.with_vertices(onto_chords(curve, removable))
    keep = np.ones(len(curve), dtype=bool)
    keep[removable] = False
    sizes = tuple(int(np.count_nonzero(keep[part])) for part in curve.mesh.slices)
    coarse = Curve(moved.vertices[keep], Mesh(sizes, curve.mesh.closed))
    wanted = spacing[keep[curve.mesh.tails]]
    pieces = np.where(coarse.edge_lengths > SPLIT * wanted, np.ceil(coarse.edge_lengths / wanted), 1.0)
    fine = subdivide(coarse, pieces.astype(np.intp))
    held = pins.on(fine)
    return Remeshed(moved, fine, normalised(fine, graded_spacing(fine, resolution), held.vertices), held)


def needs_remesh(curve: Curve, spacing: FloatArray, kept: IntArray = NOWHERE) -> bool:
    """Whether an edge is too long for its neighbourhood, or a tenth of the vertices are superfluous."""
    too_long = bool((curve.edge_lengths > SPLIT * spacing).any())
    return too_long or len(superfluous(curve, spacing, kept)) > 0.1 * len(curve)


def normalised(curve: Curve, spacing: FloatArray, pins: IntArray) -> FloatArray:
    """Edge lengths as the spacing, scaled with the length of every arc between pins, or component, kept; shape (n,)."""
    lengths = spacing.copy()
    for arc in arcs(curve.mesh, pins):
        lengths[arc] *= curve.edge_lengths[arc].sum() / spacing[arc].sum()
    return lengths
