"""``mobius-flow view``: a curve or a trajectory as a page to look at, a solid to print, or a surface that moves."""

import argparse
from pathlib import Path

from ..core import MobiusFlowError
from ..core.base import write_file
from ..core.keys.solids import animation, solid
from ..core.keys.view import FRAMES, motion, page, still
from . import curves
from .places import VIEWED, check_places, suffix_of
from .terminal import say_written

_EPILOG = """\
examples:
  mobius-flow view knot.txt knot.html
  mobius-flow view path.npz motion.html
  mobius-flow view relaxed.obj print.3mf --width 3
  mobius-flow view path.npz motion.glb

An .html page holds all that it needs and works offline; trajectories have a slider and their energy beside it. Solids
(.stl, .3mf) are refused where a wire of that width would run into itself; of a trajectory they show the last frame. In
.glb files (glTF) the frames are morph targets, with an animation that plays them.

exit status: 0, or 2 on bad input or bad options, or where OUT cannot be written
"""


def add_view(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Show a curve or a trajectory, or make a solid of it.", _EPILOG
    curves.add_input(parser, "curve, or trajectory (.npz)")
    parser.add_argument("output", metavar="OUT", help=f"what to write, by suffix: {', '.join(VIEWED)}")
    text = "width of the tubes, in the curve's units (default: what is well seen; for solids nine tenths of the widest)"
    parser.add_argument("--width", type=float, metavar="W", help=text)
    text = f"frames of a trajectory that are shown, about as far apart, 2 to 1000 (default: {FRAMES})"
    parser.add_argument("--frames", type=int, default=FRAMES, metavar="N", help=text)
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    suffix = suffix_of(options.output, VIEWED, "pictures")
    if not 2 <= options.frames <= 1000:
        raise MobiusFlowError(f"frames is {options.frames}; give 2 to 1000")
    if options.width is not None and not 0.0 < options.width < float("inf"):
        raise MobiusFlowError(f"width is {options.width:g}; give a positive number")
    check_places({"IN": options.input}, {"OUT": options.output})
    if Path(options.input).suffix.lower() == ".npz":
        shown = motion(options.input, options.frames)
    else:
        with curves.measured(options.input, options.format) as curve:
            shown = still(curve)
    radius = options.width and 0.5 * options.width
    if suffix == ".html":
        made = page(shown, radius, Path(options.input).stem).encode()
    elif suffix == ".glb":
        made = animation(shown, radius)
    else:
        made = solid(shown.curves[-1], suffix[1:], options.width)
    write_file(options.output, made)
    say_written(options.output)
    return 0
