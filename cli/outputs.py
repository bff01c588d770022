"""What `relax` can write, by suffix: curve files, and keyframed or rendered scenes where Blender's module is there."""

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from ..addon.engine.playing import Playing, check_dimension
from ..addon.pictures import export
from ..core import Curve, Iterate, MobiusFlowError, Result
from ..core.curve import check_closed
from ..core.curve.io import FORMATS, WRITTEN_FORMATS, Format
from ..core.errors import OptionError, wrong_suffix
from . import curves
from .progress import show_frames

Writer = Callable[[str, Result, Sequence[Iterate], bool, Playing], object]


@dataclass(frozen=True)
class Output:
    """One kind of output."""

    write: Writer  # the last arguments are whether progress may be shown, and how a scene looks and is played
    admit: Callable[[Curve], object]  # raises a MobiusFlowError if it cannot hold a curve
    is_scene: bool = False  # which needs Blender's module, and shows the whole run
    is_played: bool = False  # as a motion


def _curve_output(form: Format, name: str | None = None) -> Output:
    return Output(lambda path, result, *_: curves.write(path, result.curve, name), form.text)


def _scene_output(write: Callable[[str, Sequence[Iterate], bool, Playing], object], is_played: bool) -> Output:
    def admit(curve: Curve) -> None:
        check_dimension(curve)
        check_closed(curve, "scenes, films and pictures")

    return Output(lambda path, _, iterates, *how: write(path, iterates, *how), admit, True, is_played)


def _write_movie(path: str, iterates: Sequence[Iterate], shown: bool, playing: Playing) -> None:
    try:
        export.write_movie(path, iterates, show_frames if shown else None, playing)
    except KeyboardInterrupt:
        if shown:
            print(file=sys.stderr)  # the line with the progress has no end yet
        raise


OUTPUTS: Mapping[str, Output] = MappingProxyType(
    {suffix: _curve_output(FORMATS[suffix]) for suffix in WRITTEN_FORMATS}
    | {
        ".blend": _scene_output(lambda path, iterates, _, playing: export.write_blend(path, iterates, playing), True),
        ".mp4": _scene_output(_write_movie, True),
        ".png": _scene_output(
            lambda path, iterates, _, playing: export.write_still(path, iterates, playing.look), False
        ),
    }
)


def output_for(path: str, name: str | None = None, look: str | None = None, played: bool = False) -> Output:
    """The kind of output that a path's suffix or ``--format`` asks for.

    Raises MobiusFlowError if the suffix is unknown and no format named, or Blender's module is needed and missing;
    OptionError if it has no look, or is not to be ``played``, there and back or with a tube as it is asked for.
    """
    suffix = Path(path).suffix.lower()
    if look is not None and not (suffix in OUTPUTS and OUTPUTS[suffix].is_scene):
        raise OptionError(f"--look is for {', '.join(name for name, each in OUTPUTS.items() if each.is_scene)}")
    if played and not (suffix in OUTPUTS and OUTPUTS[suffix].is_played):
        films = ", ".join(name for name, each in OUTPUTS.items() if each.is_played)
        raise OptionError(f"--loop and --constant-radius are for {films}")
    if suffix not in OUTPUTS:
        if name is None and path != curves.STREAM and suffix not in FORMATS:
            more = "; --trajectory writes motions" if suffix == ".npz" else curves.or_format(path)
            raise MobiusFlowError(f"{path}: {wrong_suffix(path, OUTPUTS, 'outputs')}{more}")
        return _curve_output(curves.format_for(path, name), name)
    if OUTPUTS[suffix].is_scene:
        export.require_blender()
    return OUTPUTS[suffix]


def admit(output: Output, path: str, curve: Curve) -> None:
    """Raise a MobiusFlowError that names the output if it cannot hold the curve."""
    try:
        output.admit(curve)
    except MobiusFlowError as error:
        raise MobiusFlowError(f"{path}: {error}") from error
