"""What `relax` can write, by suffix: curve files, and keyframed or rendered scenes where Blender's module is there."""

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from ..addon import export
from ..core import Iterate, MobiusFlowError, Result, write_curve
from ..core.curve.io import FORMATS
from .progress import show_frames

Writer = Callable[[str, Result, Sequence[Iterate], bool], None]


@dataclass(frozen=True)
class Output:
    """One kind of output: how it is written (and whether progress may be shown), and what it needs."""

    write: Writer
    needs_iterates: bool = False
    check: Callable[[], None] = lambda: None


def _write_curve(path: str, result: Result, iterates: Sequence[Iterate], shown: bool) -> None:
    write_curve(path, result.curve)


def _need_blender() -> None:
    export.require_blender()


def _blender_writer(function: str) -> Writer:
    def write(path: str, result: Result, iterates: Sequence[Iterate], shown: bool) -> None:
        getattr(export, function)(path, iterates)

    return write


def _write_movie(path: str, result: Result, iterates: Sequence[Iterate], shown: bool) -> None:
    try:
        export.write_movie(path, iterates, show_frames if shown else None)
    except KeyboardInterrupt:
        if shown:
            print(file=sys.stderr)  # the line with the progress has no end yet
        raise


OUTPUTS: Mapping[str, Output] = MappingProxyType(
    {suffix: Output(_write_curve) for suffix in FORMATS}
    | {
        ".blend": Output(_blender_writer("write_blend"), needs_iterates=True, check=_need_blender),
        ".mp4": Output(_write_movie, needs_iterates=True, check=_need_blender),
        ".png": Output(_blender_writer("write_still"), needs_iterates=True, check=_need_blender),
    }
)


def output_for(path: str) -> Output:
    """The kind of output a path asks for, after what can be checked before the work begins.

    Raises
    ------
    MobiusFlowError
        If the suffix is unknown, the directory does not exist, or Blender's module is needed and missing.
    """
    target = Path(path)
    if target.suffix.lower() not in OUTPUTS:
        raise MobiusFlowError(f"{path}: unknown suffix {target.suffix!r}; outputs end in {', '.join(OUTPUTS)}")
    check_place(path)
    output = OUTPUTS[target.suffix.lower()]
    output.check()
    return output


def check_place(path: str) -> None:
    """Raise a MobiusFlowError unless a file can be there, before hours of work are put into it."""
    target = Path(path)
    if not target.parent.is_dir():
        raise MobiusFlowError(f"{path}: the directory {target.parent} does not exist")
    if target.is_dir():
        raise MobiusFlowError(f"{path}: is a directory; name a file")
    if not os.access(target if target.exists() else target.parent, os.W_OK):
        raise MobiusFlowError(f"{path}: is write-protected")
