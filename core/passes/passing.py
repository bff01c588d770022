"""A strand move in space: lifted above all else, or lowered below it, the strand is led to another way.

Its heights increase strictly from its start to its end, so that it cannot meet itself whatever it does in the plane;
only where it comes down again, beyond its end, it can be in its own way.  Hence, if it does not go straight to the new
way, it is reeled in onto the segment from its start to its end, and out along the new way, from the far end both times:
then only its last edge turns, above where it comes down.
"""

import numpy as np

from ..diagrams.rerouting import Move
from ..types import FloatArray, IntArray
from .drawing import Drawing
from .moving import MovingCurve
from .route import Ends, routed

_ABOVE = 0.1  # of the curve's size: how far the lowest vertex of the strand is above the highest of the rest,
_RISE = 0.05  # and by how much the strand's end is above its start


def passed(body: MovingCurve, drawing: Drawing, move: Move) -> bool:
    """Make a move if that is proved free; whether it was.  If not, the curve may be half the way."""
    ends = Ends.of(drawing, move)
    way = routed(drawing, move, ends)
    strand = None if way is None else _prepared(body, drawing, ends, len(way))
    if way is None or strand is None:
        return False
    mark = body.mark()
    for top in _tops(body, move.strand.over):
        if _lifted(body, strand, top, move.strand.over) and _led(body, strand, way):
            return True
        body.rewind(mark)
    return False


def _tops(body: MovingCurve, over: bool) -> list[float]:
    """What a strand has to be above, upside down for strands that pass under: the curve, and then obstacles too."""
    up = 1.0 if over else -1.0
    tops = [float((up * body.seen[:, 2]).max())]
    walls = [float((up * (wall.vertices @ body.frame[:, 2])).max()) for wall in body.obstacles]
    return tops + [top for top in [max(walls, default=-np.inf)] if top > tops[0]]


def _prepared(body: MovingCurve, drawing: Drawing, ends: Ends, count: int) -> IntArray | None:
    """Insert the strand's ends, and so many vertices that it has as many as its new way; the vertices, in order."""
    mesh = drawing.mesh
    part = mesh.slices[mesh.component[int(ends.start)]]
    size = part.stop - part.start
    begin, stop = ends.start, ends.end + size * (ends.end < ends.start)
    inner = np.arange(np.floor(begin) + 1, np.ceil(stop))
    stops = np.array([begin, *inner, stop])
    corners = part.start + (np.floor(stops).astype(np.intp) - part.start) % size
    wrapped = corners + stops - np.floor(stops)
    lengths = np.linalg.norm(np.diff(drawing.placed(wrapped), axis=0), axis=1)
    extra = _between(stops, lengths, count - len(stops))
    extra = extra - size * (extra >= part.stop)
    places = np.sort([ends.foot, ends.start, ends.end, ends.landing, *extra])
    foot = int(ends.foot) + 1 + int(np.searchsorted(places, ends.foot))
    if len(np.unique(places)) < len(places) or not body.insert(places, first=foot):
        return None
    first = body.mesh.offsets[body.mesh.component[foot]] if mesh.closed[mesh.component[part.start]] else foot
    return first + 1 + np.arange(len(stops) + len(extra))


def _between(stops: FloatArray, lengths: FloatArray, count: int) -> FloatArray:
    """So many more stops, where the longest pieces are."""
    parts = np.ones(len(lengths))
    for _ in range(count):
        parts[np.argmax(lengths / parts)] += 1
    more = [a + (b - a) * np.arange(1, n) / n for a, b, n in zip(stops[:-1], stops[1:], parts, strict=True)]
    return np.concatenate(more)


def _lifted(body: MovingCurve, strand: IntArray, top: float, over: bool) -> bool:
    """Raise a strand above all else, or lower it below, the farther the later."""
    up = 1.0 if over else -1.0
    targets = body.seen[strand]
    targets[:, 2] = up * (top + body.size * (_ABOVE + _RISE * np.linspace(0.0, 1.0, len(strand))))
    return body.move(strand, targets)


def _led(body: MovingCurve, strand: IntArray, way: FloatArray) -> bool:
    """Lead a strand in the plane to another way, with as few motions as are free."""
    old = body.seen[strand]
    lengths = np.linalg.norm(np.diff(way, axis=0), axis=1)
    extra = _between(np.arange(len(way), dtype=float), lengths, len(old) - len(way))
    at = np.sort(np.concatenate([np.arange(len(way)), extra]))
    new = np.column_stack([np.interp(at, np.arange(len(way)), x) for x in way.T])
    return body.follow(strand, lambda turn: _reeled(old, new, turn), 2 * (len(old) - 2))


def _reeled(old: FloatArray, new: FloatArray, turn: int) -> FloatArray:
    """The strand after some of the vertices between its ends are reeled in, and then, after all of them, out."""
    inner = len(old) - 2
    laid = abs(inner - turn)  # so many vertices after the first are not on the segment to the end
    way = np.array(old)
    way[: laid + 1, :2] = (old if turn < inner else new)[: laid + 1, :2]
    rest = np.linspace(0.0, 1.0, inner + 2 - laid)[:, None]
    way[laid:, :2] = way[laid, :2] + rest * (old[-1, :2] - way[laid, :2])
    return way
