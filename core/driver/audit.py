"""Audit trajectories of other programs: which chains passed through each other, and what became of knots and links."""

import signal
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass, field
from functools import partial
from itertools import chain, pairwise
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..base import CurveError, FloatArray, IntArray, OptionError, checked, counted, shown
from ..curve import Curve
from ..io.chains import Topology, cell_of, given, placed
from ..io.snapshots import snapshots
from ..knots import KnotType, knot_type
from ..proof.passings import PASSING, Passings, Placed, passings


@dataclass(frozen=True)
class Meeting:
    """What happened between two chains, or to one, all in all."""

    chains: tuple[int, int]  #: numbers from 0, the same one twice if it met itself
    image: tuple[int, int, int]  #: whole boxes by which the second is moved, seen from where the first frame has both
    passings: int
    touches: int
    linking: int  #: by how much passings changed the linking number of two rings
    before: KnotType | None  #: of the ring, or the two, in the first frame; None for open chains, or if not asked for
    after: KnotType | None  #: the same in the last frame


@dataclass
class Audit:
    """A report that grows with every leg, the straight motion from a frame to the next."""

    topology: Topology
    names: IntArray  #: the file's numbers of the beads, or those from 1 on
    first: Placed  #: the first frame, and the last one that was reached
    last: Placed
    steps: list[int | None]  #: the file's numbers of the frames
    found: list[Passings] = field(default_factory=list)  #: of each leg
    problem: str = ""  #: why the audit ended before the trajectory did

    def __repr__(self) -> str:
        chains = counted(len(self.topology.chains), "chain")
        return f"<Audit: {counted(len(self.found), 'leg')}, {chains}, {counted(len(self.passings), 'contact')}>"

    @property
    def passings(self) -> Passings:
        """All contacts, by leg and time, as an array with the fields of `mobius_flow.core.proof.passings.PASSING`.

        Its edges are indices of ``topology.tails``.
        """
        return np.concatenate([np.empty(0, dtype=PASSING), *self.found])

    def meetings(self, most: int = 100) -> Iterator[Meeting]:
        """Yield what happened between chains; the types of at most so many rings and pairs of rings are identified."""
        found = self.passings
        chains = self.topology.chain[self.topology.tails[found["edges"]]]
        # a chain and its image are the same as the chain and the image on the other side
        backwards = (chains[:, 0] == chains[:, 1]) & (np.sign(found["image"]) @ (9, 3, 1) < 0)
        image = np.where(backwards[:, None], -found["image"], found["image"])
        keys, which = np.unique(np.hstack([chains, image]), axis=0, return_inverse=True)
        order = np.argsort(which.ravel(), kind="stable")
        groups = np.split(found["sign"][order], np.cumsum(np.bincount(which.ravel(), minlength=len(keys)))[:-1])
        for (a, b, *shift), signs in zip(keys.tolist(), groups, strict=False):  # of no keys there is one group
            alone, crossed = a == b and not any(shift), int(np.count_nonzero(signs))
            before = after = None
            if most > 0:
                parts = [(a, np.zeros(3)), (b, np.array(shift))][: 1 if alone else 2]
                before, after = (self._type(frame, parts) for frame in (self.first, self.last))
                most -= before is not None
            linked = not alone and self.topology.closed[a] and self.topology.closed[b]
            x, y, z = shift
            linking = int(signs.sum()) if linked else 0
            yield Meeting((a, b), (x, y, z), crossed, len(signs) - crossed, linking, before, after)

    def _type(self, frame: Placed, parts: Sequence[tuple[int, FloatArray]]) -> KnotType | None:
        """The type of rings moved by whole boxes; None if one is open, goes round the box, or they touch."""
        rings = []
        for number, shift in parts:
            first, last = self.topology.starts[number], self.topology.starts[number + 1] - 1
            if not self.topology.closed[number] or (frame.lattice[first] != frame.lattice[last]).any():
                return None
            rings.append(frame.places[first:last] + shift @ frame.cell)
        with suppress(CurveError):
            return knot_type(Curve.from_components(rings))
        return None


@checked
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
    from concurrent.futures.process import BrokenProcessPool  # which takes a while to import

    if not 1 <= processes <= 1000:
        raise OptionError(f"processes is {shown(processes)}; it must be from 1 to 1000")
    cell = None if box is None else cell_of(box)
    if isinstance(trajectory, Path | str):
        source, read = f"{trajectory}: ", snapshots(trajectory)
    else:
        source, read = "", given(trajectory)
    first = next(read, None)
    if first is None:
        raise CurveError(f"{source}there are no frames")
    topology = Topology.of(first, chains, closed)
    frames = placed(chain([first], read), topology, cell, source)
    start = next(frames)
    names = np.arange(1, len(first.points) + 1) if first.names is None else first.names
    report = Audit(topology, names, start, start, [start.step])
    try:
        with closing(_legs(chain([start], frames), topology, processes)) as legs:
            for leg, (result, end) in enumerate(legs):
                try:
                    found = result()
                except (CurveError, BrokenProcessPool) as error:
                    told = (
                        error if isinstance(error, CurveError) else "a process was killed, perhaps for want of memory"
                    )
                    raise CurveError(f"{source}frame {leg + 1}: {told}") from error
                found["leg"] = leg
                report.found.append(found)
                report.steps.append(end.step)
                report.last = end
                if callback is not None:
                    callback(report)
    except CurveError as error:
        if not report.found:
            raise
        report.problem = str(error)
    if not report.found:
        raise CurveError(f"{source}there is one frame only, and nothing moves")
    return report


def _legs(
    frames: Iterator[Placed], topology: Topology, processes: int
) -> Generator[tuple[Callable[[], Passings], Placed], None, None]:
    """Yield of each leg, in order, what gives its contacts, and its end; several are worked at in advance."""
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    few = 2_000  # edges whose legs take less time than starting processes does
    pool: ProcessPoolExecutor | None = None
    if processes > 1 and len(topology.tails) > few:
        quiet = signal.signal, (signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent
        pool = ProcessPoolExecutor(processes, get_context("spawn"), *quiet)
    waiting: deque[tuple[Callable[[], Passings], Placed]] = deque()
    failure: CurveError | None = None
    try:
        try:
            for number, (before, after) in enumerate(pairwise(frames)):
                work = partial(passings, before, after, topology.beads, topology.tails, number == 0)
                waiting.append((work if pool is None else pool.submit(work).result, after))
                if len(waiting) > processes:
                    yield waiting.popleft()
        except CurveError as error:  # which comes when its turn has come
            failure = error
        yield from waiting
        if failure is not None:
            raise failure
    finally:
        if pool is not None:
            workers = list(pool._processes.values())  # which `terminate_workers` of Python 3.14 ends, too
            pool.shutdown(wait=False, cancel_futures=True)
            for each in workers:
                each.terminate()
