"""Smooth shapes of the table's knots and links, with evenly spread strands, stored as a few Fourier coefficients.

``tools/knot_shapes.py`` makes ``shapes.npz`` from relaxations of the tangent-point energy, and proves that each polygon
made here has the type its name says.
"""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import MappingProxyType

import numpy as np

from ..arguments import checked
from ..curve import Curve
from ..curve.fourier import FourierCurve
from .inscribed import equal_steps, is_isotopic, shares, too_few
from .names import table_name

FILE = Path(__file__).with_name("shapes.npz")
QUANTUM = 2.0**-13  # coefficients are stored as multiples of it, in 16 bits


@checked
def smooth_knot(name: str, vertices: int | None = None) -> Curve:
    """Make a knot or link of the table as a smooth curve with evenly spread strands.

    It is at rest under the tangent-point energy; its Möbius energy is up to 16 % (median 10 %) above the least known.
    Handedness is the table's: 3_1 is the right-handed trefoil; an m before the name gives the mirror image in the plane
    of the picture.  Names are spelt as for :func:`~mobius_flow.core.knots.knot`; ``vertices`` is the total number.

    Raises UnknownKnotError if no shape is stored for the name, and CurveError if the vertices are too few to follow the
    strands.

    >>> smooth_knot("hopf link", 60).mesh.component_sizes
    (30, 30)
    """
    entry, mirrored = table_name(name)
    shape = shapes()[entry]
    curve = proved = shape.polygon(shape.sizes)
    if vertices is not None:
        curve = shape.polygon(shares(vertices, proved.component_lengths))
        if not is_isotopic(proved, equal_steps(proved), curve, equal_steps(curve)):
            raise too_few(vertices)
    return curve.with_vertices(curve.vertices * [1.0, 1.0, -1.0]) if mirrored else curve


@cache
def shapes() -> Mapping[str, FourierCurve]:
    """All stored shapes by their names in the table."""
    with np.load(FILE) as stored:
        names, counts, modes = stored["names"], stored["components"], stored["modes"]
        values = QUANTUM * stored["coefficients"].astype(np.float64)
    rows = np.split(values[..., 0] + 1j * values[..., 1], np.cumsum(modes + 1)[:-1])
    parts = iter(rows)
    return MappingProxyType(
        {
            str(name): FourierCurve(tuple(next(parts) for _ in range(count)))
            for name, count in zip(names, counts, strict=True)
        }
    )
