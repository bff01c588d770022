"""Smooth shapes of the table's knots and links, stored as a few Fourier coefficients, and their least known energies.

``tools/knot_shapes.py`` makes ``shapes.npz``, and proves that each polygon made here has the type its name says.
``least_energies.csv`` is the table of an atlas, ``data/atlas.csv``.
"""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import MappingProxyType

import numpy as np

from ..base import ComplexArray, checked
from ..curve import Curve
from .inscribed import equal_steps, is_isotopic, shares, too_few
from .names import table_name

FILE, TABLE = (Path(__file__).with_name(name) for name in ("shapes.npz", "least_energies.csv"))
QUANTUM = 2.0**-13  # coefficients are stored as multiples of it, in 16 bits


@dataclass(frozen=True, eq=False)
class SmoothShape:
    """A smooth knot or link.

    For each component there are coefficients c, shape (modes + 1, 3): it is t ↦ Re Σₖ cₖ e^{2πikt}, 0 ≤ t < 1.
    """

    coefficients: tuple[ComplexArray, ...]

    @property
    def modes(self) -> list[int]:
        """The highest frequency of each component."""
        return [len(c) - 1 for c in self.coefficients]

    @property
    def sizes(self) -> list[int]:
        """Numbers of vertices, for each component, that represent it as a polygon."""
        return [max(64, 10 * modes) for modes in self.modes]

    def polygon(self, sizes: Sequence[int]) -> Curve:
        """Inscribe a polygon with so many vertices on each component, at equal steps of t."""
        parts = []
        for c, n in zip(self.coefficients, sizes, strict=True):
            waves = np.exp(2j * np.pi * np.outer(np.arange(n) / n, np.arange(len(c))))
            parts.append((waves @ c).real)
        return Curve.from_components(parts)


@checked
def smooth_knot(name: str, vertices: int | None = None) -> Curve:
    """Make a knot or link of the table in the shape of least Möbius energy, but with strands far enough apart to see.

    In the smooth minimum some strands are at a tenth of their distance here or less, to save at most 2 % of energy.
    Handedness is the table's: 3_1 is the right-handed trefoil; an m before the name gives the mirror image in the plane
    of the picture.  Names are spelt as for :func:`~mobius_flow.core.knots.knot`; ``vertices`` is the total number.

    Raises UnknownKnotError if no shape is stored for the name, and CurveError if the vertices are too few to follow the
    strands.

    >>> smooth_knot("hopf link", 60).mesh.component_sizes
    (30, 30)
    """
    entry, mirrored = table_name(name)
    shape = shapes()[entry]
    proved, sizes = shape.polygon(shape.sizes), [max(5 * modes, 64) for modes in shape.modes]
    curve = shape.polygon(sizes if vertices is None else shares(vertices, proved.component_lengths))
    if not is_isotopic(proved, equal_steps(proved), curve, equal_steps(curve)):
        raise too_few(len(curve))
    return curve.with_vertices(curve.vertices * [1.0, 1.0, -1.0]) if mirrored else curve


@cache
def shapes() -> Mapping[str, SmoothShape]:
    """All stored shapes by their names in the table."""
    with np.load(FILE) as stored:
        names, counts, modes = stored["names"], stored["components"], stored["modes"]
        values = QUANTUM * stored["coefficients"].astype(np.float64)
    rows = np.split(values[..., 0] + 1j * values[..., 1], np.cumsum(modes + 1)[:-1])
    parts = iter(rows)
    return MappingProxyType(
        {
            str(name): SmoothShape(tuple(next(parts) for _ in range(count)))
            for name, count in zip(names, counts, strict=True)
        }
    )


@cache
def least_energies() -> Mapping[str, tuple[float, float]]:
    """The least Möbius energies known of smooth curves, and how far they may be off, by names of the table."""
    with TABLE.open(encoding="utf-8", newline="") as stream:
        rows = csv.DictReader(stream)
        return MappingProxyType({row["type"]: (float(row["energy"]), float(row["error"])) for row in rows})
