"""``mobius-flow knot``: write a named knot as a curve file."""

import argparse
import os
import re
import sys
from pathlib import Path

from ..core import CurveError, MobiusFlowError, OptionError, knot_list
from ..core.base import counted
from ..core.io import written_formats
from ..core.knots import UnknownKnotError, knot, knot_names, smooth_knot
from . import curves
from .places import check_directory, check_place
from .terminal import quoted, report, say_written

LISTS = (".csv", ".tsv", ".txt", ".xls", ".xlsx")
_EPILOG = """\
examples:
  mobius-flow knot 3_1 trefoil.txt
  mobius-flow knot "T(3,5)" - --format obj
  mobius-flow knot 7_4 smooth.obj --smooth
  mobius-flow knot overhand arc.txt
  mobius-flow knot "plat(2,2,-1,2)" plat.txt
  mobius-flow knot "DT: [4 8 10 2 6]" coded.txt
  mobius-flow knot "[[1,5,2,4],[3,1,4,6],[5,3,6,2]]" coded.txt
  mobius-flow knot K11n34 larger.txt
  mobius-flow knot knotinfo.csv knots/
  mobius-flow knot --list

A list (.csv, .tsv, .txt: a table with a column such as pd_notation, dt_notation or braid_notation, a code or a name in
each line, or Knoodle's knots) makes a file for each of its knots in the directory OUT, which is made if need be.

Knots are numbered as in KnotInfo: 10_162 to 10_165 are 10_163 to 10_166 in Rolfsen's book, where 10_161 stands twice
(Perko's pair), and SnapPy has 10_83 and 10_86 the other way round.

exit status: 0, or 2 on bad input or bad options, or where OUT cannot be written
"""


def add_knot(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Write a named knot as a curve.", _EPILOG
    formats = written_formats()
    text = (
        'such as 3_1, goeritz, hopf, overhand, "T(3,5)", "braid(1,-2,1,-2)", a code, "DT: [4 6 2]", or, with the extra '
        "knots, K11n34"
    )
    parser.add_argument("name", metavar="NAME", help=text)
    parser.add_argument("output", metavar="OUT", help=f"curve: {', '.join(formats)}, or - for standard output")
    curves.add_format(parser, formats)
    default = "enough for edges to be shorter than the gaps between strands"
    text = f"number of vertices, at most {curves.MAX_VERTICES} (default: {default})"
    parser.add_argument("--vertices", type=int, metavar="N", help=text)
    text = (
        "a smooth curve for a knot of the table: the shape of least Möbius energy, but with strands far enough apart "
        "to see (default: a closed braid)"
    )
    parser.add_argument("--smooth", action="store_true", help=text)
    # like --version, it ends the command even if something else is missing
    names = "\n".join(knot_names())
    parser.add_argument("--list", action="version", version=names, help="print the names, one per line, and exit")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    if Path(options.name).suffix.lower() in LISTS:
        return _write_list(options)
    curves.format_for(options.output, options.format)
    check_place(options.output)
    try:
        curve = (smooth_knot if options.smooth else knot)(options.name, options.vertices)
    except UnknownKnotError as error:
        raise UnknownKnotError(f"{error}; see mobius-flow knot --list") from error
    if len(curve) > (most := curves.MAX_VERTICES):
        told = f"{options.name[:60]} gets {len(curve)} vertices, and no command takes more than {most}"
        raise CurveError(f"{told}; give --vertices {most}")
    curves.write(options.output, curve, options.format)
    if options.output != curves.STREAM:
        say_written(options.output, "relax", options.output, "relaxed.obj")
    return 0


def _write_list(options: argparse.Namespace) -> int:
    """A file for each knot of a list; knots that cannot be drawn are left out, and named in the end."""
    if options.smooth:
        raise OptionError("--smooth is for names of the table, and lists have codes; leave it out")
    check_directory(options.output)
    suffix, refused, written = options.format or "txt", [], set[str]()
    listed = knot_list(options.name)
    os.makedirs(options.output, exist_ok=True)
    for number, (name, code) in enumerate(listed.items(), start=1):
        try:
            curve = knot(code, options.vertices)
        except MobiusFlowError as error:
            refused.append(f"{name}: {error}")
            continue
        stem = re.sub(r"[^0-9A-Za-z_+#-]", "_", name)
        stem = f"{stem}-{number}" if stem.lower() in written else stem  # different names may become the same
        written.add(stem.lower())
        curves.write(os.path.join(options.output, f"{stem}.{suffix}"), curve)
    if refused:
        raise MobiusFlowError(f"{len(refused)} of {counted(len(listed), 'knot')} cannot be made: {refused[0]}")
    print(report((f"✓ {counted(len(listed), 'knot')}", [quoted(options.output)]), [], sys.stderr), file=sys.stderr)
    return 0
