"""The pages: an index that can be sorted and filtered, and one for each knot or link."""

import re
from collections.abc import Iterable, Sequence
from html import escape
from importlib.resources import files
from importlib.util import find_spec

from ... import __version__
from ...core.errors import counted
from .data import ARCHIVE, CURVES, TITLE, bounds, curve_path, rounded, template
from .entries import Values
from .folder import Folder

_ASSETS = ("style.css", "sort.js")
_MEASURES = {"ropelength": "ropelength", "writhe": "writhe", "average_crossing_number": "average crossing number"}
_SHORT = ("symmetry", "ropelength", "writhe", "crossings")
_HEADS = ("", "type", "least energy known", "proved ≤", "proved ≥", "minima", "saddles", "met", *_SHORT)
_KINDS = ("", "energy", "above the least", "at rest", "met", "from", *_SHORT, "curve")


def write(folder: Folder, entries: Sequence[Values]) -> None:
    """Write the index and the page of each entry."""
    for asset in _ASSETS:
        folder.put(asset, files(__package__).joinpath(asset).read_text(encoding="utf-8"))
    index = template("index.html").format(
        title=TITLE,
        types=len(entries),
        runs=sum(entry["runs"] for entry in entries),
        heads=_heads(f"<button>{word}</button>" if word else "" for word in _HEADS),
        rows="\n".join(_index_row(entry, place) for place, entry in enumerate(entries)),
    )
    _put(folder, "index.html", TITLE, index)
    for before, entry, after in zip([None, *entries[:-1]], entries, [*entries[1:], None], strict=True):
        _put(folder, f"knots/{entry['type']}.html", f"{entry['type']} – {TITLE}", _knot(entry, before, after))


def _put(folder: Folder, path: str, title: str, body: str) -> None:
    root = "../" * path.count("/")
    parquet = f', <a href="{root}data/minima.parquet">Parquet</a>' if find_spec("pyarrow") else ""
    words = {"title": title, "root": root, "version": __version__, "archive": ARCHIVE, "parquet": parquet}
    folder.put(path, template("page.html").format(body=body, **words))


def _index_row(entry: Values, place: int) -> str:
    least, name = entry["minima"][0], entry["type"]
    saddles = sum(each["index"] > 0 for each in entry["minima"])
    link = f'<a href="knots/{name}.html"'
    cells = [
        _cell(f'{link} tabindex="-1" aria-hidden="true">{picture}</a>' if (picture := _picture(least, "")) else ""),
        f'<th scope="row" data-value="{place}">{link}>{typeset(name)}</a></th>',
        _cell(_energy(least), least["energy"]),
        *(_cell(text, float(text) if text else None) for text in bounds(entry | least).values()),
        *(_cell(str(count), count) for count in (len(entry["minima"]) - saddles, saddles)),
        _cell(f"{least['met']} of {entry['runs']}", least["met"] / entry["runs"]),
        _cell(_group(least)),
        *(_cell(_number(least[name], 2), least[name]) for name in _MEASURES),
    ]
    return f'<tr data-name="{name}">{"".join(cells)}</tr>'


def _knot(entry: Values, before: Values | None, after: Values | None) -> str:
    least, name = entry["minima"][0], entry["type"]
    proved = bounds(entry | least)
    facts = {
        "Möbius energy": _energy(least),
        "proved: least energy of the type ≤": proved["upper_bound"],
        "proved: least energy of the type ≥": proved["lower_bound"],
        "at rest": _index(least),
        "symmetry": _group(least),
        "met by": f"{least['met']} of {counted(entry['runs'], 'run')}",
    } | {word: _number(least[measure], 4) for measure, word in _MEASURES.items()}
    return template("knot.html").format(
        name=typeset(name),
        before="<span></span>" if before is None else _link(before, "← "),
        after="<span></span>" if after is None else _link(after, "", " →"),
        picture=_picture(least, "../", f'alt="{name} at rest"'),
        facts="".join(f"<div><dt>{term}</dt><dd>{text}</dd></div>" for term, text in facts.items() if text),
        runs=counted(entry["runs"], "run"),
        heads=_heads(_KINDS),
        rows="\n".join(_knot_row(entry, minimum) for minimum in entry["minima"]),
        commands="\n".join(f"<pre>{escape(each['command'])}</pre>" for each in entry["minima"]),
        folder=escape(least["folder"]),
    )


def _knot_row(entry: Values, minimum: Values) -> str:
    least = entry["minima"][0]["energy"]
    kinds = ", ".join(f"{count} {kind}" for kind, count in minimum["kinds"].items())
    share = round(100 * minimum["met"] / entry["runs"])
    curves = (f'<a href="../data/{curve_path(entry, minimum, suffix)}">{suffix[1:].upper()}</a>' for suffix in CURVES)
    cells = [
        _picture(minimum, "../"),
        _energy(minimum),
        f"{100 * (minimum['energy'] / least - 1):.3f} %" if minimum["number"] > 1 else "",
        _index(minimum),
        f'<span class="bar" style="--share: {share}%">{minimum["met"]}</span>',
        f'<span class="kinds">{escape(kinds)}</span>',
        _group(minimum),
        *(_number(minimum[name], 2) for name in _MEASURES),
        " ".join(curves),
    ]
    return f"<tr>{''.join(map(_cell, cells))}</tr>"


def _group(minimum: Values) -> str:
    """A group's name: D3, C∞v."""
    return re.sub(r"(?<=^[A-Z])(.+)", r"<sub>\1</sub>", minimum["symmetry"])


def typeset(name: str) -> str:
    """A name with its number as a subscript: 6_2, L6a4."""
    return re.sub(r"_(\d+)", r"<sub>\1</sub>", name)


def _link(entry: Values, before: str = "", after: str = "") -> str:
    return f'<a href="{entry["type"]}.html">{before}{typeset(entry["type"])}{after}</a>'


def _picture(minimum: Values, root: str, words: str = 'alt="" loading="lazy"') -> str:
    path = minimum["picture"]
    return f'<img src="{root}{path}" {words} width="640" height="480">' if path else ""


def _heads(words: Iterable[str]) -> str:
    return "".join(f'<th scope="col">{word}</th>' if word else "<td></td>" for word in words)


def _cell(text: str, value: float | None = None) -> str:
    return f"<td>{text}</td>" if value is None else f'<td data-value="{value:.12g}">{text}</td>'


def _number(value: float, decimals: int) -> str:
    return f"{value:z.{decimals}f}".replace("-", "−")


def _energy(minimum: Values) -> str:
    digits, power = f"{minimum['error']:.0e}".split("e")
    error = f"{digits}·10<sup>{int(power)}</sup>".replace("-", "−")
    return f"{rounded(minimum['energy'], minimum['error'])} <small>± {error}</small>"


def _index(minimum: Values) -> str:
    return f"saddle of index {minimum['index']}" if minimum["index"] else "minimum"
