#!/usr/bin/env python3
"""Draw addon/assets/knots.png: all knots of the table, in its order, from left to right and from the top down.

Each is a tube under a light, seen from +z, in a square; there are 47 colours, after the transparent one.
"""

import sys

import numpy as np
from mobius_flow.addon.pictures.icons import COLUMNS, SHEET, SIDE
from mobius_flow.core import Curve
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.keys.colours import PALETTE, flatly_lit, on_screen
from mobius_flow.core.knots import KNOTS, smooth_knot
from PIL import Image


def main() -> int:
    """Draw them all."""
    rows = -(-len(KNOTS) // COLUMNS)
    sheet = np.zeros((rows * SIDE, COLUMNS * SIDE, 4))
    for k, name in enumerate(KNOTS):
        down, right = (SIDE * each for each in divmod(k, COLUMNS))
        sheet[down : down + SIDE, right : right + SIDE] = thumbnail(smooth_knot(name), SIDE)[::-1]
    opaque, colours = sheet[..., 3] > 0, np.round(255 * sheet[..., :3]).astype(np.uint8)
    # wrong by 2 % at most, in half the space
    few = Image.fromarray(colours[opaque][None]).quantize(47, Image.Quantize.MAXCOVERAGE, kmeans=2)
    numbers = np.zeros(opaque.shape, dtype=np.uint8)
    numbers[opaque] = np.asarray(few)[0] + 1
    picture = Image.fromarray(numbers, "P")
    picture.putpalette([0, 0, 0, *(few.getpalette() or [])])
    picture.save(SHEET, transparency=0, optimize=True)
    return 0


def thumbnail(curve: Curve, size: int) -> FloatArray:
    """Draw a curve as tubes, one colour for each component; RGBA in [0, 1], bottom row first, (size, size, 4).

    The tube is drawn as balls, each of which covers the pixels behind it; it is transparent around the tube.
    """
    tints = on_screen(flatly_lit(np.array(PALETTE)))
    tube, rim = 0.075, 0.035  # half-widths of the tube, and of the dark rim that sets it off from what is behind
    low, high = curve.vertices.min(axis=0), curve.vertices.max(axis=0)
    unit = 0.5 * 0.88 * size / (1.0 + tube + rim)  # the drawing fills 88 % of the width
    scale = unit / (0.5 * float((high - low)[:2].max()))
    curve = curve.with_vertices((curve.vertices - 0.5 * (low + high)) * scale)
    # the balls, no further apart than 30 % of the radius
    pieces = np.ceil(curve.edge_lengths / (0.3 * tube * unit)).astype(np.intp)
    edge = np.repeat(np.arange(len(curve)), pieces)
    t = (np.arange(len(edge)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[edge]
    points = curve.vertices[edge] + t[:, None] * curve.edge_vectors[edge]
    points[:, :2] += 0.5 * size
    picture = np.zeros((size, size, 4))
    depth = np.full((size, size), -np.inf)
    # a rim hides what is 2.5 radii behind it
    for radius, sink in (((tube + rim) * unit, 2.5 * tube * unit), (tube * unit, 0.0)):
        # pixels that the balls cover, and the surface's height and unit normal there
        reach = np.arange(-int(radius) - 1, int(radius) + 2)
        offsets = np.stack(np.meshgrid(reach, reach), axis=-1).reshape(-1, 2)
        pixels = np.floor(points[:, None, :2]).astype(np.intp) + offsets
        apart = pixels + 0.5 - points[:, None, :2]
        rise = radius**2 - (apart**2).sum(axis=2)
        ball, place = np.nonzero((rise > 0) & ((pixels >= 0) & (pixels < size)).all(axis=2))
        across, up = apart[ball, place], np.sqrt(rise[ball, place])
        columns, rows = pixels[ball, place].T
        height, normal = points[ball, 2] + up - sink, np.column_stack([across, up]) / radius
        # the topmost of them at each pixel, where it covers what is there
        order = np.argsort(height)
        last = np.full(depth.shape, -1, dtype=np.intp)
        last[rows[order], columns[order]] = order  # of several values assigned to a pixel the last one stays
        chosen = last[last >= 0]
        chosen = chosen[height[chosen] > depth[rows[chosen], columns[chosen]]]
        rows, columns = rows[chosen], columns[chosen]
        depth[rows, columns] = height[chosen]
        brightness = 0.35 + 0.65 * np.maximum(normal[chosen] @ [-0.35, 0.5, 0.79], 0.0)  # a light, and some all round
        colors = tints[curve.mesh.component[edge[ball[chosen]]] % len(tints)] * brightness[:, None]
        picture[rows, columns] = np.column_stack([0.08 * colors if sink else colors, np.ones(len(rows))])
    return picture


if __name__ == "__main__":
    sys.exit(main())
