"""What `relax` can write, by suffix: curve files, and keyframed or rendered scenes where Blender's module is there."""

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from ..addon.pictures import export, film
from ..core import Curve, Iterate, MobiusFlowError, Result
from ..core.curve import check_closed
from ..core.curve.io import FORMATS, WRITTEN_FORMATS, Format
from ..core.errors import wrong_suffix
from . import curves
from .progress import show_frames

Writer = Callable[[str, Result, Sequence[Iterate], bool], None]


@dataclass(frozen=True)
class Output:
    """One kind of output.

    Parameters
    ----------
    write
        Writes it; the last argument is whether progress may be shown.
    admit
        Raises a MobiusFlowError if it cannot hold a curve.
    needs_iterates
        Whether it shows the whole run.
    check
        Raises a MobiusFlowError if something it needs is not installed.
    """

    write: Writer
    admit: Callable[[Curve], None]
    needs_iterates: bool = False
    check: Callable[[], None] = lambda: None


def _curve_output(name: str | None, form: Format) -> Output:
    def write(path: str, result: Result, _iterates: Sequence[Iterate], _shown: bool) -> None:
        curves.write(path, result.curve, name)

    def admit(curve: Curve) -> None:
        form.text(curve)

    return Output(write, admit)


def _blender_output(write: Writer) -> Output:
    # the function is looked up when it is called, as all of export's
    return Output(write, _admit_to_blender, needs_iterates=True, check=lambda: export.require_blender())


def _admit_to_blender(curve: Curve) -> None:
    film.check_dimension(curve)
    check_closed(curve, "scenes, films and pictures")


def _blender_writer(function: str) -> Writer:
    def write(path: str, _result: Result, iterates: Sequence[Iterate], _shown: bool) -> None:
        getattr(export, function)(path, iterates)

    return write


def _write_movie(path: str, _result: Result, iterates: Sequence[Iterate], shown: bool) -> None:
    try:
        export.write_movie(path, iterates, show_frames if shown else None)
    except KeyboardInterrupt:
        if shown:
            print(file=sys.stderr)  # the line with the progress has no end yet
        raise


OUTPUTS: Mapping[str, Output] = MappingProxyType(
    {suffix: _curve_output(None, FORMATS[suffix]) for suffix in WRITTEN_FORMATS}
    | {
        ".blend": _blender_output(_blender_writer("write_blend")),
        ".mp4": _blender_output(_write_movie),
        ".png": _blender_output(_blender_writer("write_still")),
    }
)


def output_for(path: str, name: str | None = None) -> Output:
    """The kind of output that a path's suffix or ``--format`` asks for, if what it needs is installed.

    Raises
    ------
    MobiusFlowError
        If the suffix is unknown and no format named, or Blender's module is needed and missing.
    """
    suffix = Path(path).suffix
    if suffix.lower() not in OUTPUTS:
        if name is None and path != curves.STREAM and suffix.lower() not in FORMATS:
            raise MobiusFlowError(f"{path}: {wrong_suffix(path, OUTPUTS, 'outputs')}{curves.unless_told(path)}")
        return _curve_output(name, curves.format_for(path, name))
    output = OUTPUTS[suffix.lower()]
    output.check()
    return output


def admit(output: Output, path: str, curve: Curve) -> None:
    """Raise a MobiusFlowError that names the output if it cannot hold the curve."""
    try:
        output.admit(curve)
    except MobiusFlowError as error:
        raise MobiusFlowError(f"{path}: {error}") from error
