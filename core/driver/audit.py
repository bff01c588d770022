"""Audit trajectories of other programs: which chains passed through each other, and what became of knots and links."""

import signal
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import partial
from itertools import chain, pairwise
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..base import CurveError, FloatArray, IntArray, OptionError, real
from ..curve import Curve
from ..io.snapshots import Snapshot, snapshots
from ..knots import KnotType, knot_type
from ..proof.passings import PASSING, Passings, Placed, dual, passings


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
                raise OptionError(
                    f"{count} beads are not chains of {sizes} each; give numbers and sizes, such as 50x200"
                )
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
    chains, rings, seen = [], [], set[int]()
    for first in sorted(range(count), key=lambda k: len(joined[k])):  # ends of open chains, then rings
        if first not in seen:
            ahead, chain, rings = {first}, list[int](), [*rings, len(joined[first]) == 2]
            while ahead:
                chain.append(ahead.pop())
                seen.add(chain[-1])
                ahead = joined[chain[-1]] - seen
            chains.append(np.array(chain))
    return chains, rings


@dataclass(frozen=True)
class Meeting:
    """What happened between two chains, or to one, all in all."""

    chains: tuple[int, int]  #: the same one twice if it met itself
    image: tuple[int, int, int]  #: whole boxes by which the second is moved from where the first frame has it
    passings: int
    touches: int
    linking: int  #: by how much the linking number of the two changed, if they are rings
    before: KnotType | None  #: of the ring or the two in the first frame; None for open chains, or if not asked for
    after: KnotType | None  #: the same in the last frame


@dataclass
class Audit:
    """A report that grows with every leg, which is the straight motion from one frame to the next."""

    topology: Topology
    names: IntArray  #: numbers of the beads, as the file has them, or from 1 on
    first: Placed  #: the first frame, and the last that was reached
    last: Placed
    steps: list[int | None]  #: numbers that the file gives the frames
    found: list[Passings] = field(default_factory=list)  #: of each leg
    problem: str = ""  #: why the audit ended before the trajectory did

    @property
    def passings(self) -> Passings:
        """All contacts, by leg and time: an array with the fields of `mobius_flow.core.proof.passings.PASSING`.

        Edges are numbers in ``topology.tails``.
        """
        return np.concatenate([np.empty(0, dtype=PASSING), *self.found])

    def meetings(self, most: int = 100) -> Iterator[Meeting]:
        """Yield what happened between chains; the types of the first ``most`` rings, or pairs of rings, are identified.

        That takes a tenth of a second for each, or much longer where knots are complicated.
        """
        found = self.passings
        chains = self.topology.chain[self.topology.tails[found["edges"]]]
        own = chains[:, 0] == chains[:, 1]
        backwards = own & (np.sign(found["image"]) @ (9, 3, 1) < 0)  # as the first that is not zero
        image = np.where(backwards[:, None], -found["image"], found["image"])
        keys, which = np.unique(np.hstack([chains, image]), axis=0, return_inverse=True)
        for k, (a, b, *shift) in enumerate(keys.tolist()):
            signs = found["sign"][which.ravel() == k]
            parts = [(a, np.zeros(3))] if a == b and not any(shift) else [(a, np.zeros(3)), (b, np.array(shift))]
            crossed = int(np.count_nonzero(signs))
            before = after = None
            if crossed and most > 0:
                before, after = (self._type(frame, parts) for frame in (self.first, self.last))
                most -= before is not None
            linking = int(signs.sum()) if len(parts) == 2 and self.topology.closed[a] and self.topology.closed[b] else 0
            yield Meeting((a, b), tuple(shift), crossed, len(signs) - crossed, linking, before, after)

    def _type(self, frame: Placed, parts: Sequence[tuple[int, FloatArray]]) -> KnotType | None:
        """The type of rings moved by whole boxes; None if one is open, or goes round the box."""
        rings = []
        for number, shift in parts:
            a, b = self.topology.starts[number : number + 2]
            if not self.topology.closed[number] or (frame.lattice[a] != frame.lattice[b - 1]).any():
                return None
            rings.append(frame.places[a : b - 1] + shift @ frame.cell)
        return knot_type(Curve.from_components(rings))


def audit(
    trajectory: Path | str | Iterable[npt.ArrayLike],
    chains: int | Sequence[int] | None = None,
    *,
    closed: bool = True,
    box: npt.ArrayLike | None = None,
    processes: int = 1,
    callback: Callable[[Audit], None] | None = None,
) -> Audit:
    """Tell which chains of a trajectory passed through each other on straight ways from frame to frame.

    Parameters
    ----------
    trajectory
        A file with a suffix of `mobius_flow.core.io.snapshots.READERS`, or frames, arrays (n, 3).
    chains
        How many beads each chain has, in the order of the beads, or one number for all; by default as the file says.
    closed
        Whether chains are rings; bonds in a file tell for themselves.
    box
        The periodic box, by default the file's: three lengths, with tilts xy, xz, yz behind them if it has any, or its
        edges as rows, (3, 3); zeros where there is no other side.
    processes
        How many legs are looked at at the same time.  With several, scripts need ``if __name__ == "__main__":``.
    callback
        Called after every leg with the report so far.

    Raises
    ------
    CurveError, OptionError
        If not even the first leg can be looked at.  Whatever is wrong later ends the report, as its ``problem``.
    """
    for report in auditing(trajectory, chains, closed=closed, box=box, processes=processes):
        if callback is not None:
            callback(report)
    return report


def auditing(
    trajectory: Path | str | Iterable[npt.ArrayLike],
    chains: int | Sequence[int] | None = None,
    *,
    closed: bool = True,
    box: npt.ArrayLike | None = None,
    processes: int = 1,
) -> Iterator[Audit]:
    """Yield the report, which grows, after every leg; see `audit`."""
    cell = None if box is None else _cell(box)
    source, read = "", (Snapshot(real(each), np.zeros((3, 3))) for each in trajectory)
    if isinstance(trajectory, Path | str):
        source, read = f"{trajectory}: ", snapshots(trajectory)
    first = next(read, None)
    if first is None:
        raise CurveError(f"{source}there are no frames")
    topology = Topology.of(first, chains, closed)
    frames = _frames(chain([first], read), topology, cell, source)
    start = next(frames)
    names = np.arange(1, len(first.points) + 1) if first.names is None else first.names
    report = Audit(topology, names, start, start, [start.step])
    try:
        for leg, (result, end) in enumerate(_legs(chain([start], frames), topology, processes)):
            try:
                found = result()
            except CurveError as error:
                raise CurveError(f"{source}frame {leg + 1}: {error}") from error
            except BrokenProcessPool as error:
                raise CurveError(
                    f"{source}frame {leg + 1}: a process was killed; there may be too little memory"
                ) from error
            found["leg"] = leg
            report.found.append(found)
            report.steps.append(end.step)
            report.last = end
            yield report
    except CurveError as error:
        if not report.found:
            raise
        report.problem = str(error)
    if not report.found:
        raise CurveError(f"{source}there is only one frame, so nothing moves")


def _cell(box: npt.ArrayLike) -> FloatArray:
    """The edges of a box as rows: from their lengths, or from their lengths and tilts xy, xz, yz, or as they are."""
    try:
        given = real(box)
    except (TypeError, ValueError) as error:
        raise OptionError(f"box is no array of numbers: {error}") from error
    if given.shape == (3, 3):
        return given
    if given.shape not in ((3,), (6,)):
        raise OptionError(f"box has shape {given.shape}; give three lengths, or xy, xz and yz besides, or three rows")
    cell = np.diag(given[:3])
    if len(given) == 6:
        cell[1, 0], cell[2, 0], cell[2, 1] = given[3:]
    return cell


def _frames(read: Iterator[Snapshot], topology: Topology, cell: FloatArray | None, source: str) -> Iterator[Placed]:
    """Put chains together: neighbours where they are nearest, and each chain by its flags, or where it moves least.

    Raises CurveError for what is not finite, beads that come or go, and boxes too small to tell images apart.
    """
    beads, starts = topology.beads, topology.starts
    first: Snapshot | None = None
    last: Placed | None = None
    for number, each in enumerate(read):
        where = f"{source}frame {number}" + ("" if each.step is None else f" (step {each.step})")
        first = first or each
        if each.points.ndim != 2 or each.points.shape[1] != 3:
            raise CurveError(f"{where} has shape {each.points.shape}; frames must be arrays (n, 3)")
        if len(each.points) != len(first.points):
            told = f"{where} has {len(each.points)} beads and the first one {len(first.points)}; none may come or go"
            raise CurveError(told)
        if first.names is not None and each.names is not None and (lost := np.setdiff1d(first.names, each.names)).size:
            raise CurveError(f"{where} lacks bead {lost[0]}, which the first one has; none may come or go")
        points, sides = each.points[beads], each.cell if cell is None else cell
        wrong = np.flatnonzero(~np.isfinite(points).all(axis=1))
        if wrong.size:
            bead = beads[wrong[0]] + 1 if first.names is None else first.names[beads[wrong[0]]]
            raise CurveError(f"{where}: bead {bead} is not finite: {points[wrong[0]].tolist()}")
        if not np.isfinite(sides).all() or np.linalg.matrix_rank(sides) < np.count_nonzero(sides.any(axis=1)):
            raise CurveError(f"{where}: the box is flat, or not finite: {sides.tolist()}")

        to_boxes = dual(sides)
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


def _legs(
    frames: Iterator[Placed], topology: Topology, processes: int
) -> Iterator[tuple[Callable[[], Passings], Placed]]:
    """Yield of each leg, in order, what gives its contacts, and its end; a few are looked at in advance."""
    with ExitStack() as stack:
        submit = partial
        if processes > 1:
            quiet = signal.signal, (signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent
            pool = ProcessPoolExecutor(processes, get_context("spawn"), *quiet)
            stack.callback(pool.shutdown, wait=False, cancel_futures=True)

            def submit(*arguments):
                return pool.submit(*arguments).result

        waiting: deque[tuple[Callable[[], Passings], Placed]] = deque()
        failure: CurveError | None = None
        try:
            for number, (before, after) in enumerate(pairwise(frames)):
                waiting.append((submit(passings, before, after, topology.beads, topology.tails, number == 0), after))
                if len(waiting) > processes:
                    yield waiting.popleft()
        except CurveError as error:
            failure = error
        yield from waiting
        if failure is not None:
            raise failure
