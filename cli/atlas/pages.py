"""The pages: an index that can be sorted and filtered, and one for each knot or link."""

import math
import re
from collections.abc import Sequence
from html import escape
from importlib.resources import files

from ... import __version__
from .data import CURVES, bound, curve_path, rounded
from .entries import Values
from .folder import Folder

_ASSETS = ("style.css", "sort.js")
_TITLE = "Curves at rest under the Möbius energy"
_MEASURES = ("symmetry", "ropelength", "writhe", "crossings")
_HEADS = ("", "type", "least energy known", "proved ≤", "proved ≥", "minima", "saddles", "met", *_MEASURES)
_KINDS = ("", "energy", "above the least", "index", "met", "from", *_MEASURES, "curve")
_PAGE = """\
<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<link rel="stylesheet" href="{root}style.css">
{body}
<footer>Made by mobius-flow {version}. The data: <a href="{root}data/README.md">what they are</a>,
<a href="{root}data/atlas.csv">the least</a>, <a href="{root}data/minima.csv">all</a>,
<a href="{root}data/atlas.json">JSON</a>.</footer>
</html>
"""
_INDEX = """\
<header><h1>{title}</h1>
<p>The least Möbius energies known of {types} knots and links, as smooth curves: where {runs} relaxations came to rest,
each of them proved to be an isotopy. The circle has 4. Shapes are those Möbius images that bend least.</p></header>
<main><p><input id="filter" type="search" placeholder="filter: 7_, L6, 10_1 …" aria-label="filter by type"></p>
<div class="wide"><table class="sortable"><thead><tr>{heads}</tr></thead>
<tbody>
{rows}
</tbody></table></div></main>
<script src="sort.js"></script>"""
_KNOT = """\
<nav>{before}<a href="../index.html">all</a>{after}</nav>
<main><h1>{name}</h1>
<div class="facing"><figure>{picture}</figure>
<dl>{facts}</dl></div>
<h2>Where runs came to rest</h2>
<div class="wide"><table><thead><tr>{heads}</tr></thead>
<tbody>
{rows}
</tbody></table></div>
<h2>To make it again</h2>
<pre>{command}</pre>
<p>The way there is in <code>results/{folder}/trajectory.npz</code>, free of contact by proof, as anybody can check:</p>
<pre>mobius-flow verify results/{folder}/trajectory.npz
mobius-flow view results/{folder}/trajectory.npz motion.html</pre>
<p>Found by mobius-flow {version}. The smooth curves are in <a href="../data/fourier/{file}.json">{file}.json</a>, as
Fourier series.</p>
</main>"""


def write(folder: Folder, entries: Sequence[Values]) -> None:
    """Write the index and the page of each entry."""
    for asset in _ASSETS:
        folder.put(asset, files(__package__).joinpath(asset).read_text(encoding="utf-8"))
    heads = "".join(f'<th scope="col"><button>{head}</button></th>' if head else "<th></th>" for head in _HEADS)
    rows = "\n".join(map(_index_row, entries))
    runs = sum(entry["runs"] for entry in entries)
    _put(
        folder, "index.html", _TITLE, _INDEX.format(title=_TITLE, types=len(entries), runs=runs, heads=heads, rows=rows)
    )
    for before, entry, after in zip([None, *entries[:-1]], entries, [*entries[1:], None], strict=True):
        _put(folder, f"knots/{entry['name']}.html", f"{entry['name']} – {_TITLE}", _knot(entry, before, after))


def _put(folder: Folder, path: str, title: str, body: str) -> None:
    root = "../" * path.count("/")
    folder.put(path, _PAGE.format(title=title, root=root, body=body, version=__version__))


def _index_row(entry: Values) -> str:
    least = entry["minima"][0]
    saddles = sum(each["index"] > 0 for each in entry["minima"])
    upper, lower = bounds(entry)
    link = f'<a href="knots/{entry["name"]}.html">'
    cells = [
        _cell(f"{link}{_picture(least, '', 'lazy')}</a>"),
        f'<th scope="row" data-value="{entry["position"]}">{link}{typeset(entry["name"])}</a></th>',
        _cell(_energy(least), least["energy"]),
        _cell(upper, float(upper) if upper else None),
        _cell(lower, float(lower) if lower else None),
        _cell(*_number(len(entry["minima"]) - saddles, 0)),
        _cell(*_number(saddles, 0)),
        _cell(f"{least['met']} of {entry['runs']}", least["met"] / entry["runs"]),
        _cell(_group(least)),
        *(_cell(*_number(least[name], 2)) for name in ("ropelength", "writhe", "average_crossing_number")),
    ]
    return f'<tr data-name="{entry["name"]}">{"".join(cells)}</tr>'


def _knot(entry: Values, before: Values | None, after: Values | None) -> str:
    least, name = entry["minima"][0], entry["name"]
    upper, lower = bounds(entry)
    facts = {
        "Möbius energy": _energy(least),
        "proved: least energy of the type ≤": upper,
        "proved: least energy of the type ≥": lower,
        "at rest": _index(least),
        "symmetry": _group(least),
        "met by": f"{least['met']} of {entry['runs']} runs",
        "ropelength": _number(least["ropelength"], 3)[0],
        "writhe": _number(least["writhe"], 4)[0],
        "average crossing number": _number(least["average_crossing_number"], 4)[0],
    }
    return _KNOT.format(
        name=typeset(name),
        file=name,
        before="<span></span>" if before is None else _link(before["name"], "← "),
        after="<span></span>" if after is None else _link(after["name"], "", " →"),
        picture=_picture(least, "../"),
        facts="".join(f"<div><dt>{term}</dt><dd>{text}</dd></div>" for term, text in facts.items() if text),
        heads="".join(f'<th scope="col">{head}</th>' for head in _KINDS),
        rows="\n".join(_knot_row(entry, minimum) for minimum in entry["minima"]),
        command=escape(least["command"]),
        folder=escape(least["folder"]),
        version=escape(least["version"]),
    )


def _knot_row(entry: Values, minimum: Values) -> str:
    least = entry["minima"][0]["energy"]
    kinds = ", ".join(f"{count} {kind}" for kind, count in minimum["kinds"].items())
    share = round(100 * minimum["met"] / entry["runs"])
    curves = (f'<a href="../{curve_path(entry, minimum, suffix)}">{suffix[1:].upper()}</a>' for suffix in CURVES)
    cells = [
        _picture(minimum, "../", "lazy"),
        _energy(minimum),
        f"{100 * (minimum['energy'] / least - 1):.3f} %" if minimum["number"] > 1 else "",
        _index(minimum),
        f'<span class="bar" style="--share: {share}%">{minimum["met"]}</span>',
        f'<span class="kinds">{escape(kinds)}</span>',
        _group(minimum),
        *(_number(minimum[name], 2)[0] for name in ("ropelength", "writhe", "average_crossing_number")),
        " ".join(curves),
    ]
    return f"<tr>{''.join(map(_cell, cells))}</tr>"


def bounds(entry: Values) -> tuple[str, str]:
    """What is proved of the least energy of a type, from above and from below; empty where nothing is."""
    proved = entry["minima"][0]["proved_energy"]
    return bound(proved and proved[1], math.ceil), bound(entry["lower_bound"], math.floor)


def _group(minimum: Values) -> str:
    """A group's name: D3, C∞v."""
    return re.sub(r"(?<=^[CDS])(\w*)", r"<sub>\1</sub>", minimum["symmetry"])


def typeset(name: str) -> str:
    """A name with its number as an index: 6_2, L6a4."""
    return re.sub(r"_(\d+)", r"<sub>\1</sub>", name)


def _link(name: str, before: str = "", after: str = "") -> str:
    return f'<a href="{name}.html">{before}{typeset(name)}{after}</a>'


def _picture(minimum: Values, root: str, loading: str = "eager") -> str:
    path = minimum["picture"]
    return f'<img src="{root}{path}" alt="" width="640" height="480" loading="{loading}">' if path else ""


def _cell(text: str, value: float | None = None) -> str:
    return f"<td>{text}</td>" if value is None else f'<td data-value="{value:.12g}">{text}</td>'


def _number(value: float | None, decimals: int) -> tuple[str, float | None]:
    return ("", None) if value is None else (f"{round(value, decimals) + 0.0:.{decimals}f}".replace("-", "−"), value)


def _energy(minimum: Values) -> str:
    digits, power = f"{minimum['error']:.0e}".split("e")
    error = f"{digits}·10<sup>{int(power)}</sup>".replace("-", "−")
    return f"{rounded(minimum['energy'], minimum['error'])} <small>± {error}</small>"


def _index(minimum: Values) -> str:
    return f"saddle of index {minimum['index']}" if minimum["index"] else "minimum"
