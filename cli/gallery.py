"""``mobius-flow gallery``: one page with a picture of every result of a batch."""

import argparse
import csv
import json
import math
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..addon.pictures import export
from ..core import Curve, MobiusFlowError, Status, read_curve
from ..core.driver.interventions.balance import balanced
from ..core.errors import wrong_suffix
from .batch.job import CSV, CURVE, folder_name
from .batch.table import FAILED
from .curves import check_regular
from .figures import figure_class
from .places import check_place, writing
from .progress import bar

SIZE = 300  # pixels of a picture's side
INCHES, HEAD = 2.4, 0.45  # of a picture's side, and of the lines above it
ASPECT = 1.4  # of the page, about
HOLDING = {"avoid", "pins"}  # options that Möbius images do not keep
_EPILOG = """\
example:
  mobius-flow batch 3_1..7_7 -o results && mobius-flow gallery results -o gallery.png

Converged curves are shown as the Möbius image, of the same energy, that bends least, but for open ones and those that
were pinned or had obstacles. A picture takes some three seconds of processor time. The energy is that of the smooth
curve, with its error, where batch was told to --extrapolate it.

exit status: 0; 2 where there are no results, something is not installed, or OUT cannot be written; 130 interrupted
"""


def add_gallery(parser: argparse.ArgumentParser) -> None:
    """Describe ``gallery``."""
    parser.description, parser.epilog = "Show all results of a batch on one page.", _EPILOG
    parser.add_argument("results", metavar="RESULTS", help="directory that mobius-flow batch wrote to")
    parser.add_argument("-o", "--output", required=True, metavar="OUT.png", help="the page")
    parser.set_defaults(run=_run)


@dataclass(frozen=True)
class Shown:
    """A result: where its curve is, its title, and whether its Möbius images are at rest as well."""

    curve: Path
    title: str
    free: bool

    def look(self) -> Curve:
        """The curve as it is shown."""
        curve = read_curve(self.curve)
        return balanced(curve) if self.free and curve.mesh.all_closed else curve


def _run(options: argparse.Namespace) -> int:
    """Render every result, and put the pictures on a page."""
    if Path(options.output).suffix.lower() != ".png":
        raise MobiusFlowError(f"{options.output}: {wrong_suffix(options.output, ['.png'], 'galleries')}")
    export.require_blender()
    figure_class()
    check_place(options.output)
    shown = _results(Path(options.results))
    with tempfile.TemporaryDirectory(prefix="mobius-flow-") as room:
        pictures = [Path(room, f"{k}.png") for k in range(len(shown))]
        with bar(sys.stderr.isatty(), total=len(shown), unit=" pictures") as progress:
            for each, picture in zip(shown, pictures, strict=True):
                export.write_picture(picture, each.look(), SIZE, SIZE)
                if progress is not None:
                    progress.update()
        _write_page(options.output, [each.title for each in shown], pictures)
    return 0


def _results(directory: Path) -> list[Shown]:
    """The rows of a table that have results; a MobiusFlowError tells where there are none."""
    try:
        if not (directory / CSV).is_file():
            raise FileNotFoundError  # also for a pipe, which might never end
        with (directory / CSV).open(encoding="utf-8", newline="") as stream:
            rows = [row for row in csv.DictReader(stream) if row["status"] != FAILED]
        found = [_shown(directory, row) for row in rows]
    except (OSError, ValueError, KeyError, TypeError, csv.Error) as error:  # TypeError: of short rows
        raise MobiusFlowError(f"{directory}: holds no results of mobius-flow batch") from error
    if not found:
        raise MobiusFlowError(f"{directory}: none of the runs has a result")
    for each in found:
        check_regular(each.curve)  # before pictures, which take time
    return found


def _shown(directory: Path, row: dict[str, str]) -> Shown:
    folder = folder_name(row["name"], int(row["start"]))
    if row["extrapolated_energy"]:
        energy = f"{float(row['extrapolated_energy']):.4f} ± {float(row['extrapolated_energy_error']):.1g}"
    else:
        energy = f"{float(row['energy']):.4f}"
    free = row["status"] == Status.CONVERGED.value and HOLDING.isdisjoint(json.loads(row["options"]))
    return Shown(directory / folder / CURVE, f"{folder}\n{energy}", free)


def _write_page(path: str, titles: Sequence[str], pictures: Sequence[Path]) -> None:
    from matplotlib.image import imread

    columns = math.ceil(math.sqrt(ASPECT * len(pictures)))
    rows = math.ceil(len(pictures) / columns)
    figure = figure_class()(figsize=(INCHES * columns, (INCHES + HEAD) * rows), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in grid:
        axes.set_axis_off()
    for axes, title, picture in zip(grid, titles, pictures, strict=False):
        axes.imshow(imread(picture))
        axes.set_title(title, fontsize=10, parse_math=False)
    with writing(path) as temporary:
        figure.savefig(temporary, dpi=SIZE / INCHES, bbox_inches="tight")
