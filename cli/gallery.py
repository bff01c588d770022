"""``mobius-flow gallery``: one page with a picture of every result of a batch, or of knots of an atlas."""

import argparse
import json
import math
import re
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..addon.pictures import export
from ..core import Curve, MobiusFlowError, Status, read_curve
from ..core.driver.interventions.balance import balanced
from ..core.errors import wrong_suffix
from . import options as relax_options
from .atlas.data import curve_path
from .atlas.folder import SUMS
from .atlas.pictures import SAMPLES
from .batch.folder import results
from .batch.job import CURVE
from .batch.table import Row
from .curves import check_regular
from .figures import figure_class
from .places import check_place, writing
from .progress import bar

SIZE = 300  # pixels of a picture's side
LARGEST = 4000
INCHES, HEAD = 2.4, 0.45  # of a picture's side, and of the lines above it
ASPECT = 1.4  # of the page, about
HOLDING = {"avoid", "pins"}  # options that Möbius images do not keep
_BELOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_EPILOG = """\
examples:
  mobius-flow batch 3_1..7_7 -o results && mobius-flow gallery results -o gallery.png
  mobius-flow gallery atlas -o poster.png --only 3_1,4_1,5_1,7_4,8_18,L6a4 --look studio --size 1200

Converged curves are shown as the Möbius image, of the same energy, that bends least, but for open ones and those that
were pinned or had obstacles. A picture takes some two seconds of processor time, and more if it is larger. The energy
is that of the smooth curve, with its error, where batch was told to --extrapolate it.

exit status: 0; 2 where there are no results, something is not installed, or OUT cannot be written; 130 interrupted
"""


def add_gallery(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Show all results of a batch, or knots of an atlas, on one page.", _EPILOG
    text = "directory that mobius-flow batch or mobius-flow atlas wrote to"
    parser.add_argument("results", metavar="RESULTS", help=text)
    parser.add_argument("-o", "--output", required=True, metavar="OUT.png", help="the page")
    parser.add_argument("--only", metavar="A,B,…", help="names of what is shown, in this order (default: all)")
    parser.add_argument("--look", type=relax_options.look, metavar="LOOK", help="of the pictures, as for relax")
    parser.add_argument("--size", type=int, default=SIZE, metavar="N", help=f"pixels of a picture (default: {SIZE})")
    parser.set_defaults(run=_run)


@dataclass(frozen=True)
class Shown:
    """A result: its name, where its curve is, its title, and whether its Möbius images are at rest as well."""

    name: str
    curve: Path
    title: str
    free: bool

    def look(self) -> Curve:
        curve = read_curve(self.curve)
        return balanced(curve) if self.free and curve.mesh.all_closed else curve


def _run(options: argparse.Namespace) -> int:
    if Path(options.output).suffix.lower() != ".png":
        raise MobiusFlowError(f"{options.output}: {wrong_suffix(options.output, ['.png'], 'galleries')}")
    if not 16 <= options.size <= LARGEST:
        raise MobiusFlowError(f"size is {options.size}; give 16 to {LARGEST}")
    export.require_blender()
    figure_class()
    check_place(options.output)
    shown = _chosen(_found(Path(options.results)), options)
    with tempfile.TemporaryDirectory(prefix="mobius-flow-") as room:
        pictures = [Path(room, f"{k}.png") for k in range(len(shown))]
        with bar(sys.stderr.isatty(), total=len(shown), unit=" pictures") as progress:
            for each, picture in zip(shown, pictures, strict=True):
                export.write_picture(picture, each.look(), options.size, options.size, options.look, SAMPLES)
                if progress is not None:
                    progress.update()
        _write_page(options.output, [each.title for each in shown], pictures, options.size)
    return 0


def _found(directory: Path) -> list[Shown]:
    """What a directory holds; a MobiusFlowError tells where that is nothing."""
    of = _of_atlas if (directory / SUMS).is_file() else _of_batch
    return list(of(directory))


def _of_batch(directory: Path) -> Iterator[Shown]:
    for folder, _, row in sorted(results(directory), key=lambda each: (each[2].name, each[2].start)):
        free = row.status == Status.CONVERGED.value and HOLDING.isdisjoint(json.loads(row.options))
        yield Shown(folder.name, folder / CURVE, f"{folder.name}\n{_energy(row)}", free)


def _energy(row: Row) -> str:
    if row.extrapolated_energy is None or row.extrapolated_energy_error is None:
        return f"{row.energy:.4f}"
    return f"{row.extrapolated_energy:.4f} ± {row.extrapolated_energy_error:.1g}"


def _of_atlas(directory: Path) -> Iterator[Shown]:
    """The least curves, balanced as they are."""
    try:
        entries = json.loads((directory / "data/atlas.json").read_text(encoding="utf-8"))
        for entry in entries:
            least = entry["minima"][0]
            title = re.sub(r"_(\d+)", lambda found: found[1].translate(_BELOW), entry["name"])
            place = directory / curve_path(entry, least, ".json")
            yield Shown(entry["name"], place, f"{title}\n{least['energy']:.4f}", False)
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise MobiusFlowError(f"{directory}: holds no atlas that is whole; repeat mobius-flow atlas") from error


def _chosen(found: Sequence[Shown], options: argparse.Namespace) -> list[Shown]:
    """Those that are wanted, whose files are there: pictures take time."""
    by_name = {each.name: each for each in found}
    wanted = [word.strip() for word in options.only.split(",")] if options.only else list(by_name)
    for name in wanted:
        if name not in by_name:
            raise MobiusFlowError(f"{options.results}: has no {name[:60]!r}; leave it out of --only")
        check_regular(by_name[name].curve)
    return [by_name[name] for name in wanted]


def _write_page(path: str, titles: Sequence[str], pictures: Sequence[Path], size: int = SIZE) -> None:
    """Put pictures side by side on a ground of their own colour."""
    from matplotlib.image import imread

    columns = round(math.sqrt(ASPECT * len(pictures))) or 1
    rows = math.ceil(len(pictures) / columns)
    figure = figure_class()(figsize=(INCHES * columns, (INCHES + HEAD) * rows), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    images = [imread(picture)[..., :3] for picture in pictures]
    ground = np.median(np.concatenate([image[0] for image in images]), axis=0)
    figure.set_facecolor(ground.tolist())
    ink = "#1d1c1a" if ground.mean() > 0.5 else "#e7e3da"
    for axes in grid:
        axes.set_axis_off()
    for axes, title, image in zip(grid, titles, images, strict=False):
        axes.imshow(image)
        axes.set_title(title, fontsize=10, color=ink, family=["STIXGeneral", "DejaVu Sans"], parse_math=False)
    with writing(path) as temporary:
        figure.savefig(temporary, dpi=size / INCHES, bbox_inches="tight")
