"""Check recorded motions of curves by whole numbers alone: ``python check_trajectory.py T.npz ...``.

What a file must fulfil is in docs/certificate.md.  Exit status: 0 accepted, 1 rejected.  This needs Python's standard
library only, and shares no line with the program that writes such files, nor with its ``verify``.  Doubles are whole
numbers in a unit that is a power of two, and nothing is rounded.  Of two edges

1. planes that stand still for a part of the time may show that they are apart;
2. else they can meet where the volume of the four ends, a cubic polynomial in time, is zero: at its roots, isolated by
   Descartes' rule, signs of quadratic polynomials tell whether they do;
3. if it is zero all the time, meeting is a matter of signs of finitely many polynomials, the same between neighbouring
   roots of these; as the times of contact are a closed set, a root or an end of the leg is one, or none is.
"""

import ast
import struct
import sys
import zipfile
import zlib
from itertools import chain, combinations, pairwise, product
from math import gcd, isfinite, prod
from operator import index, mul

DECISIONS, PER_LEG = 3000, 200  # exact ones, of a file and for each of its legs: files made to take days need more
ROUNDING_UNITS = 16  # distance from its edge, in units of the last place, of a vertex inserted or removed
FINER = 64  # extra bits in the unit for a place on an edge, compared with coordinates
DAMAGE = (OSError, EOFError, zipfile.BadZipFile, zlib.error, struct.error, RuntimeError, ValueError, OverflowError)
HEADERS = (KeyError, MemoryError, RecursionError, SyntaxError, TypeError, ValueError)  # what bad headers may raise
CODES = {"f8": "d", "b1": "?", "i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "i8": "q", "u8": "Q"}
WHOLE = "bBhHiIqQ"


def need(condition, reason):
    if not condition:
        raise ValueError(reason)


# Polynomials: c[0] w^n + c[1] w^(n-1) v + ... + c[n] v^n with w = 1 - t, v = t, so that (a, b) goes from a to b.  Where
# 0 < t < 1 the sign is that of c[0] + c[1] u + ... in u = v / w > 0; divisions are of these polynomials in u.


def times(p, q):
    result = [0] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            result[i + j] += a * b
    return result


def minus(p, q):
    return [a - b for a, b in zip(p, q, strict=True)]


def plus(p, q):
    return [a + b for a, b in zip(p, q, strict=True)]


def changes(p):
    """Changes of sign: as many as there are roots 0 < t < 1, counted with multiplicity, or an even number more."""
    signs = [c > 0 for c in p if c]
    return sum(a != b for a, b in pairwise(signs))


def between(p, i, j, m):
    """A positive multiple of the polynomial, with times 0 and 1 mapped to this one's i/m and j/m."""
    result = [0] * len(p)
    for k, c in enumerate(p):
        term = [c]
        for factor in [(m - i, m - j)] * (len(p) - 1 - k) + [(i, j)] * k:
            term = times(term, factor)
        result = plus(result, term)
    return result


def trimmed(p):
    degree = max((k for k, c in enumerate(p) if c), default=-1)
    return [c // gcd(*p) for c in p[: degree + 1]]


def divided(p, q):
    """Quotient and remainder, each up to a factor."""
    rest, quotient = list(p), []
    while len(rest) >= len(q):
        lead, shift = rest[-1], len(rest) - len(q)
        quotient = [lead, *(q[-1] * c for c in quotient)]
        rest = minus([q[-1] * c for c in rest], [0] * shift + [lead * c for c in q])[:-1]
    return trimmed(quotient), trimmed(rest)


def common_divisor(p, q):
    p, q = trimmed(p), trimmed(q)
    while q:
        p, q = q, divided(p, q)[1]
    return p


def roots(p):
    """The roots 0 < t < 1 of a non-zero polynomial: (p, i, j, m) with i/m < t < j/m, or t = i/m = j/m."""
    work = [(0, 1, 1)] if changes(p) else []
    if work:
        p = divided(p, common_divisor(p, [k * c for k, c in enumerate(p)][1:]))[0]  # which has no multiple roots
    while work:
        i, j, m = work.pop()
        count = changes(between(p, i, j, m))
        if count == 1:
            yield p, i, j, m
        elif count > 1:
            if not between(p, i + j, i + j, 2 * m)[0]:
                yield p, i + j, i + j, 2 * m
            work += [(2 * i, i + j, 2 * m), (i + j, 2 * j, 2 * m)]


def sign(q, time):
    """A number that has the sign of a polynomial at a root, or at a known time."""
    p, i, j, m = time
    while changes(here := between(q, i, j, m)):
        if changes(between(common_divisor(p, q), i, j, m)) % 2:  # the root is one of both
            return 0
        middle, m = i + j, 2 * m
        if not between(p, middle, middle, m)[0]:
            return between(q, middle, middle, m)[0]
        i, j = (2 * i, middle) if changes(between(p, 2 * i, middle, m)) % 2 else (middle, 2 * j)
    return here[0] if i == j else sum(here)


# Contact: a point is a tuple of three whole numbers, a motion a pair of points, at the times 0 and 1.

START, END = (None, 0, 0, 1), (None, 1, 1, 1)


def dot(u, v):
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def cross(u, v, multiplied=mul, less=int.__sub__):
    return [less(multiplied(u[i], v[j]), multiplied(u[j], v[i])) for i, j in ((1, 2), (2, 0), (0, 1))]


def meet(*ends):
    """Whether edges x0 x1 and y0 y1, whose four ends are motions, have a common point at any time."""
    x0, x1, y0, y1 = (list(zip(*motion, strict=True)) for motion in ends)  # coordinates as polynomials in time
    a, b, c, d = (list(map(minus, p, q)) for p, q in ((x0, y0), (x0, y1), (x1, y0), (x1, y1)))
    e, f = list(map(minus, x1, x0)), list(map(minus, y1, y0))
    normal = cross(e, f, times, minus)
    volume = [sum(terms) for terms in zip(*map(times, normal, a), strict=True)]
    # for each end and the other edge: its distances from that edge's ends, and the area that they span
    beside = [(p, q, cross(g, p, times, minus)) for p, q, g in ((a, b, f), (c, d, f), (a, c, e), (b, d, e))]
    if any(volume):
        moments = chain([at for at in (START, END) if not sign(volume, at)], roots(volume))
    else:
        polynomials = chain(normal, a, b, c, d, *(area for _, _, area in beside))
        moments = chain((START, END), *(roots(p) for p in polynomials))
    return any(touch(time, normal, beside) for time in moments)


def touch(time, normal, beside):
    """Whether edges that lie in one plane at a time have a common point then."""
    for axis, component in enumerate(normal):
        if sign(component, time):  # seen along the axis, each edge has the ends of the other on both sides of it
            sides = [sign(area[axis], time) for _, _, area in beside]
            return sides[0] * sides[1] <= 0 and sides[2] * sides[3] <= 0
    return any(  # parallel, or of no length: an end of one is on the other
        not any(sign(each, time) for each in area)
        and all(sign(p, time) * sign(q, time) <= 0 for p, q in zip(first, last, strict=True))
        for first, last, area in beside
    )


def meet_triangle(x0, x1, *corners):
    """Whether an edge meets a triangle whose corners are at rest; all are motions.

    If they are apart at first, then at first contact the edge meets one of the triangle's, or has an end inside it.
    """
    if any(meet(x0, x1, p, q) for p, q in combinations(corners, 2)):
        return True
    return any(pierces(*way, *(corner for corner, _ in corners)) for way in ((x0[0], x1[0]), x0, x1))


def pierces(p, q, a, b, c):
    """Whether a segment that does not meet the edges of a triangle meets it."""
    normal = cross(minus(b, a), minus(c, a))
    before, after = dot(normal, minus(p, a)), dot(normal, minus(q, a))
    if not any(normal) or before * after > 0:
        return False
    along = normal if before == after else minus(q, p)  # the direction around which the corners turn
    turns = [dot(along, cross(minus(u, p), minus(v, p))) for u, v in ((a, b), (b, c), (c, a))]
    return min(turns) > 0 or max(turns) < 0


def apart(first, second, halvings=4):
    """Whether fixed planes, each for a part of the time, separate an edge from another or a triangle, by their corners.

    The distance from a fixed plane is linear in time.
    """
    for normal in normals(*([plus(*motion) for motion in corners] for corners in (first, second))):
        above, below = ([[dot(normal, motion[t]) for motion in each] for t in (0, 1)] for each in (first, second))
        if min(above[0]) > max(below[0]) and min(above[1]) > max(below[1]):
            return True
    if not halvings:
        return False
    halves = [[(plus(p, p), plus(p, q), plus(q, q)) for p, q in corners] for corners in (first, second)]
    return all(apart(*([way[k : k + 2] for way in each] for each in halves), halvings - 1) for k in (0, 1))


def normals(first, second):
    """Directions in which the first may be above the second, for corners halfway."""
    yield (chord := [sum(column) for column in zip(*(minus(p, q) for p in first for q in second), strict=True)])
    e, *sides = (minus(q, p) for p, q in chain(combinations(first, 2), combinations(second, 2)))
    for u, v in chain(((e, side) for side in sides), combinations(sides[:2], 2)):
        normal = cross(u, v)
        yield normal if dot(normal, chord) > 0 else [-c for c in normal]


class Mesh:
    """Edges of polygons, and further pairs that must not meet: a vertex, as an edge of no length, and an edge.

    Where neighbouring edges fold together, the edge after them is met too, except in triangles, where no vertex may
    meet the opposite edge, and in open polygons, where no end may meet the edge after its neighbour.
    """

    def __init__(self, sizes, closed):
        self.closed, self.parts, self.edges, self.corners, first = closed, [], [], [], 0
        for size, is_closed in zip(sizes, closed, strict=True):
            need(size >= 2 + is_closed, f"a component has {size} vertices, which are too few")
            v = range(first, first := first + size)
            self.parts.append(v)
            self.edges += [*pairwise(v), *([(v[-1], v[0])] if is_closed else [])]
            if is_closed and size == 3:
                self.corners += [((v[k], v[k]), (v[k - 2], v[k - 1])) for k in range(3)]
            elif not is_closed:
                self.corners += [((v[0],) * 2, (v[1], v[:3][-1])), ((v[-1],) * 2, (v[-2], v[-3:][0]))]

    def straightened(self, points, kept, least):
        """The points, after those not kept have moved onto the edges between those that are.

        ``least``: bits of the last place of the smallest doubles, which have fewer digits.
        """
        moved = list(points)
        for part, closed, indices in zip(self.parts, self.closed, kept, strict=True):
            own = [points[k] for k in part]
            for i, j in pairwise([*indices, indices[0] + len(own)] if closed else indices):
                u, v, last = own[i], own[j % len(own)], 0
                edge = minus(v, u)
                for k in (k % len(own) for k in range(i + 1, j)):
                    at = (dot(minus(own[k], u), edge) << FINER) // max(dot(edge, edge), 1)
                    place = tuple(c + (at * d >> FINER) for c, d in zip(u, edge, strict=True))  # exactly
                    bits = max(map(abs, chain(u, v, own[k]))).bit_length() - 53
                    near = max(map(abs, minus(place, moved[part[k]]))) <= ROUNDING_UNITS << max(bits, least)
                    need(near and last < at < 1 << FINER, f"vertex {part[k] + 1} is not on the edge it must be on")
                    moved[part[k]], last = place, at
        return moved


def kept_vertices(first, second, closed):
    """Indices, in both polygons, of the vertices that they share, in the same order."""
    places = {p: k for k, p in enumerate(second)}
    here = [k for k, p in enumerate(first) if p in places]
    there = [places[first[k]] for k in here]
    turns = sum(b <= a for a, b in pairwise([*there, *there[:1]]))
    need(len(here) >= 2 + closed and turns == 1, "too few vertices are kept, or they are not in the same order")
    ends = [here[0], here[-1], there[0], there[-1]]
    need(closed or ends == [0, len(first) - 1, 0, len(second) - 1], "an end of an open component is not kept")
    return here, sorted(there)


def boxes(groups):
    columns = (list(zip(*group, strict=True)) for group in groups)
    return [(tuple(map(min, each)), tuple(map(max, each))) for each in columns]


def overlapping(first, second):
    """Indices of boxes, one of each list, that overlap; each pair once if both are the same list."""
    same, order = first is second, sorted(range(len(second)), key=lambda k: second[k][0])
    for place, i in enumerate(order if same else range(len(first))):
        (a, b, c), (d, e, f) = first[i]
        for j in order[place + 1 if same else 0 :]:
            (u, v, w), (x, y, z) = second[j]
            if u > d:
                break
            if a <= x and b <= y and v <= e and c <= z and w <= f:
                yield i, j


class Check:
    """A file, and how much of it has been checked."""

    def __init__(self, path):
        self.legs, self.decisions, self.archive = 0, 0, zipfile.ZipFile(path)
        self.names = self.archive.namelist()
        need(len(set(self.names)) == len(self.names), "two arrays have one name")

    def array(self, name, kinds, dimension):
        """Shape and entries, in C order, of an array of one of the allowed types, given by their codes."""
        need(f"{name}.npy" in self.names, f"{name} is missing")
        info = self.archive.getinfo(f"{name}.npy")
        need(info.compress_type in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED), f"{name} is not packed as by NumPy")
        with self.archive.open(info) as stream:
            width = {b"\x93NUMPY\1\0": 2, b"\x93NUMPY\2\0": 4}.get(stream.read(8), 0)
            length = int.from_bytes(stream.read(width), "little")
            need(0 < length <= 1000, f"{name} is not in NumPy's format 1.0 or 2.0, or has too long a header")
            try:
                header = ast.literal_eval(stream.read(length).decode("latin1"))
                shape, (order, *kind) = header["shape"], header["descr"]
                code, count = CODES["".join(kind)], prod(map(index, shape))
            except HEADERS:
                raise ValueError(f"{name} has a header that cannot be read") from None
            right = code in kinds and len(shape) == dimension and order in ("<" if code == "d" else "<>|")
            need(right, f"{name} is an array {shape} of {header['descr']}, which is not what it must be")
            size = count * struct.calcsize(f"={code}")
            need(info.file_size == 8 + width + length + size, f"{name} is shorter or longer than its header says")
            values = struct.unpack(f"{order.replace('|', '=')}{count}{code}", stream.read(size + 1))
        need(all(map(isfinite, values)), f"{name}: a coordinate is not finite")
        if header["fortran_order"]:
            strides = [prod(shape[:k]) for k in range(dimension)]
            values = tuple(values[sum(map(mul, place, strides))] for place in product(*map(range, shape)))
        return shape, values

    def numbered(self, kind, *parts):
        """The names, without parts, of the arrays of a kind, numbered from 000 on; each must have all its parts."""
        found = {name for name in self.names if name.startswith(f"{kind}_")}
        names = [f"{kind}_{k:03d}" for k in range(len(found) // len(parts))]
        need(found == {f"{a}{b}.npy" for a, b in product(names, parts)}, f"{kind}_000, {kind}_001, ... are incomplete")
        return names

    def obstacle(self, name):
        """Its triangles; a segment becomes a triangle without area."""
        (_, dimension), coordinates = self.array(f"{name}_vertices", "d", 2)
        (count, corners), faces = self.array(f"{name}_faces", WHOLE, 2)
        need(count and corners in (2, 3) and dimension == 3, f"{name} is not of shapes (k, 3) and (f, 2 or 3)")
        points = rows(coordinates, 3)
        need(all(0 <= k < len(points) for k in faces), f"{name}_faces: an index has no vertex")
        return [[points[face[k]] for k in (0, 1, -1)] for face in rows(faces, corners)]

    def stage(self, name):
        """Its mesh and its frames, which are lists of vertices."""
        sizes_name, flags = (name.replace("stage", f"component_{kind}") for kind in ("sizes", "closed"))
        _, sizes = self.array(sizes_name, WHOLE, 1)
        closed = self.array(flags, "?", 1)[1] if f"{flags}.npy" in self.names else (True,) * len(sizes)
        need(0 < len(sizes) == len(closed), f"{sizes_name} is empty, or does not fit {flags}")
        (count, vertices, m), values = self.array(name, "d", 3)
        need(count and m in (2, 3) and vertices == sum(sizes), f"{name} does not fit its components, or is empty")
        return Mesh(sizes, closed), [rows(frame, m) for frame in rows(values, m * vertices)]

    def run(self):
        """Check it, and yield what is checked next; a ValueError says what is wrong."""
        triangles = [each for name in self.numbered("obstacle", "_faces", "_vertices") for each in self.obstacle(name)]
        (_, size), values = self.array("pins", "d", 2) if "pins.npy" in self.names else ((0, 0), ())
        pins = rows(values, size)
        stages = [self.stage(name) for name in self.numbered("stage", "")]
        need(stages, "there is no stage_000")
        points = [*chain(*triangles), *chain(*(frame for _, frames in stages for frame in frames))]
        need(len({*map(len, points)}) == 1, "stages, or obstacles, are of different dimensions")
        largest = max(x.as_integer_ratio()[1] for x in chain(*points))
        self.bits = largest.bit_length() + FINER  # the unit is 2^(1 - bits)
        self.triangles, before = [self.whole(corners) for corners in triangles], None
        self.around = boxes(self.triangles)
        for number, (mesh, frames) in enumerate(stages):
            yield f"stage {number}: "
            last = self.whole(frames[0])
            if before:
                self.change(*before, last, mesh)
            need(all(pin in frames[0] for pin in pins), "at a pin there is no vertex")
            held = [(pin, frames[0].index(pin)) for pin in pins]
            for k, frame in enumerate(frames[1:] or frames):
                yield f"stage {number}, frame {k}: "
                here = self.whole(frame)
                need(all(frame[vertex] == pin for pin, vertex in held), "a vertex leaves its pin")
                self.leg(last, here, mesh)
                last, self.legs = here, self.legs + (len(frames) > 1)
            before = last, mesh

    def whole(self, points):
        """Points in space as whole numbers."""
        ratios = ([x.as_integer_ratio() for x in p] for p in points)
        return [(*(a << self.bits - b.bit_length() for a, b in p), *[0] * (3 - len(p))) for p in ratios]

    def change(self, old, mesh, new, next_mesh):
        """Check a change of stage: both polygons must reach the one of their common vertices without contact."""
        need(mesh.closed == next_mesh.closed, "the stage before has other components")
        pairs = zip(mesh.parts, next_mesh.parts, mesh.closed, strict=True)
        kept = [kept_vertices([old[k] for k in a], [new[k] for k in b], closed) for a, b, closed in pairs]
        for points, edges, side in ((old, mesh, 0), (new, next_mesh, 1)):
            moved = edges.straightened(points, [both[side] for both in kept], max(self.bits - 1075, 0))
            if moved != points:
                self.leg(points, moved, edges)

    def leg(self, start, end, mesh):
        """Raise if edges meet, or an edge an obstacle, while vertices go from start to end."""
        ways, edges = [*zip(start, end, strict=True)], mesh.edges
        around = boxes([(*ways[a], *ways[b]) for a, b in edges])
        pairs = ((edges[i], edges[j]) for i, j in overlapping(around, around))
        for first, second in chain(mesh.corners, (pair for pair in pairs if set(pair[0]).isdisjoint(pair[1]))):
            free = self.free(meet, [ways[k] for k in first], [ways[k] for k in second])
            need(free, f"the edges at vertices {first[0] + 1} and {second[0] + 1} (counted from 1) meet")
        for i, j in overlapping(around, self.around):
            still = [(corner, corner) for corner in self.triangles[j]]
            free = self.free(meet_triangle, [ways[k] for k in edges[i]], still)
            need(free, f"the edge at vertex {edges[i][0] + 1} (counted from 1) meets an obstacle")

    def free(self, decide, first, second):
        if apart(first, second):
            return True
        self.decisions += max(1, self.bits // 200) ** 2  # long numbers take longer
        need(self.decisions <= DECISIONS + PER_LEG * self.legs, "too many edges are too near to each other to decide")
        return not decide(*first, *second)


def rows(values, size):
    return [values[k : k + size] for k in range(0, len(values), size)] if size else []


def check(path):
    """Whether a file is accepted, and a sentence that says so."""
    place = ""
    try:
        made = Check(path)
        for place in made.run():  # noqa: B007 (reported if it is rejected)
            pass
    except DAMAGE as reason:
        return False, f"rejected: {place}{reason}"
    return True, f"accepted: no contact on {made.legs} legs; {made.decisions} pairs were decided by polynomials"


if __name__ == "__main__":
    verdicts = [(path, *check(path)) for path in sys.argv[1:]]
    print(*(f"{path}: {sentence}" for path, _, sentence in verdicts) if verdicts else __doc__, sep="\n")
    sys.exit(0 if verdicts and all(accepted for _, accepted, _ in verdicts) else 1)
