"""Which smooth curves at rest are the same up to Möbius maps and isometries, and the image in which one is shown."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.linalg import eigh

from ...core.base import FloatArray, checked
from ...core.curve import bending
from ...core.driver.moves.balance import MoebiusImages, least_bending
from .energy import Basis, SampledPairs
from .fourier import FourierCurve
from .rest import RestingCurve, energy_of

SAME_ENERGY = 1e-6  # of the energy: ends at one curve differ by up to 4e-8
SAME_SHAPE = 3e-4  # of eigenvalues up to 1: those of one curve differ by up to 1e-5, of two types by 6e-3 or more
_POINTS = 8  # of the trapezoidal rule for each mode there was


@checked
def balanced(rest: RestingCurve) -> RestingCurve:
    """The Möbius image that bends least, about the origin, with radius 1, and the same energy up to its error.

    It needs hardly more modes, as the speeds of curves at rest are right for their Möbius images, too; where the
    largest number is not enough, the error grows by what is lost.
    """
    polygon = rest.curve.polygon(rest.curve.sizes)
    images = MoebiusImages(polygon, polygon.edge_lengths)
    image = min(map(images.vertices, least_bending(images, 3)), key=bending, default=polygon)
    points = image.vertices - image.edge_lengths @ image.midpoints / image.length
    image = image.with_vertices(points / np.linalg.norm(points, axis=1).max())
    for more in (1.0, 1.25, 1.5, 2.0, 2.5):  # times the modes that a Möbius image may need
        found = FourierCurve.through(image, [round(k * more) for k in rest.curve.modes])
        lost = abs(energy_of(found, math.ceil(_POINTS / more)) - rest.energy)
        if lost <= max(rest.error, 1e-13 * rest.energy):  # of the energy: rounding
            return replace(rest, curve=found)
    return replace(rest, curve=found, error=rest.error + lost)


@checked
def distinct(ends: Sequence[RestingCurve]) -> list[list[int]]:
    """Sort curves of one type into groups that are the same: their numbers, the group of least energy first.

    The first curve of a group has the smallest error.
    """
    spectra = [_spectrum(end.curve) for end in ends]
    groups: list[list[int]] = []
    for number in sorted(range(len(ends)), key=lambda k: (ends[k].error, k)):
        end, spectrum = ends[number], spectra[number]
        for group in groups:
            first = ends[group[0]]
            near = abs(end.energy - first.energy) <= end.error + first.error + SAME_ENERGY * end.energy
            if near and np.abs(spectrum - spectra[group[0]]).max() <= SAME_SHAPE:
                group.append(number)
                break
        else:
            groups.append([number])
    return sorted(groups, key=lambda group: ends[group[0]].energy)


def _spectrum(curve: FourierCurve) -> FloatArray:
    """The largest eigenvalues of the random walk on a curve that goes from x to y in proportion to the pair's energy.

    Neither Möbius maps nor parameters change them, and they are the same for mirror images.  Round circles have zeros.
    """
    basis = Basis.of(curve.modes, _POINTS // 2)
    shares = SampledPairs.of(basis, basis.unknowns(curve)).shares
    rates = np.sqrt(shares.sum(axis=1) + SAME_ENERGY * basis.weights)
    walk, count = shares / np.outer(rates, rates), len(rates)
    return np.asarray(eigh(walk, eigvals_only=True, subset_by_index=(count - 24, count - 1)))
