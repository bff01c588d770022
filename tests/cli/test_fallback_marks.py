"""Steps that another method took are marked in what ``compare`` writes."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import pytest
from mobius_flow.cli.compare import WRITERS
from mobius_flow.core.driver.compare import History

HELPED = History("flow-l2", "stalled", (0.0, 0.1, 0.2, 0.3), (9.0, 8.0, 7.0, 6.5), (1.0, 0.9, 0.8, 0.7), (2, 3))


def test_in_tables(tmp_path: Path) -> None:
    WRITERS[".csv"](tmp_path / "a.csv", [HELPED])
    rows = list(csv.DictReader((tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["fallback"] for row in rows] == ["0", "0", "1", "1"]
    WRITERS[".json"](tmp_path / "a.json", [HELPED])
    assert json.loads((tmp_path / "a.json").read_text())[0]["fallback"] == [2, 3]


def test_in_figures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    axes = pytest.importorskip("matplotlib.axes")
    marked = []
    plot = axes.Axes.plot
    monkeypatch.setattr(axes.Axes, "plot", lambda *a, **k: marked.append(k.get("markevery")) or plot(*a, **k))
    WRITERS[".png"](tmp_path / "a.png", [HELPED, replace(HELPED, fallback=())])
    assert marked == [[2, 3], [2, 3], None, None]
    assert (tmp_path / "a.png").stat().st_size > 1000
