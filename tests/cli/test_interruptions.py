"""Runs that are interrupted keep the best curve; processes that are killed leave no half-written file."""

import json
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.cli import main
from mobius_flow.core import Iterate, RelaxOptions, Result, Task, read_curve, write_curve
from mobius_flow.core.driver import Relaxation, finish
from mobius_flow.core.proof import verify
from processes import finished, running
from shapes import regular_polygon, torus_trefoil

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals")

ENDLESS = ["--tolerance", "1e-30", "--vertices", "120", "--method", "flow-l2", "--max-iterations", "1000000"]
TALKATIVE = """
import sys
from contextlib import nullcontext
from mobius_flow.cli import main, relax
relax.progress = lambda *_: nullcontext(lambda iterate: iterate.index == 2 and print("running", flush=True))
sys.exit(main(sys.argv[1:]))
"""


@pytest.fixture
def trefoil(tmp_path: Path) -> Path:
    path = tmp_path / "trefoil.txt"
    write_curve(path, torus_trefoil(60))
    return path


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_keeps_curve_report_and_trajectory(trefoil: Path, tmp_path: Path, number: signal.Signals) -> None:
    out, report, trajectory = tmp_path / "o.txt", tmp_path / "r.json", tmp_path / "t.npz"
    arguments = ["relax", trefoil, out, "--report", report, "--trajectory", trajectory, *ENDLESS]
    command = [sys.executable, "-c", TALKATIVE, *map(str, arguments)]
    with running(command) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "running\n"
        process.send_signal(number)
        _, error = process.communicate()
    assert process.returncode == 130
    assert error.startswith("✗ interrupted")
    assert "\n  reason      the curve reached so far is kept\n" in error
    assert json.loads(report.read_text())["status"] == "interrupted"
    verdict = verify(trajectory)
    assert verdict.accepted
    assert verdict.legs >= 2
    with np.load(trajectory) as archive:
        assert np.array_equal(archive["stage_000"][-1], read_curve(out).vertices)
    assert sorted(os.listdir(tmp_path)) == ["o.txt", "r.json", "t.npz", "trefoil.txt"]


def test_an_interrupt_while_an_iterate_is_recorded(
    trefoil: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Curve and trajectory end with the same frame."""
    out, trajectory = tmp_path / "o.txt", tmp_path / "t.npz"

    def interrupting(
        relaxation: Relaxation, task: Task, options: RelaxOptions, callback: Callable[[Iterate], None]
    ) -> Result:
        def wrapped(iterate: Iterate) -> None:
            callback(iterate)
            if iterate.index == 3:
                raise KeyboardInterrupt

        return finish(relaxation, task, options, wrapped)

    monkeypatch.setattr("mobius_flow.cli.relax.finish", interrupting)
    assert main(["relax", str(trefoil), str(out), "--trajectory", str(trajectory), "--quiet", *ENDLESS]) == 130
    with np.load(trajectory) as archive:
        assert len(archive["stage_000"]) >= 4
        assert np.array_equal(archive["stage_000"][-1], read_curve(out).vertices)
    assert verify(trajectory).accepted


def test_the_handler_is_put_back(trefoil: Path) -> None:
    before = signal.getsignal(signal.SIGTERM)
    assert main(["energy", str(trefoil)]) == 0
    assert signal.getsignal(signal.SIGTERM) is before


KILLED_WRITES = """
import os, signal, sys, time
from mobius_flow.cli.relax import _write_report
from mobius_flow.core import Trajectory, RelaxOptions, minimize, read_curve, relax, write_curve
source, room = sys.argv[1:]
curve = read_curve(source)
trajectory = Trajectory()
for iterate in relax(curve, RelaxOptions(vertices=len(curve), max_iterations=2, edge_lengths="keep")):
    trajectory.add(iterate)
result = minimize(curve, RelaxOptions(vertices=len(curve), max_iterations=0))
writers = {name: lambda path: write_curve(path, curve) for name in ("a.txt", "a.obj", "a.vect", "a.json")}
writers |= {"r.json": lambda path: _write_report(result, {}, path), "t.npz": trajectory.save}
for k, pause in enumerate((0.0007, 0.0053, 0.0111)):
    for name, write in writers.items():
        path = f"{room}/{k}-{name}"
        write(path)
        child = os.fork()
        while not child:
            write(path)
        time.sleep(pause)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
"""


def test_a_kill_while_writing_leaves_a_whole_file(tmp_path: Path) -> None:
    """Processes write the same file over and over, and are killed at odd moments."""
    source, room, curve = tmp_path / "source.txt", tmp_path / "room", regular_polygon(300)
    write_curve(source, curve)
    room.mkdir()
    done = finished([sys.executable, "-c", KILLED_WRITES, str(source), str(room)])
    assert done.returncode == 0, done.stderr
    written = [path for path in room.iterdir() if path.name[0] in "012"]
    assert len(written) == 18
    for path in written:
        if path.name.endswith("r.json"):
            assert json.loads(path.read_text())["vertices"] == len(curve)
        elif path.name.endswith(".npz"):
            assert verify(path).accepted
        else:
            assert np.array_equal(read_curve(path).vertices, curve.vertices)
