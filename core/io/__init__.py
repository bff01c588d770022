"""Curve files: read and write polygons, closed or open, and read codes of diagrams.

To add a format, write one module with ``read(source) -> list[Polygon]`` and ``write(curve, stream)`` and
give it a line in the table; reading, error messages and the atomic replacement are shared.
"""

from .codes import knot_list
from .formats import FORMATS, CurveFile, Format, format_of, load_curve, read_curve, write_curve, written_formats
