"""``mobius-flow atlas``: the minima that batches have found, as pages to read and as a data package.

The pages are an index that can be sorted and filtered, and one for each knot or link.
"""

import argparse
import hashlib
import json
import re
import shlex
import sys
import tempfile
from collections.abc import Mapping, Sequence
from html import escape
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ... import __version__
from ...cli.options import DEFAULT
from ...cli.places import check_directory, export
from ...cli.progress import live
from ...cli.terminal import emit, quoted, report
from ...core.base import MobiusFlowError, counted
from . import data
from .data import ARCHIVE, CURVES, TITLE, bounds, curve_path, rounded, template
from .entries import Runs, Values, curve_of, entry
from .folder import Folder

if TYPE_CHECKING:
    from jinja2 import Environment

LARGE, SMALL = (640, 480), (240, 180)
SAMPLES = 8  # of a pixel: more make no visible difference after denoising
NO_LOOK = "none"


def environment() -> "Environment":
    """What fills in the templates; a MobiusFlowError if jinja2 is missing."""
    try:
        from jinja2 import Environment, FunctionLoader
    except ImportError as error:
        raise MobiusFlowError('pages need jinja2: pip install jinja2 (the extra "lab")') from error
    room = Environment(loader=FunctionLoader(template), trim_blocks=True, keep_trailing_newline=True)
    room.filters |= {"typeset": typeset, "energy": energy, "number": number, "group": group}
    room.filters |= {"escape": escape, "quote": shlex.quote, "counted": counted}
    room.globals |= {"title": TITLE, "version": __version__, "archive": ARCHIVE, "parquet": find_spec("pyarrow")}
    room.globals |= {"bounds": bounds, "curve_path": curve_path, "suffixes": CURVES}
    return room


def write_pages(folder: Folder, entries: Sequence[Values], room: "Environment") -> None:
    """Write the index and the page of each entry, by the templates."""
    for asset in ("style.css", "sort.js"):
        folder.put(asset, files(__package__).joinpath(asset).read_text(encoding="utf-8"))
    folder.put("index.html", room.get_template("index.html").render(entries=entries, root=""))
    for before, each, after in zip([None, *entries[:-1]], entries, [*entries[1:], None], strict=True):
        page = room.get_template("knot.html").render(entry=each, before=before, after=after, root="../")
        folder.put(f"knots/{each['type']}.html", page)


def typeset(name: str) -> str:
    """A name with its number as a subscript: 6_2, L6a4."""
    return re.sub(r"_(\d+)", r"<sub>\1</sub>", name)


def group(name: str) -> str:
    """A group's name: D3, C∞v."""
    return re.sub(r"(?<=^[A-Z])(.+)", r"<sub>\1</sub>", name)


def number(value: float, decimals: int) -> str:
    """A number with a proper sign, and none before zero."""
    return f"{value:z.{decimals}f}".replace("-", "−")


def energy(minimum: Values) -> str:
    """An energy with its error."""
    digits, power = f"{minimum['error']:.0e}".split("e")
    error = f"{digits}·10<sup>{int(power)}</sup>".replace("-", "−")
    return f"{rounded(minimum['energy'], minimum['error'])} <small>± {error}</small>"


def make(options: argparse.Namespace) -> int:
    """Make what is missing, entry by entry."""
    style, room = usable(options.look), environment()
    check_directory(options.output)
    folder = Folder(Path(options.output))
    runs = Runs.of(map(Path, options.results))
    entries = []
    with live() as show:
        for k, (name, each) in enumerate(runs.by_type.items(), start=1):
            show(f"type {k} of {len(runs.by_type)}: {name}")
            found, doubtful = entry(folder, name, each)
            for reason, names in doubtful.items():
                runs.left_out[reason] += names
            for minimum in found["minima"] if found else ():
                minimum["picture"] = picture(folder, name, minimum, style)
            entries += [found] if found else []
    if not entries:
        raise MobiusFlowError(f"there is nothing for an atlas: {runs.missing}")
    data.write(folder, entries)
    write_pages(folder, entries, room)
    folder.close()
    source = f"from {counted(sum(each['runs'] for each in entries), 'run')}"
    rows = [("left out", str(runs.missing or "")), ("wrote", [quoted(folder.path / "index.html")])]
    emit(report((f"✓ {counted(len(entries), 'type')}", source), rows, sys.stdout))
    return 0


def picture(folder: Folder, name: str, minimum: Mapping[str, Any], look: str) -> str | None:
    """The path of a minimum's picture in the folder, rendered unless it is there; the least minimum's is large.

    Its name contains the hash of what it shows, as another curve may take its place.
    """
    if look == NO_LOOK:
        return None
    size = LARGE if minimum["number"] == 1 else SMALL
    shown = json.dumps([minimum["fourier"], look, size, SAMPLES])
    path = f"pictures/{name}-{minimum['number']}-{hashlib.sha256(shown.encode()).hexdigest()[:10]}.jpg"
    if not folder.keep(path):
        curve = curve_of(minimum)
        with tempfile.TemporaryDirectory(prefix="mobius-flow-") as room:
            made = Path(room, "picture.jpg")
            smooth = curve.polygon([2 * n for n in curve.sizes])
            export.write_picture(made, smooth, *size, look, SAMPLES)
            folder.put(path, made.read_bytes())
    return path


def usable(look: str | None) -> str:
    """The look asked for, by default the pictures' own if Blender's module is installed; raises MobiusFlowError."""
    if look == NO_LOOK:
        return look
    try:
        export.require_blender()
    except MobiusFlowError:
        if look is None:
            return NO_LOOK
        raise
    return look or DEFAULT
