"""Colours: linear RGB for components and values, numbers at vertices that are worth showing, and legible overlays."""

from collections.abc import Callable, Sequence

import numpy as np
from scipy.spatial.distance import cdist

from ..base import FloatArray
from ..curve import STRAND_RATIO, Curve, nearest_on_edges
from ..curve.distances import arc_distance_of_vertices
from ..energies.moebius import moebius_by_length

# of components; after the last they begin again
PALETTE = (
    (0.005, 0.110, 0.220),
    (0.620, 0.070, 0.030),
    (0.780, 0.400, 0.030),
    (0.060, 0.260, 0.120),
    (0.260, 0.060, 0.280),
)
Colour = Sequence[float]  # red, green and blue from 0 to 1, as on the screen; more is not looked at
COMPONENT, DISTANCE, ENERGY = "component", "strand_distance", "energy_density"  # as attributes are called


def ramp(values: FloatArray) -> FloatArray:
    """Colours from violet for low values to yellow for high ones; (n,) to (n, 3)."""
    low, high = np.percentile(values, [2.0, 98.0])  # a few corners must not flatten the rest
    share = ((values - low) / (high - low)).clip(0.0, 1.0) if high > low else np.zeros(len(values))
    viridis = [(68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37)]  # sRGB
    anchors = linear(np.array(viridis) / 255.0)
    places = np.linspace(0.0, 1.0, len(anchors))
    return np.column_stack([np.interp(share, places, channel) for channel in anchors.T])


# the numbers that colour vertices, and how: near strands and high energies are bright
COLOURINGS: dict[str, Callable[[FloatArray], FloatArray]] = {
    COMPONENT: lambda numbers: np.asarray(np.array(PALETTE)[numbers.astype(np.intp) % len(PALETTE)]),
    DISTANCE: lambda distances: ramp(-distances),
    ENERGY: ramp,
}


def linear(srgb: FloatArray) -> FloatArray:
    """Convert the values sent to screens, sRGB from 0 to 1, to light."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def on_screen(light: FloatArray) -> FloatArray:
    """Convert light to the values sent to screens; the inverse of :func:`linear`."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def flatly_lit(tint: FloatArray) -> FloatArray:
    """A material's colour where the light is plain: in Workbench, and in small pictures."""
    return np.asarray(tint**0.65)  # as bright without a sky as in Cycles' light


def contrast(one: Colour, other: Colour) -> float:
    """Contrast of two colours, from 1 to 21 (WCAG 2.1)."""
    # by their relative luminance, from 0 for black to 1 for white
    dark, light = np.sort(linear(np.array([one[:3], other[:3]], dtype=np.float64)) @ [0.2126, 0.7152, 0.0722])
    return float((light + 0.05) / (dark + 0.05))


def legible(wanted: Colour, ground: Colour) -> Colour:
    """The wanted colour, or black or white if it does not stand out from the ground."""
    enough = 3.0  # contrast of lines, after WCAG 2.1
    return max((wanted, (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), key=lambda each: min(contrast(each, ground), enough))


def vertex_values(link: Curve) -> dict[str, FloatArray]:
    """All values that may colour vertices, by name, (n,) each.

    The number of the component, counted from 0; the distance to the nearest other strand, in the link's units; and the
    Möbius energy per length, in 1/unit.
    """
    density = moebius_by_length(link)
    return {
        COMPONENT: link.mesh.component.astype(np.float64),
        DISTANCE: strand_distances(link),
        ENERGY: 0.5 * (density[link.mesh.outgoing] + density[link.mesh.incoming]),
    }


def strand_distances(curve: Curve, pairs: int = 2_000_000) -> FloatArray:
    """Distance from each vertex to the nearest other strand, shape (n,); in the curve's units.

    A strand passes where the distance is least among the neighbours there, as in `core.curve.refine`; the curve round a
    mere bend is none.  Where nothing passes the distance is the curve's longest one, and where nothing passes anywhere
    its diameter.  So many ``pairs`` of vertices are looked at together.
    """
    mesh, everything, block = curve.mesh, np.arange(len(curve)), max(1, pairs // len(curve))
    distances = np.full(len(curve), np.inf)  # where nothing passes
    for rows in np.split(everything, everything[block::block]):
        r = cdist(curve.vertices[rows], curve.vertices)
        passing = (r <= r[:, mesh.heads[mesh.outgoing]]) & (r <= r[:, mesh.tails[mesh.incoming]])
        passing &= arc_distance_of_vertices(curve, rows[:, None], everything) > STRAND_RATIO * r
        r[~passing] = np.inf
        nearest, found = r.argmin(axis=1), passing.any(axis=1)
        for edges in (mesh.outgoing[nearest], mesh.incoming[nearest]):  # distances to vertices would show the mesh
            _, to_edge = nearest_on_edges(curve, edges, curve.vertices[rows])
            distances[rows] = np.where(found, np.minimum(distances[rows], to_edge), np.inf)
    passing = distances[np.isfinite(distances)]
    furthest = passing.max() if passing.size else np.linalg.norm(np.ptp(curve.vertices, axis=0))
    return np.asarray(np.minimum(distances, furthest))
