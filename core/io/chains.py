"""Chains of beads in snapshots: which beads are joined, and where they are when no box cuts them apart."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from ..base import CurveError, FloatArray, IntArray, OptionError, real
from ..proof.passings import Placed, dual
from .snapshots import Snapshot


class Topology:
    """Which beads are joined: chains, open or closed, as one list of vertices in which rings end where they began."""

    def __init__(self, chains: Sequence[IntArray], closed: Sequence[bool]) -> None:
        enough = [k for k, (chain, ring) in enumerate(zip(chains, closed, strict=True)) if len(chain) >= 2 + ring]
        if not enough:
            raise OptionError("there are no chains: rings have three beads or more, open chains two")
        self.chains, self.closed = [chains[k] for k in enough], [closed[k] for k in enough]
        ways = [np.append(chain, chain[:ring]) for chain, ring in zip(self.chains, self.closed, strict=True)]
        self.beads = np.concatenate(ways)  # of each vertex
        self.starts = np.cumsum([0, *map(len, ways)])  # the first vertex of each chain, and the end
        self.chain = np.repeat(np.arange(len(ways)), np.diff(self.starts))  # of each vertex
        self.tails = np.setdiff1d(np.arange(len(self.beads)), self.starts[1:] - 1)  # of edges, which lead to the next

    @classmethod
    def of(cls, snapshot: Snapshot, sizes: int | Sequence[int] | None, closed: bool) -> "Topology":
        """Chains of so many beads, one after the other, or else by the file's bonds, or else by its molecules."""
        count = len(snapshot.points)
        if isinstance(sizes, int):
            if sizes < 1 or count % sizes:
                raise OptionError(f"{count} beads are not chains of {sizes} each; say how many there are: 50x200")
            sizes = [sizes] * (count // sizes)
        if sizes is not None:
            if min(sizes, default=0) < 1 or sum(sizes) > count:
                raise OptionError(f"chains of {sum(sizes)} beads do not fit {count} beads")
            return cls(np.split(np.arange(sum(sizes)), np.cumsum(sizes)[:-1]), [closed] * len(sizes))
        if snapshot.bonds is not None:
            return cls(*_along(snapshot.bonds, count))
        if snapshot.molecules is None:
            raise OptionError("the file does not say which beads are chains; say so, such as 50x200")
        order = np.argsort(snapshot.molecules, kind="stable")
        order = order[snapshot.molecules[order] > 0]
        chains = np.split(order, np.flatnonzero(np.diff(snapshot.molecules[order])) + 1)
        return cls(chains, [closed] * len(chains))


def _along(bonds: IntArray, count: int) -> tuple[list[IntArray], list[bool]]:
    """Chains of beads along bonds, and which of them are rings."""
    if bonds.min() < 0 or bonds.max() >= count:
        raise CurveError(f"there is a bond of bead {bonds.max() + 1}, and there are {count} beads")
    joined: list[set[int]] = [set() for _ in range(count)]
    for a, b in bonds.tolist():
        joined[a].add(b)
        joined[b].add(a)
    most = max(range(count), key=lambda k: len(joined[k]))
    if len(joined[most]) > 2:
        raise CurveError(f"bead {most + 1} has {len(joined[most])} bonds; only chains and rings can be audited")
    chains, rings, seen = list[IntArray](), list[bool](), set[int]()
    for first in sorted(range(count), key=lambda k: len(joined[k])):  # ends of open chains, then rings
        if first not in seen:
            ahead, chain = {first}, list[int]()
            while ahead:
                chain.append(ahead.pop())
                seen.add(chain[-1])
                ahead = joined[chain[-1]] - seen
            chains.append(np.array(chain))
            rings.append(len(joined[first]) == 2)
    return chains, rings


def given(frames: Iterable[npt.ArrayLike]) -> Iterator[Snapshot]:
    """Snapshots of arrays (n, 3); raises CurveError for what is none."""
    if not np.iterable(frames):  # an array without axes
        raise CurveError("the trajectory is no list of frames")
    for number, frame in enumerate(frames):
        try:
            points = real(frame)
        except (TypeError, ValueError, OverflowError) as error:
            raise CurveError(f"frame {number} is no array of numbers: {str(error).splitlines()[0]}") from error
        if points.ndim != 2 or points.shape[1] != 3:
            raise CurveError(f"frame {number} has shape {points.shape}; frames are arrays (n, 3)")
        yield Snapshot(points, np.zeros((3, 3)))


def cell_of(box: npt.ArrayLike) -> FloatArray:
    """The edges of a box as rows: as they are, or from lengths and, if it is tilted, xy, xz and yz."""
    try:
        edges = real(box)
    except (TypeError, ValueError, OverflowError) as error:
        raise OptionError(f"box is no array of numbers: {str(error).splitlines()[0]}") from error
    if edges.shape in ((3,), (6,)):
        x, y, z, xy, xz, yz = [*edges.tolist(), 0.0, 0.0, 0.0][:6]
        if min(x, y, z) < 0.0:
            raise OptionError(f"box has the lengths {x:g}, {y:g}, {z:g}; give lengths above 0, or 0 where it is open")
        return np.array([[x, 0.0, 0.0], [xy, y, 0.0], [xz, yz, z]])
    if edges.shape != (3, 3):
        raise OptionError(f"box has shape {edges.shape}; give three lengths, or six with xy, xz, yz, or three rows")
    return edges


def placed(read: Iterator[Snapshot], topology: Topology, cell: FloatArray | None, source: str) -> Iterator[Placed]:
    """Put chains together: neighbours where they are nearest, and each chain by its flags, or where it moves least.

    Raises CurveError for what is not finite, beads that come or go, and boxes too small to tell images apart.
    """
    beads, starts = topology.beads, topology.starts
    first: Snapshot | None = None
    last: Placed | None = None
    for number, each in enumerate(read):
        where = f"{source}frame {number}" + ("" if each.step is None else f" (step {each.step})")
        first = first or each
        if len(each.points) != len(first.points):
            told = f"{where} has {len(each.points)} beads and the first one {len(first.points)}; none may come or go"
            raise CurveError(told)
        if first.names is not None and each.names is not None and (lost := np.setdiff1d(first.names, each.names)).size:
            raise CurveError(f"{where} lacks bead {lost[0]}, which the first one has; none may come or go")
        points, sides = each.points[beads], each.cell if cell is None else cell
        wrong = np.flatnonzero(~(np.abs(points) < 1e60).all(axis=1))  # so that products of lengths are finite
        if wrong.size:
            bead = beads[wrong[0]] + 1 if first.names is None else first.names[beads[wrong[0]]]
            raise CurveError(f"{where}: bead {bead} is not finite, or too far away: {points[wrong[0]].tolist()}")
        if not np.ptp(points, axis=0).any():
            raise CurveError(f"{where}: all beads are in one place")
        if not (np.abs(sides) < 1e60).all() or np.linalg.matrix_rank(sides) < np.count_nonzero(sides.any(axis=1)):
            raise CurveError(f"{where}: the box is flat, or not finite: {sides.tolist()}")

        to_boxes = dual(sides)
        if np.abs(points @ to_boxes).max() > 1 << 31:
            raise CurveError(f"{where}: there are beads that are more than 2³¹ boxes away")
        bonds = np.diff(points, axis=0)
        bonds[starts[1:-1] - 1] = 0.0  # from chain to chain
        hops = np.round(bonds @ to_boxes).astype(np.intp)
        lattice = np.concatenate([np.zeros((1, 3), dtype=np.intp), -np.cumsum(hops, axis=0)])
        lattice -= lattice[starts[:-1]][topology.chain]
        width = 1.0 / np.linalg.norm(to_boxes, axis=0).max() if sides.any() else np.inf
        longest = np.linalg.norm(bonds - hops @ sides, axis=1)
        if longest.max() >= 0.5 * width:
            k = int(longest.argmax())
            told = f"neighbours on chain {topology.chain[k] + 1} are {longest[k]:.4g} apart, half the box or more"
            raise CurveError(f"{where}: {told}: are these the chains, and is this the box?")
        if each.images is not None:
            lattice += each.images[beads[starts[:-1]]][topology.chain]
        elif last is not None:
            moved = points - last.points + (lattice - last.lattice) @ sides
            means = np.add.reduceat(moved, starts[:-1]) / np.diff(starts)[:, None]
            lattice -= np.round(means @ to_boxes).astype(np.intp)[topology.chain]
        if last is not None:
            turns = [frame[starts[1:] - 1] - frame[starts[:-1]] for frame in (last.lattice, lattice)]
            if (changed := np.flatnonzero((turns[0] != turns[1]).any(axis=1))).size:
                told = f"chain {changed[0] + 1} goes round the box otherwise than in the frame before"
                raise CurveError(f"{where}: {told}; bonds are too long, or frames too far apart")
        last = Placed(points, lattice, sides, each.step)
        yield last
