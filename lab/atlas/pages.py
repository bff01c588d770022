"""The pages: an index that can be sorted and filtered, and one for each knot or link."""

import re
import shlex
from collections.abc import Sequence
from html import escape
from importlib.resources import files
from importlib.util import find_spec
from typing import TYPE_CHECKING

from ... import __version__
from ...core.base.errors import MobiusFlowError, counted
from .data import ARCHIVE, CURVES, TITLE, bounds, curve_path, rounded, template
from .entries import Values
from .folder import Folder

if TYPE_CHECKING:
    from jinja2 import Environment


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


def write(folder: Folder, entries: Sequence[Values], room: "Environment") -> None:
    """Write the index and the page of each entry, by the templates."""
    for asset in ("style.css", "sort.js"):
        folder.put(asset, files(__package__).joinpath(asset).read_text(encoding="utf-8"))
    folder.put("index.html", room.get_template("index.html").render(entries=entries, root=""))
    for before, entry, after in zip([None, *entries[:-1]], entries, [*entries[1:], None], strict=True):
        page = room.get_template("knot.html").render(entry=entry, before=before, after=after, root="../")
        folder.put(f"knots/{entry['type']}.html", page)


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
