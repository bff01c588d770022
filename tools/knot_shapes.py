#!/usr/bin/env python3
"""Make core/knots/shapes.npz: relaxed smooth shapes of the table's knots and links, with a proof for each.

    tools/knot_shapes.py [NAME ...]

Each closed braid is relaxed as a polygon of few equal edges, which keeps its strands so far apart that they can be
seen: smooth minima have some at a tenth of that distance or less. It is balanced, turned so that it faces +z with
little hidden, and fitted by Fourier series. What is not proved is an error: that the relaxation kept the type, and that
the straight motion from the relaxed polygon to the one inscribed in the stored, rounded shape does. Relaxations take a
quarter of an hour in all; they are kept in build/knot_shapes, and those that are there are not done again.
"""

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from mobius_flow.core import Curve, Mesh, RelaxOptions, minimize
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.knots import KNOTS, knot
from mobius_flow.core.knots.diagrams import quick_invariants
from mobius_flow.core.knots.inscribed import arc_steps, equal_steps, is_isotopic
from mobius_flow.core.knots.shapes import FILE, QUANTUM, SmoothShape, shapes, smooth_knot
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

KEPT = Path(__file__).resolve().parents[1] / "build" / "knot_shapes"


def main() -> int:
    """Make the shapes named on the command line, by default all, and write them along with those already there."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="of the table (default: all)")
    chosen = parser.parse_args().names or list(KNOTS)
    made = dict(shapes()) if FILE.exists() and set(chosen) != set(KNOTS) else {}
    for name in chosen:
        made[name] = shape(name)
        print(name, [len(c) - 1 for c in made[name].coefficients], flush=True)
    store({name: made[name] for name in KNOTS if name in made})
    shapes.cache_clear()
    for name in chosen:
        if quick_invariants(smooth_knot(name)) != quick_invariants(knot(name)):
            sys.exit(f"{name}: the stored shape has other invariants")
    return 0


def store(given: Mapping[str, SmoothShape], path: Path = FILE) -> None:
    """Write shapes, rounded."""
    parts = [c for each in given.values() for c in each.coefficients]
    values = np.concatenate(parts)
    np.savez_compressed(
        path,
        names=np.array(list(given)),
        components=np.array([len(each.coefficients) for each in given.values()], dtype=np.uint8),
        modes=np.array([len(c) - 1 for c in parts], dtype=np.uint8),
        coefficients=np.rint(np.stack([values.real, values.imag], axis=-1) / QUANTUM).astype(np.int16),
    )


def relaxed(name: str) -> Curve:
    """The relaxed polygon of a knot; the motion there from its closed braid is proved free of contact."""
    path = KEPT / f"{name}.npz"
    if not path.exists():
        start = max(knot(name), knot(name, 160), key=len)
        result = minimize(start, RelaxOptions(vertices=len(start), mesh="fixed", balance=True))
        if not (result.certified and result.outcome.converged):
            sys.exit(f"{name}: the relaxation ended, {result.message}")
        path.parent.mkdir(parents=True, exist_ok=True)
        np.savez(path, vertices=result.curve.vertices, sizes=result.curve.mesh.component_sizes)
    with np.load(path) as kept:
        return Curve(kept["vertices"], Mesh(tuple(map(int, kept["sizes"]))))


def facing(curve: Curve) -> Curve:
    """A curve turned so that few strands are hidden as seen from +z, wide along x, and scaled to half-width 1."""

    def signed(axis: FloatArray, points: FloatArray) -> FloatArray:
        """An axis with the sign that puts the first point more than half-way out along it on its positive side.

        The sign of eigenvectors depends on rounding, which differs from processor to processor.
        """
        along = points @ axis
        return np.asarray(axis * np.sign(along[np.argmax(np.abs(along) > 0.5 * np.abs(along).max())]))

    def clutter(points: FloatArray) -> int:
        """Pairs of vertices that are near each other in the picture: at crossings, and where strands recede."""
        near = 0.25 * float(np.linalg.norm(points, axis=1).max())
        return len(cKDTree(points[:, :2]).query_pairs(near, output_type="ndarray"))

    points = curve.vertices - curve.vertices.mean(axis=0)
    # 400 directions spread over the sphere, by Fibonacci's spiral
    k = np.arange(400) + 0.5
    z, phi = 1.0 - 2.0 * k / 400, np.pi * (1.0 + np.sqrt(5.0)) * k
    rho, views = np.sqrt(1.0 - z**2), []
    for normal in np.stack([rho * np.cos(phi), rho * np.sin(phi), z], axis=1):
        x = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
        x /= np.linalg.norm(x)
        views.append(np.stack([x, np.cross(normal, x), normal], axis=1))
    turned = min((points @ view for view in views), key=clutter)
    # along the flattest axis, which shows symmetries, a little more may be hidden
    x, y = (signed(axis, points) for axis in np.linalg.svd(points, full_matrices=False)[2][:2])
    if clutter(flat := points @ np.stack([x, y, np.cross(x, y)], axis=1)) < 1.1 * clutter(turned):
        turned = flat
    x, y = signed(np.linalg.eigh(turned[:, :2].T @ turned[:, :2])[1][:, -1], turned[:, :2])  # the widest axis
    turned[:, :2] = turned[:, :2] @ np.array([[x, -y], [y, x]])
    low, high = turned.min(axis=0), turned.max(axis=0)
    return curve.with_vertices((turned - 0.5 * (low + high)) / (0.5 * (high - low).max()))


def shape(name: str) -> SmoothShape:
    """Fit a knot's shape with the fewest modes that stay close to it and are proved to keep its type."""
    curve = facing(relaxed(name))
    for tolerance in (0.004, 0.002, 0.001):  # of the half-width, between relaxed and stored curve
        coefficients = []
        for points in curve.components:
            closed = np.concatenate([points, points[:1]])
            spline = CubicSpline(np.append(arc_steps(points), 1.0), closed, bc_type="periodic")
            samples = spline(np.arange(1024) / 1024)
            spectrum = np.fft.rfft(samples, axis=0) / 512
            spectrum[0] /= 2
            for modes in range(1, 60):
                kept = np.where(np.arange(len(spectrum))[:, None] <= modes, spectrum, 0.0)
                kept[0] *= 2
                if np.abs(np.fft.irfft(kept * 512, axis=0) - samples).max() < tolerance:
                    break
            coefficients.append(spectrum[: modes + 1])
        fitted = SmoothShape(tuple(QUANTUM * np.round(c / QUANTUM) for c in coefficients))  # as it is stored
        # the motion from the relaxed polygon to the one inscribed in the shape is free of contact
        polygon = fitted.polygon(fitted.sizes)
        if is_isotopic(curve, [arc_steps(part) for part in curve.components], polygon, equal_steps(polygon)):
            return fitted
    sys.exit(f"{name}: the motion from the relaxed curve to no stored shape is proved free of contact")


if __name__ == "__main__":
    sys.exit(main())
