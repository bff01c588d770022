"""``mobius-flow atlas``: the minima that batches have found, as pages to read and as a data package."""

import argparse
import sys
from pathlib import Path

from ...addon.pictures.looks import DEFAULT
from ...core.errors import counted
from ..options import look
from ..progress import bar
from ..streams import emit
from . import data, pages
from .entries import entry
from .folder import Folder
from .pictures import NO_LOOK, picture, usable
from .runs import Runs

_EPILOG = """\
examples:
  mobius-flow batch 3_1..7_7 -o results --starts 10 --extrapolate --escape-saddles
  mobius-flow atlas results -o atlas
  mobius-flow gallery atlas -o poster.png --only 3_1,4_1,5_1,5_2

Runs count that ended, by a trajectory that verify accepts, as a knot or link of the table, which is proved or was made
by that name, and whose smooth shape batch found; mirror images are turned over. Those of equal energy, whose shapes are
the same up to Möbius maps and isometries, have met the same minimum.

DIR has pages (index.html), and in DIR/data tables, curves and their description, also as one archive to be deposited.
The same command again does what is new. Only what atlas wrote is replaced or removed; DIR/SHA256SUMS lists it. Pictures
need Blender's Python module, and take some ten seconds of processor time each.

exit status: 0; 2 where no run counts, files of others are in the way, or DIR cannot be written; 130 interrupted
"""


def add_atlas(parser: argparse.ArgumentParser) -> None:
    """Describe ``atlas``."""
    parser.description, parser.epilog = "Make pages and a package of data from the results of batches.", _EPILOG
    parser.add_argument("results", metavar="RESULTS", nargs="+", help="directory that mobius-flow batch wrote to")
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="directory of the atlas")
    text = (
        f"of the pictures, as for relax, or {NO_LOOK} (default: {DEFAULT.lower()} where Blender's module is installed)"
    )
    parser.add_argument("--look", type=lambda word: look(word, NO_LOOK), metavar="LOOK", help=text)
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    """Make what is missing, entry by entry."""
    style = usable(options.look)
    folder = Folder(Path(options.output))
    runs = Runs.of(map(Path, options.results))
    entries = []
    with bar(sys.stderr.isatty(), total=len(runs.by_type), unit=" types") as progress:
        for name, each in runs.by_type.items():
            found = entry(folder, name, each)
            for minimum in found["minima"]:
                minimum["picture"] = picture(folder, name, minimum, style)
            entries.append(found)
            if progress is not None:
                progress.update()
    data.write(folder, entries)
    pages.write(folder, entries)
    folder.close()
    total = f"{counted(len(entries), 'type')} from {counted(sum(each['runs'] for each in entries), 'run')}"
    emit(total + (f"; left out: {runs.missing}" if runs.missing else ""))
    return 0
