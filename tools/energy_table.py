"""Write results of batches into the table of least energies in docs/least-energies.md.

    mobius-flow batch 0_1..10_165 L2a1..L7n2 -o results --extrapolate --escape-saddles
    python tools/energy_table.py results/results.csv [MORE.csv ...]

The table stands after ``<!-- table: least energies -->`` in the page.  What it has is kept where no run is better: the
lower of two energies counts, or the one with the smaller error if they are equal within their errors.
"""

import csv
import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

PAGE = Path(__file__).resolve().parents[1] / "docs" / "least-energies.md"
_REGION = re.compile(r"(?<=<!-- table: least energies -->\n).*?(?=<!-- end -->)", re.DOTALL)
_CELL = re.compile(r"(\w+) \| ([\d.]+) ± ([\d.]+) \| (\d+)")
_COLUMNS = 3  # of types, beside each other


class Least(NamedTuple):
    """The energy that a run ended with, extrapolated to the smooth curve."""

    name: str
    energy: float
    error: float
    index: int

    def or_better(self, other: "Least") -> "Least":
        """The better one of two of the same type."""
        if abs(self.energy - other.energy) <= self.error + other.error:
            return min(self, other, key=lambda each: each.error)
        return min(self, other, key=lambda each: each.energy)


def proved(rows: Iterable[dict[str, str]]) -> Iterator[Least]:
    """The rows of a batch that are certified and verified and end as what they began, with an extrapolated energy."""
    for row in rows:
        whole = row["certified"] == row["verified"] == "True" and row["type_before"] == row["type_after"]
        if whole and row["extrapolated_energy"]:
            energy, error = float(row["extrapolated_energy"]), float(row["extrapolated_energy_error"])
            yield Least(row["name"], energy, max(error, 5e-4), int(row["index"]))


def written(page: str) -> Iterator[Least]:
    """What the page has."""
    for name, energy, error, index in _CELL.findall(_REGION.search(page)[0]):
        yield Least(name, float(energy), float(error), int(index))


def table(found: Iterable[Least]) -> str:
    """The best of each type in Markdown, by energy, several types in a line, in columns."""
    best: dict[str, Least] = {}
    for one in found:
        best[one.name] = one.or_better(best.get(one.name, one))
    ordered = sorted(best.values(), key=lambda each: each.energy)
    cells = [f"{each.name} | {each.energy:.3f} ± {each.error:.3f} | {each.index}" for each in ordered]
    height = -(-len(cells) // _COLUMNS)
    cells += [" | | "] * (_COLUMNS * height - len(cells))
    lines = [" | ".join(cells[k::height]) for k in range(height)]
    head = " | ".join(["type | energy | index"] * _COLUMNS)
    rule = " | ".join(["--- | --- | ---"] * _COLUMNS)
    return "".join(f"| {line} |\n" for line in [head, rule, *lines])


def main() -> None:
    """Rewrite the table."""
    page = PAGE.read_text(encoding="utf-8")
    files = (csv.DictReader(Path(path).read_text("utf-8").splitlines(True)) for path in sys.argv[1:])
    found = [*written(page), *(least for rows in files for least in proved(rows))]
    PAGE.write_text(_REGION.sub(lambda _: f"\n{table(found)}\n", page), encoding="utf-8")


if __name__ == "__main__":
    main()
