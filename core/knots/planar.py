"""Knots and links from diagrams, which are drawn along the lines of a grid, and their crossings lifted into space.

Drawings have as few bends as there can be, all lengths being whole numbers.  So strands are 1 or more apart, and the
drawing is no wider than it has crossings, bends and cuts.  On the way round a face, which is on the left, the quarters
turned to the left, less those to the right, are 4, and −4 round the outer one: crossings give one each, and bends what
is missing, as a least flow between faces (R. Tamassia, *SIAM Journal on Computing* 16, 1987).  Then faces are cut into
rectangles: in these it is enough that all lines have length 1 or more.
"""

from collections import deque
from collections.abc import Iterator
from itertools import islice, pairwise

import numpy as np
import scipy.sparse as sp

from ..base import CurveError, FloatArray
from ..collision import check_embedded
from ..curve import MAKERS, Curve, refine
from .diagrams import Diagram, diagram_of, views
from .diagrams.rerouting import rearranged, without_nugatory
from .inscribed import MAX_VERTICES


def redrawn(curve: Curve, count: int, seed: int) -> Iterator[Curve]:
    """Closed curves of the same type, ``count`` at most, drawn from other diagrams with other faces outside.

    Each is four steps from the last: a random view is brought to few crossings and drawn, and that is seen from another
    side.  There are none for what no view shows as one piece with crossings.
    """
    rng, seen = np.random.default_rng(seed), set[float]()
    for step in range(1, 8 * count + 1):
        *_, view = views(curve, 2, int(rng.integers(2**32)))
        diagram = without_nugatory(rearranged(view, rng))
        if not diagram.crossings or len(diagram.pieces()) > 1:
            return
        curve = drawn(diagram, int(rng.integers(len(diagram.faces))))
        size = round(float(np.linalg.norm(curve.vertices)), 6)  # the same of one diagram, wherever it begins
        if step % 4 == 0 and size not in seen:
            seen.add(size)
            yield curve
        if len(seen) == count:
            return


def drawn(diagram: Diagram, outer: int | None = None) -> Curve:
    """A polygon that looks like a diagram from above, nugatory crossings left out; its parts lie side by side.

    Their largest faces are outside, or ``outer`` is, by its number, of a diagram in one piece without such crossings.
    """
    parts: list[FloatArray] = []
    right = 0.0
    for piece in without_nugatory(diagram).pieces():
        if piece.crossings:
            strands, places = [], grid_drawing(piece, outer)
            for (_, over), path, after in zip(piece.sequence, places, piece.next, strict=True):
                # corners at bends are cut off, at 0.3 of a line of the grid on both sides
                steps = 0.3 * np.sign(np.diff(path, axis=0, append=places[after][:1]))
                corners = np.stack([path[1:] - steps[:-1], path[1:] + steps[1:]], axis=1).reshape(-1, 2)
                heights = [0.5 if over else -0.5, *[0.0] * len(corners)]
                strands.append(np.column_stack([np.concatenate([path[:1], corners]), heights]))
            rest = iter(strands)
            drawing = [np.concatenate(list(islice(rest, len(passes)))) for passes in piece.passes]
        else:
            angle = 2.0 * np.pi * np.arange(12) / 12
            drawing = [np.column_stack([np.cos(angle), np.sin(angle), np.zeros(12)])]
        left, *_ = np.min([part.min(axis=0) for part in drawing], axis=0)
        parts += [part + np.array([right - left, 0.0, 0.0]) for part in drawing]
        right = 1.0 + max(float(part[:, 0].max()) for part in parts)
    curve = Curve.from_components(parts)
    low, high = curve.vertices.min(axis=0), curve.vertices.max(axis=0)
    curve = curve.with_vertices((curve.vertices - 0.5 * (low + high)) * (2.0 / max(high - low)))
    check_embedded(curve)
    return curve


def _of_link(other: object) -> Curve | None:
    """The drawing of an object that has a planar diagram code, or is made from one that has; None for others."""
    makes_link = getattr(other, "link", None)  # as SnapPy's manifolds do
    try:
        link = makes_link() if callable(makes_link) and not hasattr(other, "PD_code") else other
    except ValueError as error:
        raise CurveError(f"{str(other)[:60]} has no link: {str(error)[:200]}") from error
    code_of = getattr(link, "PD_code", None)
    if not callable(code_of):
        return None
    code = [tuple(map(int, edges)) for edges in code_of()]
    diagram = diagram_of(code) if code else Diagram((), ())
    circles = int(getattr(link, "unlinked_unknot_components", 0) or not code)  # which the code does not have
    return drawn(Diagram((*diagram.passes, *((),) * circles), diagram.signs))


MAKERS.append(_of_link)


def refined(curve: Curve, vertices: int | None) -> Curve:
    """The drawing of a diagram with a number of vertices, if one is given; or CurveError."""
    if vertices is None:
        return curve
    if not len(curve) <= vertices <= MAX_VERTICES:
        few = "few" if vertices < len(curve) else "many"
        raise CurveError(f"{vertices} vertices are too {few} for this diagram; give {len(curve)} to {MAX_VERTICES}")
    return refine(curve, vertices)


def grid_drawing(piece: Diagram, outer: int | None = None) -> list[FloatArray]:
    """Draw a connected diagram in the plane that has crossings, none of them nugatory, its largest face outside.

    Returns for each pass its place and those of the bends of the edge after it, shape (1 + bends, 2).
    """
    # by darts, 2k along line k and 2k + 1 back; weights by lines
    tails, turns, weights = list[int](), list[int](), list[float]()
    cutting = 0.01  # weight of the length of a line that only cuts faces, beside one of the drawing

    def line(start: int, end: int, weight: float, turn: int, turn_back: int) -> int:
        """The dart along a new line between two nodes, and the quarters to the left where it, and the one back, end."""
        tails.extend([start, end])
        turns.extend([turn, turn_back])
        weights.append(weight)
        return len(tails) - 2

    if outer is None:
        outer = max(range(len(piece.faces)), key=lambda k: len(piece.faces[k]))
    nodes, paths, lines = piece.crossings, [], []
    for edge, bends in enumerate(fewest_bends(piece, outer)):
        begin, end = (piece.sequence[i][0] for i in (edge, piece.next[edge]))
        count, way = abs(bends), 1 if bends > 0 else -1
        path = [begin, *range(nodes, nodes + count), end]
        nodes += count
        paths.append(path[:-1])
        quarters = [*[way] * count, 1], [1, *[-way] * count]
        lines.append([line(a, b, 1.0, *both) for (a, b), *both in zip(pairwise(path), *quarters, strict=True)])
    frame = [line(nodes + k, nodes + (k + 1) % 4, cutting, 1, -1) for k in range(4)]  # round everything
    nodes += 4
    cycles = [
        [dart + back for edge, back in (divmod(each, 2) for each in face) for dart in lines[edge][:: 1 - 2 * back]]
        for face in piece.faces
    ]
    around = [*cycles, frame, [dart + 1 for dart in frame[::-1]]]
    after = {a: b for cycle in around for a, b in pairwise([*cycle, cycle[0]])}
    before = {b: a for a, b in after.items()}

    def cut(dart: int, opposite: int) -> int:
        """Draw a line straight on from a dart's end to another dart, which cuts their face in two, or joins two."""
        nonlocal nodes
        rest = line(nodes, tails[opposite ^ 1], weights[opposite // 2], turns[opposite], 0)
        new = line(tails[after[dart]], nodes, cutting, 1, 1)
        tails[opposite ^ 1] = nodes
        turns[opposite], turns[dart], nodes = 1, turns[dart] + 1, nodes + 1
        here, beyond = [dart, new, rest, after[opposite]], [before[opposite ^ 1], rest + 1, opposite ^ 1]
        for path in here, [opposite, new + 1, after[dart]], beyond:
            for a, b in pairwise(path):
                after[a], before[b] = b, a
        return new

    cut(next(dart for dart in cycles[outer] if turns[dart] < 0), frame[0])
    for cycle in cycles:
        face = [cycle[0]]
        while (dart := after[face[-1]]) != cycle[0]:
            face.append(dart)
        corners = deque(dart for dart in face if turns[dart])
        while len(corners) > 4:  # after a turn to the right and two to the left comes what is opposite the first
            if [turns[corners[k]] for k in range(3)] == [-1, 1, 1]:
                dart, _, side = (corners.popleft() for _ in range(3))
                opposite = after[side]
                new = cut(dart, opposite)
                if corners[0] == opposite:
                    corners[0] = after[new]
                corners.appendleft(new)
                corners.rotate(2)
            else:
                corners.rotate(-1)
    heading, waiting = {frame[0]: 0}, [frame[0]]
    for dart in waiting:
        for other, way in ((after[dart], heading[dart] + turns[dart]), (dart ^ 1, heading[dart] + 2)):
            if other not in heading:
                heading[other] = way % 4
                waiting.append(other)
    places = []
    for axis in (0, 1):
        along = [(tails[d], tails[d ^ 1], weights[d // 2]) for d, way in heading.items() if way == axis]
        across = [(tails[d], tails[d ^ 1]) for d, way in heading.items() if way == 1 - axis]
        places.append(_spread(along, across, nodes))
    return [np.column_stack(places)[path] for path in paths]


def fewest_bends(piece: Diagram, outer: int) -> list[int]:
    """For each edge its bends to the left, or less than 0 to the right, as few as there can be, by linear programming.

    ``outer`` is the number of the face that is outside.
    """
    from scipy.optimize import linprog

    edges = len(piece.sequence)
    face, dart = np.array([(k, dart) for k, darts in enumerate(piece.faces) for dart in darts]).T
    flow = sp.coo_array((1 - 2 * (dart % 2), (face, dart // 2)), shape=(len(piece.faces), edges))
    missing = [(-4 if k == outer else 4) - len(darts) for k, darts in enumerate(piece.faces)]
    found = linprog(np.ones(2 * edges), A_eq=sp.hstack([flow, -flow]).tocsc(), b_eq=missing, method="highs-ds").x
    return [round(left - right) for left, right in found.reshape(2, edges).T.tolist()]


def _spread(lines: list[tuple[int, int, float]], across: list[tuple[int, int]], nodes: int) -> FloatArray:
    """A coordinate that lines across leave equal, and along others, with weights, grows by 1 or more, but little."""
    from scipy.optimize import linprog

    joined = sp.coo_array((np.ones(len(across)), np.array(across).T), shape=(nodes, nodes))
    count, group = sp.csgraph.connected_components(joined, directed=False)
    tail, head, weight = np.array(lines).T
    rows = np.arange(len(lines))
    signs, columns = np.repeat([1, -1], len(lines)), group[np.concatenate([tail, head]).astype(int)]
    back = sp.coo_array((signs, (np.tile(rows, 2), columns)), shape=(len(lines), count)).tocsc()
    found = linprog(-weight @ back, A_ub=back, b_ub=-np.ones(len(lines)), method="highs-ds").x
    return np.asarray(np.round(found)[group])
