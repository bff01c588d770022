"""Curve files: read and write polygons, closed or open, as .txt/.xyz, .obj, .vect and .json.

To add a format, write one module with ``read(source) -> list[Polygon]`` and ``write(curve, stream)`` and
give it a line in :data:`FORMATS`; reading, error messages and the atomic replacement are shared.
"""

from .formats import FORMATS, CurveFile, Format, format_of, load_curve, read_curve, write_curve

__all__ = ["FORMATS", "CurveFile", "Format", "format_of", "load_curve", "read_curve", "write_curve"]
