"""Proved upper bounds on the ropelengths of knot types: of polygons with arcs in their corners (docs/bounds.md)."""

import math
from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from ...core.base import CurveError, checked
from ...core.collision import thickness
from ...core.curve import Curve, check_closed
from ...core.energies.edge_pairs import EdgePairs
from ...core.energies.rope import closest
from ...core.knots.inscribed import equal_steps, is_isotopic
from ...core.ropes.splines import cubic_splines


@checked
def ropelength_bound(curve: Curve, per_edge: int = 16, smoothed: Sequence[float] = (0.0, 0.03)) -> float:
    """A proved upper bound on the ropelength of a polygon's knot type: that of a curve C¹·¹ near it, rounded up.

    Arcs are inscribed in a polygon with ``per_edge`` times as many vertices on the cubic B-spline that is controlled by
    the given one, whose vertices are smoothed by such parts of their second differences first: the least bound counts.
    Raises CurveError where no spline is proved to be of the polygon's type, or they are too coarse, for arcs, and for
    curves that are not in space.
    """
    check_closed(curve, "ropelengths")
    if curve.dimension != 3:
        raise CurveError(f"the curve has dimension {curve.dimension}; ropelengths are of curves in space")
    sizes, bounds = curve.mesh.component_sizes, list[float]()
    basis = cubic_splines(sizes, per_edge)
    for part in smoothed:
        controls = [p + part * (np.roll(p, 1, axis=0) - 2.0 * p + np.roll(p, -1, axis=0)) for p in curve.components]
        splines = np.split(basis @ np.concatenate(controls), per_edge * np.cumsum(sizes)[:-1])
        fine = Curve.from_components(splines)
        if is_isotopic(curve, equal_steps(curve), fine, equal_steps(fine)):
            bounds.append(bound_by_arcs(fine))
    if not bounds:
        raise CurveError("a spline near the curve may be another knot, which bounds no ropelength; give more vertices")
    return min(bounds)


@checked
def bound_by_arcs(curve: Curve) -> float:
    """Length over thickness of a closed polygon with arcs of that radius in its corners, as is proved, rounded up.

    In doubles, whose errors are bounded: sums have relative ones far below 2⁻³⁰, which comes on top.  Raises CurveError
    for polygons that are so coarse that arcs make them much thinner.
    """
    mesh, ell, e, slack = curve.mesh, curve.edge_lengths, curve.edge_vectors, 2.0**-30
    before, after = mesh.incoming, mesh.outgoing
    both = ell[before] * ell[after]
    sine = np.linalg.norm(np.cross(e[before], e[after]), axis=1) + slack * both
    tangent = sine / np.maximum((1.0 - slack) * both + np.einsum("km,km->k", e[before], e[after]), slack * both)
    guess = thickness(curve)
    radius = min(0.5 * float((np.minimum(ell[before], ell[after]) / tangent).min()), 1.01 * guess)
    sagitta = radius * tangent**2  # twice ϱ (1 − cos(θ/2)), or more
    off = np.maximum(sagitta[mesh.tails], sagitta[mesh.heads])
    i, j = cKDTree(curve.midpoints).query_pairs(2.03 * guess + float(ell.max() + off.max()), output_type="ndarray").T
    arc, whole = np.cumsum(ell), curve.component_lengths[mesh.edge_component]
    along = np.abs(arc[i] - arc[j])
    along = np.minimum(along, whole[i] - along) + np.maximum(ell[i], ell[j])  # between ends, the shorter way
    along = np.where(mesh.edge_component[i] == mesh.edge_component[j], along + slack * curve.length, np.inf)
    far = along > 2.5 * guess
    i, j, along = i[far], j[far], along[far]
    chord, _, _ = closest(EdgePairs.of(mesh, curve.vertices, i, j))
    size = np.linalg.norm(chord, axis=1)
    # all ends are on their sides of two planes, across the chord of the closest points, that are so far apart
    x, y = ([curve.vertices[ends[k]] for ends in (mesh.tails, mesh.heads)] for k in (i, j))
    apart = np.min([np.einsum("km,km->k", a - b, chord) for a in x for b in y], axis=0) / np.maximum(size, slack)
    room = 0.5 * (apart - slack * (size + ell[i] + ell[j]) - 0.5 * (off[i] + off[j]))
    while (less := float(room[along >= math.pi * radius].min(initial=radius))) < radius:
        if less < 0.8 * guess:  # pairs nearer along the curve, which are left out, would count
            raise CurveError("the curve is too coarse for a bound of its ropelength; give more vertices")
        radius = less
    return (1.0 + 4.0 * slack) * curve.length / radius
