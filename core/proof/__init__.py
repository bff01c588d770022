"""Check trajectory files independently of the program that wrote them.

`checker` decides, exactly; it is a single file that also runs alone. `filter` spares it most pairs of edges.
"""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from ..base import FloatArray, checked
from .checker import Archive, Verdict, check
from .filter import FloatingSieve

__all__ = ["Verdict", "verify"]


@checked
def verify(path: str | os.PathLike[str], callback: Callable[[int, int], None] | None = None) -> Verdict:
    """Check a trajectory file; damaged files and failed checks give a verdict that is not accepted.

    ``callback`` is called after every leg with the number of legs checked and, by its headers, of those in the file.
    """
    return check(path, FloatingSieve, callback)


def stages(path: Path | str) -> Iterator[tuple[list[int], list[bool], Iterator[FloatArray]]]:
    """Yield of each stage the sizes of components, which are closed, and the frames, (n, m), read before the next.

    Raises a TrajectoryError if the file is damaged.
    """
    with Archive(path) as archive:
        for name in archive.numbered("stage", ""):
            sizes, closed = archive.components(name)
            yield sizes, closed, (np.array(frame) for frame in archive.frames(name, sum(sizes)))
