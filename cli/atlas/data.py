"""The package of data: tables, curves, and files that describe them."""

import csv
import io
import json
import math
from collections.abc import Callable, Mapping, Sequence
from importlib.util import find_spec

from ... import __version__
from ...core.curve.io import FORMATS
from .entries import Values, curve_of
from .folder import Folder

CURVES = (".vect", ".json")
# of the tables: names, types of Frictionless's table schema, descriptions
COLUMNS = (
    ("type", "string", "knot or link, by its number in KnotInfo; links as in the table of Thistlethwaite"),
    ("number", "integer", "of the curve at rest, by energy; 1 is the least known"),
    ("energy", "number", "Möbius energy of the smooth curve, 4 for the circle"),
    ("error", "number", "how far that may be off: what fewer modes and fewer points change"),
    ("upper_bound", "number", "of that energy, and so of the least of the type; proved, as is the type; or empty"),
    ("lower_bound", "number", "of all curves of the type: 4, 6π + 4 or 2πc + 4 with c crossings; empty for links"),
    ("index", "integer", "independent directions in which the energy falls: 0 at a minimum, more at a saddle"),
    ("met", "integer", "runs that ended there"),
    ("runs", "integer", "all runs that ended as this type"),
    ("symmetry", "string", "group of the Möbius image that bends least, after Schoenflies"),
    ("ropelength", "number", "length over thickness of that image"),
    ("writhe", "number", "of that image"),
    ("average_crossing_number", "number", "of that image"),
    ("modes", "string", "frequencies of its Fourier series, by component"),
    ("kinds", "string", "of starts that led there, with their numbers"),
    ("version", "string", "of mobius-flow, that found it"),
    ("command", "string", "that finds it again, and records a proved way to it in the folder named"),
    ("folder", "string", "of the run within results"),
)
FROM = ("number", "modes", "kinds", "version", "command", "folder")  # which atlas.csv leaves out
SHORT = [name for name, _, _ in COLUMNS if name not in FROM]
_README = """\
# Curves at rest under the Möbius energy

{types} knots and links and {minima} curves at which the Möbius energy is stationary, found by mobius-flow {version}
from {runs} relaxations, each of them proved to be an isotopy. The energies are those of smooth curves; they are upper
bounds of the least energies up to their errors, and no more than that.

| file | |
| --- | --- |
| `atlas.csv` | the curve of least energy of each type, in short: rounded, and without where it comes from |
| `minima.csv`, `minima.parquet` | all curves at rest that were met |
| `atlas.json` | the same, with all that is known |
| `fourier/` | their Fourier coefficients: a component is t ↦ Re Σₖ cₖ exp(2πikt), 0 ≤ t < 1; real and imaginary parts |
| `curves/` | polygons inscribed in them, as Geomview VECT and as JSON |

Curves are balanced: of all Möbius images, whose energies are equal, they bend least. Handedness is that of the table of
mobius-flow, where 3_1 is right-handed.

| column | |
| --- | --- |
{columns}
"""
_CITATION = """\
cff-version: 1.2.0
message: "If you use these data, please cite them and the program."
type: dataset
title: "Curves at rest under the Möbius energy"
version: {version}
authors:
  - name: "The Möbius Flow authors"
references:
  - type: software
    title: "Möbius Flow"
    version: {version}
    authors:
      - name: "The Möbius Flow authors"
"""


def write(folder: Folder, entries: Sequence[Values]) -> None:
    """Write all but the Fourier series, which entries are."""
    rows = [_row(entry, minimum) for entry in entries for minimum in entry["minima"]]
    for entry in entries:
        for minimum in entry["minima"]:
            curve = curve_of(minimum)
            for suffix in CURVES:
                folder.put(curve_path(entry, minimum, suffix), FORMATS[suffix].text(curve.polygon(curve.sizes)))
    bare = [{**entry, "minima": [_without_curve(each) for each in entry["minima"]]} for entry in entries]
    folder.put("data/atlas.json", json.dumps(bare, indent=1, ensure_ascii=False) + "\n")
    folder.put("data/atlas.csv", _csv([_short(row) for row in rows if row["number"] == 1]))
    folder.put("data/minima.csv", _csv(rows))
    if find_spec("pyarrow"):
        folder.put("data/minima.parquet", _parquet(rows))
    columns = "\n".join(f"| `{name}` | {text} |" for name, _, text in COLUMNS)
    counts = {"types": len(entries), "minima": len(rows), "runs": sum(entry["runs"] for entry in entries)}
    folder.put("data/README.md", _README.format(columns=columns, version=__version__, **counts))
    folder.put("data/CITATION.cff", _CITATION.format(version=__version__))
    fields = [{"name": name, "type": kind, "description": text} for name, kind, text in COLUMNS]
    tables = [
        {"name": name, "path": f"{name}.csv", "schema": {"fields": known}, "profile": "tabular-data-resource"}
        for name, known in (("atlas", [field for field in fields if field["name"] in SHORT]), ("minima", fields))
    ]
    package = {"name": "moebius-energy-atlas", "title": "Curves at rest under the Möbius energy", "resources": tables}
    folder.put("data/datapackage.json", json.dumps(package, indent=1, ensure_ascii=False) + "\n")


def curve_path(entry: Mapping[str, str], minimum: Values, suffix: str) -> str:
    """The path of a minimum's polygon."""
    return f"data/curves/{entry['name']}-{minimum['number']}{suffix}"


def _row(entry: Values, minimum: Values) -> Values:
    """A row of the tables."""
    kinds = ", ".join(f"{kind} {count}" for kind, count in minimum["kinds"].items())
    modes = " ".join(map(str, minimum["modes"]))
    upper = minimum["proved_energy"] and minimum["proved_energy"][1]
    known = entry | minimum | {"type": entry["name"], "kinds": kinds, "modes": modes, "upper_bound": upper}
    return {name: known[name] for name, _, _ in COLUMNS}


def _without_curve(minimum: Values) -> Values:
    return {name: value for name, value in minimum.items() if name not in ("coefficients", "picture")}


def _short(row: Values) -> Values:
    short = {name: f"{row[name]:.4f}" if isinstance(row[name], float) else row[name] for name in SHORT}
    short |= {"upper_bound": bound(row["upper_bound"], math.ceil), "lower_bound": bound(row["lower_bound"], math.floor)}
    return short | {"energy": rounded(row["energy"], row["error"]), "error": f"{row['error']:.0e}"}


def bound(value: float | None, towards: Callable[[float], int]) -> str:
    """A bound to six decimals, which is one still."""
    return "" if value is None else f"{towards(1e6 * value) / 1e6:.6f}"


def rounded(energy: float, error: float) -> str:
    """An energy to the first decimal of its error, but for more than nine."""
    return f"{energy:.{min(max(-math.floor(math.log10(error)), 0), 9) if error else 9}f}"


def _csv(rows: Sequence[Values]) -> str:
    stream = io.StringIO(newline="")
    writer = csv.DictWriter(stream, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return stream.getvalue()


def _parquet(rows: Sequence[Values]) -> bytes:
    import pyarrow as pa
    import pyarrow.parquet

    kinds = {"string": pa.string(), "integer": pa.int64(), "number": pa.float64()}
    stream = io.BytesIO()
    pa.parquet.write_table(pa.Table.from_pylist(rows, pa.schema([(n, kinds[k]) for n, k, _ in COLUMNS])), stream)
    return stream.getvalue()
