"""Curve files: read and write polygons, closed or open, and read codes of diagrams.

To add a format, write one module with ``read(source) -> list[Polygon]`` and ``write(curve, stream)`` and
give it a line in :data:`FORMATS`; reading, error messages and the atomic replacement are shared.
"""

from .formats import FORMATS, WRITTEN_FORMATS, CurveFile, Format, format_of, load_curve, read_curve, write_curve
from .lists import knot_list

__all__ = [
    "FORMATS",
    "WRITTEN_FORMATS",
    "CurveFile",
    "Format",
    "format_of",
    "knot_list",
    "load_curve",
    "read_curve",
    "write_curve",
]
