"""Which smooth curves at rest are the same one: alike in energy, and in shape up to Möbius maps and isometries."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arguments import checked
from ..curve.alignment import Freedom, alignments
from ..curve.fourier import FourierCurve
from ..curve.measures import bending
from ..driver.interventions.balance import MoebiusImages, least_bending
from .rest import Rest, energy_of

SAME_ENERGY = 1e-6  # of the energy, by which those of one curve differ beside their errors
SAME_SHAPE = 0.05  # radii of gyration: curves are compared at samples, half a spacing of which is up to 0.03
_GROWN = (1.0, 1.25, 1.5, 2.0, 2.5)  # times the modes, that a Möbius image needs
_POINTS = 8  # of the trapezoidal rule for each mode there was


@checked
def balanced(rest: Rest) -> Rest:
    """The Möbius image that bends least, about the origin, with radius 1, and the energy but for its error.

    It has hardly more modes, as the speeds that curves at rest have are those of their Möbius images, too.
    """
    polygon = rest.curve.polygon(rest.curve.sizes)
    images = MoebiusImages(polygon, polygon.edge_lengths)
    image = min(map(images.vertices, least_bending(images, 3)), key=bending, default=polygon)
    points = image.vertices - image.edge_lengths @ image.midpoints / image.length
    image = image.with_vertices(points / np.linalg.norm(points, axis=1).max())
    for more in _GROWN:
        found = FourierCurve.through(image, [round(k * more) for k in rest.curve.modes])
        if abs(energy_of(found, math.ceil(_POINTS / more)) - rest.energy) <= rest.error:
            break
    return replace(rest, curve=found)


@checked
def distinct(ends: Sequence[Rest], amphicheiral: bool = False) -> list[list[int]]:
    """Sort balanced curves of one type into those that are the same: numbers of each group, that of least energy first.

    The first of the same has the smallest error.  Mirror images of each other are the same where the type is
    ``amphicheiral``.
    """
    groups: list[list[int]] = []
    for number in sorted(range(len(ends)), key=lambda k: (ends[k].error, k)):
        same = (group for group in groups if _same(ends[group[0]], ends[number], amphicheiral))
        group = next(same, None)
        if group is None:
            groups.append([number])
        else:
            group.append(number)
    return sorted(groups, key=lambda group: ends[group[0]].energy)


def _same(one: Rest, other: Rest, amphicheiral: bool) -> bool:
    if abs(one.energy - other.energy) > one.error + other.error + SAME_ENERGY * one.energy:
        return False
    images = [other.curve, other.curve.mirrored][: 1 + amphicheiral]
    polygons = (image.polygon(image.sizes) for image in images)
    here = one.curve.polygon(one.curve.sizes)
    return any(alignments(polygon, here, Freedom())[0].distance < SAME_SHAPE for polygon in polygons)
