"""``mobius-flow view`` and ``draw``: curves and their motions to look at, solids to print, and diagrams for papers."""

import argparse
import os
from dataclasses import replace
from pathlib import Path

from ..core.base import CurveError, MobiusFlowError, OptionError, write_file
from ..core.io import FORMATS
from ..core.io.codes import code_diagram
from ..core.io.source import Source
from ..core.keys.arcs import seen
from ..core.keys.figure import Pen, figure
from ..core.keys.paper import PAPERS
from ..core.keys.solids import animation, solid
from ..core.keys.view import FRAMES, motion, page, still
from ..core.knots import knot, knot_type
from ..core.knots.drawings import Drawing
from ..core.knots.layout import laid_out
from ..core.knots.names import named_diagram, table_range
from . import curves
from .options import add_all, from_arguments
from .places import VIEWED, check_places, suffix_of
from .terminal import say_written

_CODES = {".pd": "pd", ".dt": "dt", ".gauss": "gauss"}
_EPILOG_OF_DRAW = """\
examples:
  mobius-flow draw 8_18 knot.svg
  mobius-flow draw knot.txt knot.pdf --arrows --numbers
  mobius-flow draw L6a4 "DT: [4 6 2]" "braid(1,-2,1,-2)" row.tex --columns 3
  mobius-flow draw 3_1..10_165 poster.pdf --columns 18
  mobius-flow draw path.npz film.svg --frames 8 --colours along

Curves are seen from where the fewest strands cross, and of such views from where they are best apart; names and codes,
and with --layout the simplified diagrams of curves, are laid out anew, with even and smooth strands. Strands become
thinner where they would come too near to each other. Figures in TikZ are for \\input in a document that uses tikz.

exit status: 0, or 2 on bad input or bad options, or where OUT cannot be written
"""
_EPILOG_OF_VIEW = """\
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
    parser.description, parser.epilog = "Show a curve or a trajectory, or make a solid of it.", _EPILOG_OF_VIEW
    curves.add_input(parser, "curve, or trajectory (.npz)")
    parser.add_argument("output", metavar="OUT", help=f"what to write, by suffix: {', '.join(VIEWED)}")
    text = "width of the tubes (default: that of the rope, or what is well seen; for solids nine tenths of the widest)"
    parser.add_argument("--width", type=float, metavar="W", help=text)
    text = f"frames of a trajectory that are shown, about as far apart, 2 to 1000 (default: {FRAMES})"
    parser.add_argument("--frames", type=int, default=FRAMES, metavar="N", help=text)
    parser.set_defaults(run=_view)


def _view(options: argparse.Namespace) -> int:
    suffix = suffix_of(options.output, VIEWED, "pictures")
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
        made = solid(shown.curves[-1], suffix[1:], options.width, shown.rope)
    write_file(options.output, made)
    say_written(options.output)
    return 0


def add_draw(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Draw diagrams of curves, trajectories, codes and named knots.", _EPILOG_OF_DRAW
    text = (
        f"curve ({', '.join(FORMATS)}, or - for standard input), trajectory (.npz), code, name, or range of the table"
    )
    parser.add_argument("inputs", metavar="IN", nargs="+", help=text)
    parser.add_argument("output", metavar="OUT", help=f"what to write, by suffix: {', '.join(PAPERS)}")
    curves.add_format(parser)
    text = "lay out the simplified diagrams of curves (default: draw a view)"
    parser.add_argument("--layout", action="store_true", help=text)
    text = "frames of a trajectory, about as far apart, 2 to 1000 (default: 6)"
    parser.add_argument("--frames", type=int, default=6, metavar="N", help=text)
    add_all(parser, Pen)
    text = "captions, between commas, or none (default: names, or numbers of frames, if there are several)"
    parser.add_argument("--labels", metavar="A,B,…", help=text)
    parser.set_defaults(run=_draw)


def _draw(options: argparse.Namespace) -> int:
    suffix = suffix_of(options.output, PAPERS, "drawings")
    pen = from_arguments(options, Pen)
    check_places({path: path for path in options.inputs if os.path.exists(path)}, {"OUT": options.output})
    drawings: list[Drawing] = []
    captions: list[str] = []
    for word in options.inputs:
        here, names = _drawn(word, options)
        drawings += here
        captions += names
    is_film = len(options.inputs) == 1 and options.inputs[0].lower().endswith(".npz")
    if options.labels is not None:
        captions = [""] * len(drawings) if options.labels == "none" else options.labels.split(",")
        if len(captions) != len(drawings):
            raise OptionError(f"--labels has {len(captions)} captions for {len(drawings)} drawings; give as many")
    elif len(drawings) == 1:
        captions = [""]
    if is_film and pen.columns is None:
        pen = replace(pen, columns=len(drawings))
    write_file(options.output, PAPERS[suffix](figure(drawings, captions, pen)))
    say_written(options.output)
    return 0


def _drawn(word: str, options: argparse.Namespace) -> tuple[list[Drawing], list[str]]:
    """The drawings of an input, and their captions."""
    suffix, stem = Path(word).suffix.lower(), Path(word).stem
    is_file = word == curves.STREAM or suffix in FORMATS or os.path.isfile(word)
    if suffix == ".npz":
        if options.layout:
            raise OptionError(f"{word}: --layout is for curves, and frames of a trajectory are views; leave it out")
        found = seen(motion(word, options.frames).curves)
        return found, [str(number) for number in range(1, len(found) + 1)]
    if suffix in _CODES and not options.format:
        source = Source.load(Path(word))
        diagram = code_diagram(_CODES[suffix], source)
        try:
            return [laid_out(diagram)], [stem]
        except CurveError as error:
            raise source.error(str(error)) from error
    if is_file:
        with curves.measured(word, options.format) as curve:
            if not options.layout:
                return seen([curve]), [stem]
            kind = knot_type(curve)
            if kind.diagram is None:
                raise CurveError(kind.refusal)
            return [laid_out(kind.diagram)], [stem]
    names = table_range(word) if ".." in word and "/" not in word else [word]
    diagrams = [(name, named_diagram(name)) for name in names]
    return [seen([knot(name)])[0] if each is None else laid_out(each) for name, each in diagrams], names
