"""Draw docs/pictures/speed.png from figures of benchmarks/speed.py --json.

python benchmarks/speed.py --solver dense --sizes 200,592,1000,2000,5000 --json > dense.json
python benchmarks/speed.py --solver hierarchical --sizes 200,1000,5000,20000 --json > hierarchical.json
python tools/speed_picture.py dense.json hierarchical.json docs/pictures/speed.png
"""

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

PARTS = ("derivative", "metric", "gradient", "retract", "proof")  # the energy by itself and lists are parts of others
COLOURS = {"dense": "C3", "hierarchical": "C0"}
Row = Mapping[str, Any]


def curve(axes: Axes, rows: Sequence[Row], y: Sequence[float], **style: Any) -> None:
    """One figure of all sizes."""
    axes.plot([row["vertices"] for row in rows], y, **style)


def overview(times: Axes, memory: Axes, by_solver: Mapping[str, Sequence[Row]]) -> None:
    """Whole iterations, and memory, of each solver."""
    for solver, rows in by_solver.items():
        style = {"label": solver, "color": COLOURS[solver], "marker": "o"}
        curve(times, rows, [row["seconds"]["iteration"] for row in rows], **style)
        curve(memory, rows, [row["peak_bytes"] / 1e6 for row in rows], **style)
    times.set(title="one iteration", ylabel="seconds of processor time")
    memory.set(title="memory", ylabel="MB")


def phases(axes: Axes, solver: str, rows: Sequence[Row]) -> None:
    """The parts of a step by one solver."""
    for number, name in enumerate(PARTS):
        style = {"label": name, "color": f"C{number}", "marker": "."}
        curve(axes, rows, [row["seconds"][name] for row in rows], **style)
    axes.set(title=f"phases of a step, {solver}", xlabel="vertices", ylabel="seconds of processor time")


def drawn(rows: Sequence[Row]) -> Figure:
    """The figure: iterations and memory above, the phases of both solvers below."""
    by_size = sorted(rows, key=lambda row: int(row["vertices"]))
    by_solver = {solver: [row for row in by_size if row["solver"] == solver] for solver in COLOURS}
    figure = Figure(figsize=(10, 7.5), layout="constrained")
    above, below = figure.subplots(2, 2, sharex=True)
    overview(*above, by_solver)
    for axes, (solver, own) in zip(below, by_solver.items(), strict=True):
        phases(axes, solver, own)
    below[1].sharey(below[0])
    for axes in (*above, *below):
        axes.set(xscale="log", yscale="log")
        axes.grid(alpha=0.3)
        axes.legend()
    return figure


def main() -> None:
    """Read, draw, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("figures", nargs="+", type=Path, metavar="IN.json")
    parser.add_argument("picture", type=Path, metavar="OUT.png")
    options = parser.parse_args()
    rows = [row for path in options.figures for row in json.loads(path.read_text(encoding="utf-8"))["rows"]]
    drawn(rows).savefig(options.picture, dpi=110)


if __name__ == "__main__":
    main()
