"""Find where edges of chains pass through each other between two frames that others recorded, in boxes or without."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, product
from operator import add
from random import Random

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from ..base import CurveError, FloatArray, IntArray
from ..base.tolerances import SIEVE_ROUNDING, SIEVE_UNDERFLOW
from .checker import START, Time, between, contacts, whole
from .planes import doubtful

PASSING = np.dtype(
    [("leg", "i8"), ("edges", "i8", 2), ("image", "i8", 3), ("time", "f8"), ("sign", "i8"), ("place", "f8", 3)]
)
"""Two edges, by their numbers, and whole boxes by which the second is moved; when, which way and where they meet.

The sign is that of `checker.contacts`, 0 if they only touch: linking numbers change by it.  What passes through a bead,
or at the time of a frame, is decided as if each bead were displaced by less than 1e-60 of its own.
"""
Passings = npt.NDArray[np.void]


@dataclass(frozen=True, eq=False)
class Placed:
    """The vertices of chains in a frame: vertex k is at ``points[k] + lattice[k] @ cell``, without rounding."""

    points: FloatArray  # (v, 3)
    lattice: IntArray  # whole boxes, (v, 3)
    cell: FloatArray  # the edges of the box as rows, zero where there is no other side; (3, 3)
    step: int | None = None  # the number that the other program gives the frame

    @property
    def places(self) -> FloatArray:
        """Where the vertices are, rounded; shape (v, 3)."""
        return np.asarray(self.points + self.lattice @ self.cell)


def dual(cell: FloatArray) -> FloatArray:
    """A matrix whose columns give coordinates in units of a box's edges, and 0 where it has none; shape (3, 3)."""
    return np.asarray(np.linalg.pinv(cell) * cell.any(axis=1))


def passings(before: Placed, after: Placed, beads: IntArray, tails: IntArray, from_start: bool = True) -> Passings:
    """Find all contacts of edges while their ends, and the box, go straight from one frame to the next; by time.

    Edge number k leads from vertex ``tails[k]`` to the next one.  Vertices of one number in ``beads``, (v,), are one
    and the same but for whole boxes, such as the first and the last of a ring: edges that share one are left out.
    Edges that pass through each other several times are told each time, those that only touch once.  What happens at
    the very start belongs to the motion before, unless ``from_start``.

    Raises CurveError if the box changes, or is crossed, by too much for images to be told apart.
    """
    # arrays of times, ends, edges and axes; edges are moved by whole boxes to where their middles are in the first
    corners, cells = np.stack([tails, tails + 1]), np.stack([before.cell, after.cell])
    points = np.stack([frame.points[corners] for frame in (before, after)])
    lattice = np.stack([frame.lattice[corners] for frame in (before, after)])
    middle = (points + np.einsum("tcea,tam->tcem", lattice, cells)).mean(axis=(0, 1))
    home = -np.floor(middle @ dual(cells.mean(axis=0))).astype(np.intp)
    lattice += home
    ends = points + np.einsum("tcea,tam->tcem", lattice, cells)
    exponent = -int(np.frexp(np.abs(ends).max())[1])  # coordinates are at most 1 in size, and images' somewhat more
    ends, number, image = _with_images(np.ldexp(ends, exponent), np.ldexp(cells, exponent))
    size = np.abs(points).max() + (np.abs(lattice).max() + 3) * np.abs(cells).sum()
    clearance = float(np.ldexp(size, exponent - 50)) if cells.any() else 0.0  # bounds what was rounded

    found = []
    bead, box = beads[corners], lattice[0]
    for i, j in _near(ends, clearance):
        keep = (i < len(tails)) & (number[i] != number[j])  # pairs of images are the same as others
        i, j = i[keep], j[keep]
        # a plane at rest, across the line between their middles, surely separates most moving edges
        x, y = ends.take(i, axis=2), ends.take(j, axis=2)
        between_ends = (x[:, 0] + x[:, 1]) - (y[:, 0] + y[:, 1])
        normal = between_ends.sum(axis=0)
        room = np.einsum("tpm,pm->tp", between_ends, normal)
        for edge in (x, y):
            room -= np.abs(np.einsum("tpm,pm->tp", edge[:, 1] - edge[:, 0], normal))
        margin = (8.0 * clearance + 4.0 * SIEVE_ROUNDING) * np.abs(normal).sum(axis=1) + SIEVE_UNDERFLOW
        near = ~(room > margin).all(axis=0)
        i, j = i[near], j[near]
        for p, q in product((0, 1), repeat=2):  # ends that are no common one
            keep = (bead[p, i] != bead[q, number[j]]) | (box[p, i] != box[q, number[j]] + image[j]).any(axis=1)
            i, j = i[keep], j[keep]
        start, end = np.concatenate([ends[:, :, i], ends[:, :, j]], axis=1).reshape(2, -1, 3)
        left = doubtful(start, end, np.arange(4 * len(i)).reshape(4, -1), clearance)[0]
        for a, b, shift in zip(i[left].tolist(), number[j[left]].tolist(), image[j[left]], strict=True):
            boxes = np.stack([lattice[:, :, a], lattice[:, :, b] + shift], axis=1)  # of times, edges, ends and axes
            places = np.stack([points[:, :, a], points[:, :, b]], axis=1)
            moved = home[b] + shift - home[a]
            if a > b:  # volumes keep their signs
                a, b, moved, boxes, places = b, a, -moved, boxes[:, ::-1], places[:, ::-1]
            four = [*bead[:, a].tolist(), *bead[:, b].tolist()]
            boxes = boxes - boxes[0, 0, 0]  # the first end is where it was recorded
            seen = places + np.einsum("tkca,tam->tkcm", boxes, cells)
            for time, sign in _contacts(places, boxes, cells, four, from_start):
                # a point of one edge that the other has too, or the middle of what they share if they are parallel
                x, y = (1.0 - time) * seen[0] + time * seen[1]
                e, f, d = x[1] - x[0], y[1] - y[0], x[0] - y[0]
                normal, part = np.cross(e, f), np.clip((y - x[0]) @ e / max(float(e @ e), 1e-300), 0.0, 1.0).mean()
                if normal @ normal > 1e-20 * (e @ e) * (f @ f):
                    part = np.cross(f, d) @ normal / (normal @ normal)
                where = x[0] + min(max(float(part), 0.0), 1.0) * e
                found.append((0, (a, b), tuple(moved), time, sign, tuple(where)))
    result = np.array(found, dtype=PASSING)
    return result[np.argsort(result["time"], kind="stable")]


def _with_images(ends: FloatArray, cells: FloatArray) -> tuple[FloatArray, IntArray, IntArray]:
    """Edges, and images of them that may meet others: their ends, numbers, and boxes by which they are moved.

    Of two edges one image of one suffices for each way in which they may meet: that which is moved forwards.
    """
    to_boxes, count = dual(cells.mean(axis=0)), ends.shape[2]
    reach = 2.0 * np.abs((ends - ends.mean(axis=(0, 1))) @ to_boxes).max(axis=(0, 1, 2))
    strain = float(np.abs((cells[1] - cells[0]) @ to_boxes).sum(axis=0).max())
    most = np.floor(cells.any(axis=(0, 2)) * (1.0 + reach + 2.0 * strain * (1.0 + reach.max()))).astype(int)
    if strain > 0.5 or most.max() > 3:
        raise CurveError("the box changes by half its size, or edges move further than through a whole one")
    low, high = ends.min(axis=1), ends.max(axis=1)
    least, largest = low.min(axis=(0, 1)) - 1e-9, high.max(axis=(0, 1)) + 1e-9
    every, number, image = [ends], [np.arange(count)], [np.zeros((count, 3), dtype=np.intp)]
    for shift in product(*(range(-k, k + 1) for k in most)):
        if shift > (0, 0, 0):
            by = (shift @ cells)[:, None]
            near = ((low + by).min(axis=0) <= largest) & ((high + by).max(axis=0) >= least)
            number.append(np.flatnonzero(near.all(axis=1)))
            every.append(ends[:, :, number[-1]] + by[:, None])
            image.append(np.broadcast_to(shift, (len(number[-1]), 3)))
    return np.concatenate(every, axis=2), np.concatenate(number), np.concatenate(image)


def _near(ends: FloatArray, clearance: float) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield pairs i < j of moving edges that are not in balls apart from each other, in batches."""
    centre, at_once = ends.mean(axis=(0, 1)), 1 << 14
    squares = np.einsum("tcem,tcem->tce", ends - centre, ends - centre).max(axis=(0, 1))
    radius = np.sqrt(squares) * (1.0 + 2.0**-40) + (4.0 * clearance + 2.0**-48)
    order = np.argsort(-radius, kind="stable")
    centre, radius, first, total = centre[order], radius[order], 0, 0
    while first < len(order):  # a class of edges of about the same size, with all that are smaller
        last = int(np.searchsorted(-radius, -radius[first] / 1.4, side="right"))
        rest, width = cKDTree(centre[first:]), 2.0 * radius[first]
        some = cKDTree(centre[first:last:16])
        count = 16 * int(some.count_neighbors(rest, width))
        total += count
        if total > max(1000 * len(order), 1 << 24):  # it would take minutes or hours
            raise CurveError("edges come near too many others; frames are too far apart, or beads too near together")
        parts = 1 + count // (1 << 21)  # which bounds the memory
        for part in np.array_split(np.arange(first, last), parts):
            found = cKDTree(centre[part]).sparse_distance_matrix(rest, width, output_type="ndarray")
            i, j = part[found["i"]], first + found["j"]
            keep = (i < j) & (found["v"] <= radius[i] + radius[j])
            i, j = order[i[keep]], order[j[keep]]
            for k in range(0, len(i), at_once):
                pair = i[k : k + at_once], j[k : k + at_once]
                yield np.minimum(*pair), np.maximum(*pair)
        first = last


def _contacts(
    points: FloatArray, boxes: IntArray, cells: FloatArray, beads: Sequence[int], from_start: bool
) -> list[tuple[float, int]]:
    """When two edges meet and which way they pass through each other, decided exactly; of mere touches the first.

    Ends are ``points`` moved by whole boxes, both of shape (2, 2, 2, 3): times, edges, ends and axes.
    """
    exact = [
        tuple(
            sum((n * Fraction(h) for n, h in zip(box, column, strict=True) if n), Fraction(x))
            for x, column in zip(point, cell, strict=True)
        )
        for each, moved, cell in zip(points.tolist(), boxes.tolist(), cells.transpose(0, 2, 1).tolist(), strict=True)
        for point, box in zip(chain(*each), chain(*moved), strict=True)
    ]
    ends = whole(exact)
    met = list(contacts(*zip(ends[:4], ends[4:], strict=True)))
    found = [(_moment(time), way) for time, way in met if way]
    if len(found) < len(met):
        # one edge of all that meet in a bead has what passes through it once beads are anywhere else, at all times
        rngs = [Random(bead) for bead in beads]
        off = [[Fraction(rng.getrandbits(64), 1 << 264) for _ in range(3)] for rng in rngs]
        ends = whole([tuple(map(add, point, by)) for point, by in zip(exact, [*off, *off], strict=True)])
        through = sum(way for _, way in contacts(*zip(ends[:4], ends[4:], strict=True))) - sum(way for _, way in found)
        touches = sorted(_moment(time) for time, way in met if not way and (from_start or through or time != START))
        found += [(time, through) for time in touches[:1] if through or not found]
    return found


def _moment(time: Time) -> float:
    """An isolated root as a number, rounded."""
    p, i, j, m = time
    if i == j:
        return i / m
    p = between(p, i, j, m)  # which changes its sign once
    rising, low, high = next(c > 0 for c in p[::-1] if c), 0.0, 1.0
    q = [c / max(map(abs, p)) for c in p]
    for _ in range(60):
        middle = 0.5 * (low + high)
        value = sum(c * (1.0 - middle) ** (len(q) - 1 - k) * middle**k for k, c in enumerate(q))
        low, high = (low, middle) if (value > 0) == rising else (middle, high)
    return (i + 0.5 * (low + high) * (j - i)) / m
