"""The symmetry group of a curve: how it can be laid upon itself, and upon its mirror image."""

from collections.abc import Callable, Sequence

import numpy as np

from ..arguments import check_number, checked
from ..curve import Curve, check_closed
from ..curve.alignment import Freedom, alignments
from ..errors import CurveError
from .group import SymmetryGroup
from .isometry import Fit, Isometry

TOLERANCE = 0.02  # radii of gyration: relaxed and balanced polygons are some .002 off
DISTINCT = 0.15  # norm of the difference of matrices that are not the same element
MOST = 120  # elements: those of the icosahedron's group; more have only curves that are round
MOST_COMPONENTS = 10  # for which all orders are looked at in a second


@checked
def symmetries(curve: Curve, tolerance: float = TOLERANCE) -> SymmetryGroup:
    """Find the isometries that map a closed curve in space to itself, but for a tolerance in radii of gyration.

    Directions of components are of no matter, nor is their order.  Möbius images of a symmetric curve are symmetric
    only where they are balanced (``--balance``).  Coaxial circles have the group C∞v or D∞h, of which there are no
    elements here but the identity.

    Raises CurveError if a component is open, or the curve is in another dimension or has over 10 components.
    """
    check_number("tolerance", tolerance, 0.0, 1.0)
    check_closed(curve, "symmetries")
    components = len(curve.mesh.component_sizes)
    if curve.dimension != 3:
        raise CurveError(f"the curve is in dimension {curve.dimension}; symmetries are for curves in space")
    if components > MOST_COMPONENTS:
        raise CurveError(f"the curve has {components} components; symmetries are found with up to {MOST_COMPONENTS}")
    centre = curve.edge_lengths @ curve.midpoints / curve.length
    identity = Isometry.identity(components)
    fit = Fit(curve, centre)
    mirrored = curve.with_vertices(2.0 * centre - curve.vertices)
    near = [
        Isometry.of(alignment, sign)
        for sign, other in ((1, curve), (-1, mirrored))
        for alignment in alignments(curve, other, Freedom(fixed=centre))
        if alignment.distance < tolerance + fit.coarseness
    ]
    if (axis := fit.axis_of_rotation(tolerance)) is not None:
        flips = any(each.matrix @ axis @ axis < -1.0 + DISTINCT for each in near)
        return SymmetryGroup("D∞h" if flips else "C∞v", centre, (identity,))
    elements = [identity]
    for each in sorted(map(fit, near), key=lambda each: each.distance):
        if each.distance <= tolerance and not _has(elements, each):
            elements = _closed([*elements, each], fit, tolerance) or elements
    return SymmetryGroup.of(elements, centre)


def _closed(
    elements: Sequence[Isometry], fit: Callable[[Isometry], Isometry], tolerance: float
) -> list[Isometry] | None:
    """All products of elements; None if some are no symmetries within the tolerance, or there are too many."""
    found = list(elements)
    for k, one in enumerate(found):  # which grows
        for other in found[: k + 1]:
            for product in (one.after(other), other.after(one)):
                if not _has(found, product):
                    fitted = fit(product)
                    if fitted.distance > tolerance or len(found) == MOST:
                        return None
                    found.append(fitted)
    return found


def _has(elements: Sequence[Isometry], one: Isometry) -> bool:
    return any(np.linalg.norm(each.matrix - one.matrix) < DISTINCT for each in elements)
