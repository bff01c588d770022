"""Tubes as solids to print: STL and 3MF, by trimesh."""

from .arguments import checked
from .collision.gap import thickness
from .curve import Curve
from .errors import CurveError, MobiusFlowError
from .tube import Tube, tubes

_PART = 0.9  # of the thickness, for a wire whose width nobody has said
_SIDES = 32


@checked
def wire(curve: Curve, width: float | None = None) -> list[Tube]:
    """Tubes of a width in the curve's units, by default nine tenths of the widest.

    Raises CurveError where they would run into themselves or each other: the widest is twice the thickness.
    """
    if curve.dimension > 3:
        raise CurveError(f"the curve is in dimension {curve.dimension}; wires are of curves in the plane or in space")
    widest = 2.0 * thickness(curve)
    width = _PART * widest if width is None else width
    if not 0.0 < width <= widest:
        advice = f"this curve has room for {widest:.4g}; scale it, or relax it further"
        raise CurveError(f"a wire {width:g} wide has no width, or runs into itself: {advice}")
    return [tube for (tube,) in tubes([curve], 0.5 * width, _SIDES)]


@checked
def solid(curve: Curve, kind: str, width: float | None = None) -> bytes:
    """A file of kind ``stl`` or ``3mf`` with closed surfaces, in millimetres; raises as `wire`, or without trimesh."""
    parts = wire(curve, width)
    try:
        import lxml  # noqa: F401 (trimesh needs these two for 3MF)
        import networkx  # noqa: F401
        import trimesh
    except ImportError as error:
        raise MobiusFlowError('solids need trimesh: pip install trimesh lxml networkx (the extra "view")') from error
    scene = trimesh.Scene([trimesh.Trimesh(part.points, part.faces, process=False) for part in parts])
    scene.units = "millimeters"
    return bytes(scene.export(file_type=kind))
