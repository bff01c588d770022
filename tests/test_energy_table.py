"""The table of least energies: what batches find goes in where it is better."""

import runpy
from pathlib import Path

TOOL = runpy.run_path(str(Path(__file__).parents[1] / "tools" / "energy_table.py"))
ROW = {"certified": "True", "verified": "True", "type_before": "4_1", "type_after": "4_1", "name": "4_1", "index": "0"}


def test_the_page_is_what_the_tool_writes() -> None:
    page = TOOL["PAGE"].read_text(encoding="utf-8")
    assert TOOL["table"](TOOL["written"](page)) in page


def test_lower_energies_and_smaller_errors_count() -> None:
    least = TOOL["Least"]
    doubtful, certain, lower = least("4_1", 108.7, 0.3, 0), least("4_1", 108.82, 0.01, 0), least("4_1", 108.0, 0.1, 0)
    assert doubtful.or_better(certain) == certain.or_better(doubtful) == certain
    assert certain.or_better(lower) == lower.or_better(certain) == lower


def test_only_what_is_proved_goes_in() -> None:
    row = ROW | {"extrapolated_energy": "108.8", "extrapolated_energy_error": "1e-5"}
    assert [(each.name, each.error) for each in TOOL["proved"]([row])] == [("4_1", 5e-4)]
    for bad in ({"verified": "False"}, {"type_after": "0_1"}, {"extrapolated_energy": ""}):
        assert not list(TOOL["proved"]([row | bad]))
