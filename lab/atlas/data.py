"""The data package: tables, curves, and files that describe them, separately and in one archive."""

import io
import json
import math
import zipfile
from collections.abc import Mapping, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from functools import cache
from importlib.resources import files
from importlib.util import find_spec

from ... import __version__
from ...core.io import FORMATS
from ..batch.table import as_csv
from .entries import Values, curve_of
from .folder import Folder

TITLE = "Curves at rest under the Möbius energy"
CURVES = (".json", ".vect")
ARCHIVE = "data/moebius-energy-atlas.zip"
_OUTWARDS = {"upper_bound": ROUND_CEILING, "lower_bound": ROUND_FLOOR, "ropelength_bound": ROUND_CEILING}
_MILLIONTH = Decimal("1e-6")
_FROM = ("number", "modes", "kinds", "version", "command", "folder")  # columns that atlas.csv leaves out
_ABSTRACT = """\
{types} prime knots and links and {minima} smooth curves at which the Möbius energy is stationary, found by
mobius-flow {version} from {runs} relaxations, each of them proved to be an isotopy. Their energies are the least known;
lower ones may exist."""


def write(folder: Folder, entries: Sequence[Values]) -> None:
    """Write the package, file by file and as an archive."""
    rows, short = list[Values](), list[Values]()
    for entry in entries:
        for minimum in entry["minima"]:
            kinds = ", ".join(f"{kind} {count}" for kind, count in minimum["kinds"].items())
            known = entry | minimum | {"kinds": kinds, "modes": " ".join(map(str, minimum["modes"]))}
            rows.append({each["name"]: known[each["name"]] for each in _columns()})
    for row in rows:
        if row["number"] == 1:
            kept = {name: value for name, value in row.items() if name not in _FROM}
            told = {name: f"{value:z.4f}" if isinstance(value, float) else value for name, value in kept.items()}
            energy = {"energy": rounded(row["energy"], row["error"]), "error": f"{row['error']:.0e}"}
            short.append(told | bounds(row) | energy)
    package: dict[str, str | bytes] = {
        "atlas.csv": as_csv(list(short[0]), short, "\n"),
        "minima.csv": as_csv(list(rows[0]), rows, "\n"),
        "atlas.json": _json([entry | {"minima": list(map(_without_curve, entry["minima"]))} for entry in entries]),
        **_descriptions(entries, len(rows)),
    }
    if find_spec("pyarrow"):
        import pyarrow as pa
        import pyarrow.parquet

        types = {"string": pa.string(), "integer": pa.int64(), "number": pa.float64()}
        fields = [pa.field(each["name"], types[each["type"]], metadata=each) for each in _columns()]
        parquet = io.BytesIO()
        pa.parquet.write_table(pa.Table.from_pylist(rows, pa.schema(fields)), parquet)
        package["minima.parquet"] = parquet.getvalue()
    for entry in entries:
        for minimum in entry["minima"]:
            curve = curve_of(minimum)
            polygon = curve.polygon(curve.sizes)
            points = [part.tolist() for part in polygon.components]
            known = {"type": entry["type"]} | _without_curve(minimum) | {"fourier": minimum["fourier"]}
            package[curve_path(entry, minimum, ".json")] = json.dumps(known | {"components": points}) + "\n"
            package[curve_path(entry, minimum, ".vect")] = FORMATS[".vect"].text(polygon)
    for name, data in package.items():
        folder.put(f"data/{name}", data)
    zipped = io.BytesIO()  # equal bytes for equal files: entries have no time of their own
    with zipfile.ZipFile(zipped, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in package.items():
            archive.writestr(zipfile.ZipInfo(f"moebius-energy-atlas/{name}"), data, zipfile.ZIP_DEFLATED)
    folder.put(ARCHIVE, zipped.getvalue())


def curve_path(entry: Mapping[str, str], minimum: Values, suffix: str) -> str:
    """The path of a minimum's curve in the package."""
    return f"curves/{entry['type']}-{minimum['number']}{suffix}"


def _descriptions(entries: Sequence[Values], minima: int) -> dict[str, str]:
    """The files that describe the others."""
    runs = sum(entry["runs"] for entry in entries)
    abstract = _ABSTRACT.format(types=len(entries), minima=minima, runs=runs, version=__version__)
    columns = "\n".join(f"| `{each['name']}` | {each['description']} |" for each in _columns())
    words = {"abstract": abstract, "line": abstract.replace("\n", " "), "version": __version__, "columns": columns}
    package = json.loads(template("datapackage.json")) | {"version": __version__, "description": words["line"]}
    (minima_table,) = package["resources"]
    short = {"fields": [each for each in _columns() if each["name"] not in _FROM]}
    package["resources"].insert(0, minima_table | {"name": "atlas", "path": "atlas.csv", "schema": short})
    filled = {name: template(name).format(**words) for name in ("README.md", "CITATION.cff")}
    return filled | {"datapackage.json": _json(package)}


def template(name: str) -> str:
    """A template of ours, with blanks to fill in."""
    return files(__package__).joinpath("templates", name).read_text(encoding="utf-8")


@cache
def _columns() -> list[dict[str, str]]:
    """The columns of the tables: names, types of Frictionless's table schema, descriptions."""
    fields: list[dict[str, str]] = json.loads(template("datapackage.json"))["resources"][0]["schema"]["fields"]
    return fields


def _without_curve(minimum: Values) -> Values:
    return {name: value for name, value in minimum.items() if name not in ("fourier", "picture")}


def bounds(row: Values) -> dict[str, str]:
    """The proved bounds of a type, to six decimals, rounded outwards; empty where there is none."""
    values = {name: row[name] for name in _OUTWARDS}
    return {k: "" if x is None else str(Decimal(x).quantize(_MILLIONTH, _OUTWARDS[k])) for k, x in values.items()}


def rounded(energy: float, error: float) -> str:
    """An energy to the first decimal of its error, but to nine at most."""
    return f"{energy:.{min(max(-math.floor(math.log10(error)), 0), 9) if error else 9}f}"


def _json(values: object) -> str:
    return json.dumps(values, indent=1, ensure_ascii=False) + "\n"
