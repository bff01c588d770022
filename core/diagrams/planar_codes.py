"""Diagrams from planar diagram codes: edges at each crossing, counterclockwise from the lower one coming in."""

from collections.abc import Hashable, Sequence

from ..errors import CurveError
from .diagram import Diagram, Pass
from .faces import Faces

_Dart = tuple[int, int]  # a crossing, and the place from 0 to 3 of one of its edges


def diagram_of(code: Sequence[Sequence[Hashable]]) -> Diagram:
    """The diagram of a planar diagram code.

    Parameters
    ----------
    code
        For each crossing the labels of its edges.  Components run as the code has their first lower pass.

    Raises
    ------
    CurveError
        If a crossing has not four edges, an edge not two ends, or the code cannot be drawn in the plane.
    """
    ends: dict[Hashable, list[_Dart]] = {}
    for c, edges in enumerate(code):
        if len(edges) != 4:
            raise CurveError(f"crossing {c + 1} of the planar diagram code has {len(edges)} edges; it must have 4")
        for place, label in enumerate(edges):
            ends.setdefault(label, []).append((c, place))
    for label, darts in ends.items():
        if len(darts) != 2:
            times = "once" if len(darts) == 1 else f"{len(darts)} times"
            raise CurveError(f"edge {label} is in the planar diagram code {times}; every edge must be there twice")
    mate = {dart: other for pair in ends.values() for dart, other in (pair, pair[::-1])}
    entries: dict[_Dart, Pass] = {}  # where strands come in
    components = []
    for start in [(c, place) for place in (0, 1) for c in range(len(code))]:
        if start not in entries and (start[0], start[1] + 2) not in entries:
            first = len(entries)
            dart = start
            while dart not in entries:
                entries[dart] = dart[0], dart[1] % 2 == 1
                dart = mate[dart[0], (dart[1] + 2) % 4]
            components.append(tuple(list(entries.values())[first:]))
    # A positive crossing's upper strand comes in on the left, the fourth edge from where the lower one comes in.
    signs = (1 if ((c, 0) in entries) == ((c, 3) in entries) else -1 for c in range(len(code)))
    diagram = Diagram(tuple(components), tuple(signs))
    if not Faces(diagram).is_planar:
        raise CurveError("the planar diagram code cannot be drawn in the plane")
    return diagram
