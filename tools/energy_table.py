"""Write the table of least energies in docs/energies.md from the results of a batch.

    mobius-flow batch 0_1..10_165 L2a1..L7n2 -o results --extrapolate --escape-saddles
    python tools/energy_table.py results/results.csv [MORE.csv ...]

Of several runs of a type the lowest counts.  The table stands after ``<!-- table: least energies -->`` in the page.
"""

import csv
import re
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

PAGE = Path(__file__).resolve().parents[1] / "docs" / "energies.md"
_REGION = re.compile(r"(?<=<!-- table: least energies -->\n).*?(?=<!-- end -->)", re.DOTALL)
_COLUMNS = 3  # of types, beside each other

Row = Mapping[str, str]


def least(rows: Iterable[Row]) -> list[Row]:
    """The lowest proved row of each type with an extrapolated energy, by energy."""
    best: dict[str, Row] = {}
    for row in rows:
        proved = row["certified"] == row["verified"] == "True" and row["type_before"] == row["type_after"]
        if proved and row["extrapolated_energy"]:
            best[row["name"]] = min(best.get(row["name"], row), row, key=_energy)
    return sorted(best.values(), key=_energy)


def table(rows: list[Row]) -> str:
    """The rows in Markdown, several types in a line, in columns."""
    cells = [f"{row['name']} | {_with_error(row)} | {row['index']}" for row in rows]
    height = -(-len(cells) // _COLUMNS)
    cells += [" | | "] * (_COLUMNS * height - len(cells))
    lines = [" | ".join(cells[k::height]) for k in range(height)]
    head = " | ".join(["type | energy | index"] * _COLUMNS)
    rule = " | ".join(["--- | --- | ---"] * _COLUMNS)
    return "".join(f"| {line} |\n" for line in [head, rule, *lines])


def _energy(row: Row) -> float:
    return float(row["extrapolated_energy"])


def _with_error(row: Row) -> str:
    return f"{_energy(row):.3f} ± {max(float(row['extrapolated_energy_error']), 5e-4):.3f}"


def main() -> None:
    """Rewrite the table."""
    rows = least(row for path in sys.argv[1:] for row in csv.DictReader(Path(path).read_text("utf-8").splitlines(True)))
    page = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(_REGION.sub(lambda _: f"\n{table(rows)}\n", page), encoding="utf-8")
    print(f"{len(rows)} types")


if __name__ == "__main__":
    main()
