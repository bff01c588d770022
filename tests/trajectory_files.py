"""Trajectory files made by hand, and what is found out about them."""

import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from mobius_flow.core import Obstacle
from mobius_flow.core.proof import Verdict, verify

Arrays = dict[str, Any]
Frames = Sequence[np.ndarray]
Stage = tuple[Sequence[int], Frames] | Frames  # frames, and the components' sizes if there are several


def trajectory(*stages: Stage, obstacles: Sequence[Obstacle] = (), opened: bool = False, **more: Any) -> Arrays:
    """The arrays of a file; ``opened`` says that all components are open, ``more`` are further arrays."""
    arrays: Arrays = {}
    for k, stage in enumerate(stages):
        sizes, frames = stage if isinstance(stage, tuple) else ([len(stage[0])], stage)
        arrays |= {f"stage_{k:03d}": np.stack(list(frames)), f"component_sizes_{k:03d}": np.array(sizes)}
        if opened:
            arrays[f"component_closed_{k:03d}"] = np.zeros(len(sizes), dtype=bool)
    for k, obstacle in enumerate(obstacles):
        arrays |= {f"obstacle_{k:03d}_vertices": obstacle.vertices, f"obstacle_{k:03d}_faces": obstacle.faces}
    return arrays | more


def checked(path: Path, arrays: Arrays, save: Callable[..., None] = np.savez) -> Verdict:
    """The verdict on a file with these arrays, which is written into a folder."""
    save(path / "T.npz", **arrays)
    return verify(path / "T.npz")


def archive(path: Path, members: dict[str, bytes], method: int = zipfile.ZIP_STORED) -> Path:
    """A file of any bytes."""
    with zipfile.ZipFile(path, "w", method) as file:
        for name, data in members.items():
            file.writestr(name, data)
    return path
