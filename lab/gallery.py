"""``mobius-flow gallery``: one page with a picture of every result of a batch, or of knots of an atlas."""

import argparse
import json
import math
import re
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..cli.curves import check_regular
from ..cli.options import DEFAULT, LOOKS
from ..cli.places import check_place, export
from ..cli.progress import live
from ..cli.terminal import say_written
from ..core import Curve, MobiusFlowError, Status, read_curve
from ..core.base import FloatArray, atomic_write, wrong_suffix
from ..core.driver.moves.balance import balanced
from .atlas.data import TITLE, curve_path
from .atlas.folder import SUMS
from .batch.folder import results
from .batch.job import CURVE
from .compare.figures import figure_class


@dataclass(frozen=True)
class Shown:
    """A result: its name, its curve's path, its title, and whether its Möbius images are at rest as well."""

    name: str
    curve: Path
    title: str
    free: bool

    def look(self) -> Curve:
        curve = read_curve(self.curve)
        return balanced(curve) if self.free and curve.mesh.all_closed else curve


def gallery(options: argparse.Namespace) -> int:
    if Path(options.output).suffix.lower() != ".png":
        raise MobiusFlowError(f"{options.output}: {wrong_suffix(options.output, ['.png'], 'galleries')}")
    if not 16 <= options.size <= 4000:
        raise MobiusFlowError(f"size is {options.size}; give 16 to 4000")
    export.require_blender()
    figure_class()
    check_place(options.output)
    place, look, size = Path(options.results), options.look or DEFAULT, options.size
    shown = _chosen(place, options.only)
    with tempfile.TemporaryDirectory(prefix="mobius-flow-") as room:
        pictures = [Path(room, f"{k}.png") for k in range(len(shown))]
        with live() as show:
            for k, (each, picture) in enumerate(zip(shown, pictures, strict=True), start=1):
                show(f"picture {k} of {len(shown)}: {each.name}")
                export.write_picture(picture, each.look(), size, size, look, cut_out=True)
        head = TITLE if (place / SUMS).is_file() else ""
        _write_page(options.output, [each.title for each in shown], pictures, look, size, head)
    say_written(options.output)
    return 0


def _chosen(directory: Path, only: str | None) -> list[Shown]:
    """The results asked for, once all their files are known to exist: pictures take time."""
    by_name = {each.name: each for each in (_of_atlas if (directory / SUMS).is_file() else _of_batch)(directory)}
    wanted = [word.strip() for word in only.split(",")] if only else list(by_name)
    for name in wanted:
        if name not in by_name:
            raise MobiusFlowError(f"{directory}: has no {name[:60]!r}; leave it out of --only")
        check_regular(by_name[name].curve)
    return [by_name[name] for name in wanted]


def _of_batch(directory: Path) -> Iterator[Shown]:
    for folder, _, row in sorted(results(directory), key=lambda each: (each[2].name, each[2].start)):
        # Möbius images do not keep obstacles and pins
        free = row.status == Status.CONVERGED.value and {"avoid", "pins"}.isdisjoint(json.loads(row.options))
        name = folder.name.replace("$", r"\$")  # a $ would begin a formula
        energy = f"{row.energy:.4f}"
        if row.extrapolated_energy is not None and row.extrapolated_energy_error is not None:
            energy = f"{row.extrapolated_energy:.4f} ± {row.extrapolated_energy_error:.1g}"
        yield Shown(folder.name, folder / CURVE, f"{name}\n{energy}", free)


def _of_atlas(directory: Path) -> Iterator[Shown]:
    """The least curves, balanced and upright as they are."""
    try:
        entries = json.loads((directory / "data/atlas.json").read_text(encoding="utf-8"))
        for entry in entries:
            least = entry["minima"][0]
            name = re.sub(r"_(\d+)", r"$_{\1}$", entry["type"])
            group = re.sub(r"(?<=^[A-Z])(.+)", r"$_{\\mathrm{\1}}$", least["symmetry"])
            place = directory / "data" / curve_path(entry, least, ".json")
            yield Shown(entry["type"], place, f"{name}\n{least['energy']:.4f}   {group}", False)
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise MobiusFlowError(f"{directory}: holds no atlas that is whole; repeat mobius-flow atlas") from error


def _write_page(path: str, titles: Sequence[str], pictures: Sequence[Path], look: str, size: int, head: str) -> None:
    """Put pictures side by side on one ground, with the first line of each title large below it."""
    from matplotlib.image import imread

    columns = round(math.sqrt(0.75 * len(pictures))) or 1  # of the page, about
    side, cell, foot, margin = 2.9, 2.4, 0.4, 0.8  # inches: of a picture, its place, the lines below, and around all
    outside = margin + (0.6 if head else 0.0)
    width = cell * columns + 2.0 * margin
    height = (cell + foot) * math.ceil(len(pictures) / columns) + 2.0 * outside
    red, green, blue = (1.055 * value ** (1.0 / 2.4) - 0.055 for value in LOOKS[look].floor)  # sRGB, as screens expect
    figure = figure_class()(figsize=(width, height), facecolor=(red, green, blue))
    ink, faint = ("#1d1c1a", "#6d6a64") if green > 0.5 else ("#e7e3da", "#9a958b")

    def write(x: float, y: float, text: str, points: float, color: str) -> None:
        shown = figure.text(x / width, y / height, text, size=points, color=color, ha="center", math_fontfamily="stix")
        shown.set_fontfamily(["STIXGeneral", "DejaVu Sans"])

    if head:
        density = r"\left(\dfrac{1}{|\gamma(s)-\gamma(t)|^2}-\dfrac{1}{d(s,t)^2}\right)"
        write(0.5 * width, height - margin - 0.3, head, 24.0, ink)
        write(0.5 * width, margin, rf"$\iint\;{density}\;\mathrm{{d}}s\,\mathrm{{d}}t$", 12.0, faint)
    for k, (title, picture) in enumerate(zip(titles, pictures, strict=True)):
        x, y = margin + cell * (k % columns + 0.5), height - outside - cell * 0.5 - (cell + foot) * (k // columns)
        corner = (x - 0.5 * side) / width, (y - 0.5 * side) / height
        axes = figure.add_axes((*corner, side / width, side / height))
        axes.set_axis_off()
        axes.imshow(_faded(imread(picture)))
        name, _, more = title.partition("\n")
        write(x, y - 0.5 * cell - 0.08, name, 15.0, ink)
        write(x, y - 0.5 * cell - 0.28, more, 9.5, faint)
    with atomic_write(path) as temporary:
        figure.savefig(temporary, dpi=size / side)


def _faded(image: FloatArray) -> FloatArray:
    """A picture, of shape (n, n, 4), whose shadows fade out before its edge."""
    n = len(image)
    x = (np.arange(n) + 0.5) / n - 0.5
    # 0.34 of a picture's side: from there shadows fade, to its end
    inside = np.clip((0.5 - np.hypot(x, x[:, None])) / (0.5 - 0.34), 0.0, 1.0)
    alpha = image[..., 3]
    around = np.median(np.concatenate([alpha[0], alpha[-1], alpha[:, 0], alpha[:, -1]]))
    alpha = (alpha - around).clip(0.0) / max(1.0 - around, 1e-9) * inside**2 * (3.0 - 2.0 * inside)
    return np.concatenate([image[..., :3], alpha[..., None]], axis=2)
