"""Signals interrupt the work, not the writing of its results; processes that are killed leave no half-written file."""

import json
import os
import re
import signal
import sys
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.cli import places, signals
from mobius_flow.core import Trajectory, read_curve, relax
from mobius_flow.core.base.deadline import termination_raises
from mobius_flow.core.driver import finish
from mobius_flow.core.proof import verify
from mobius_flow.lab.compare import command as compare_command
from mobius_flow.lab.compare.comparison import compare
from processes import running
from shapes import torus_trefoil

pytestmark = [pytest.mark.skipif(os.name != "posix", reason="signals"), pytest.mark.usefixtures("room")]
BOTH = pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])  # SIGINT is ignored in background jobs
COMMAND = ["relax", "trefoil.txt", "o.txt", "--report", "r.json", "--trajectory", "t.npz", "--vertices", "60"]
COMMAND += ["--method", "flow-l2"]
ENDLESS = ["--tolerance", "1e-30", "--max-iterations", "1000000"]
FILM = [*COMMAND[:2], "film.mp4", *COMMAND[3:], "--max-iterations", "3"]


@BOTH
def test_the_first_signal_raises_and_the_next_wait(number, terminated):
    with signals.raised():
        with pytest.raises(KeyboardInterrupt):
            terminated(number)
        terminated(number)
    assert signal.getsignal(number) is signal.SIG_DFL


def test_held_signals_wait_until_they_are_allowed(terminated):
    with signals.raised():
        signals.hold()
        terminated()
        terminated()
        with pytest.raises(KeyboardInterrupt):
            signals.allow()
        signals.allow()  # both were one


def test_signals_wait_while_an_iterate_is_recorded(terminated):
    """They interrupt the computation of the next one: what is written ends with one and the same iterate."""
    with signals.raised():
        iterates = signals.interruptible(relax(torus_trefoil(60)))
        next(iterates)
        terminated()
        with pytest.raises(KeyboardInterrupt):
            next(iterates)


def test_one_that_comes_later_interrupts_again(terminated, monkeypatch):
    with signals.raised():
        with pytest.raises(KeyboardInterrupt):
            terminated()
        monkeypatch.setattr(signals._State, "together", 0.0)
        signals.allow()
        with pytest.raises(KeyboardInterrupt):
            terminated()


def test_ignored_signals_stay_ignored(terminated):
    signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    with signals.raised():
        terminated(signal.SIGHUP)
    assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN


@BOTH
def test_termination_raises_what_is_wanted(number, terminated):
    with pytest.raises(SystemExit), termination_raises(SystemExit(143)):
        terminated(number)
    assert signal.getsignal(number) is signal.SIG_DFL


def check_results(status):
    """Curve and trajectory end with the same frame, and all is as it should be."""
    assert json.loads(Path("r.json").read_text())["status"] == status
    assert verify("t.npz").accepted
    with np.load("t.npz") as archive:
        assert np.array_equal(archive["stage_000"][-1], read_curve("o.txt").vertices)
    assert sorted(os.listdir()) == ["o.txt", "r.json", "t.npz", "trefoil.txt"]


TALKATIVE = """
import sys
from contextlib import nullcontext
from mobius_flow.cli import main, relax
relax.progress = lambda *_: nullcontext(lambda iterate: iterate.index == 2 and print("running", flush=True))
sys.exit(main(sys.argv[1:]))
"""


def test_a_signal_keeps_curve_report_and_trajectory():
    with running([sys.executable, "-c", TALKATIVE, *COMMAND, *ENDLESS]) as process:
        assert process.stdout.readline() == "running\n"
        process.send_signal(signal.SIGINT)
        _, error = process.communicate()
    assert process.returncode == 130
    assert error.startswith("✗ interrupted")
    assert "\n  reason      the curve reached so far is kept\n" in error
    check_results("interrupted")


@BOTH
def test_signals_while_results_are_written_cost_nothing(number, terminated, on_iterate, monkeypatch, run):
    save = Trajectory.save

    def interrupted(iterate):
        if iterate.index == 3:
            terminated(number)
            terminated()

    def interrupted_save(self, path):
        terminated(number)
        save(self, path)
        terminated(number)

    on_iterate(interrupted)
    monkeypatch.setattr(Trajectory, "save", interrupted_save)
    monkeypatch.setattr(signals._State, "together", 0.0)
    assert run(*COMMAND, *ENDLESS)[0] == 130
    check_results("interrupted")


@pytest.fixture
def interrupted_at_the_end(terminated, monkeypatch):
    """A signal comes after the last step, before the results are written."""

    def interrupted(*arguments):
        result = finish(*arguments)
        terminated()
        return result

    monkeypatch.setattr("mobius_flow.cli.relax.finish", interrupted)


@pytest.mark.usefixtures("interrupted_at_the_end")
def test_a_signal_after_the_last_step_costs_nothing(run):
    assert run(*COMMAND, "--max-iterations", 3) == (130, "", "mobius-flow: interrupted\n")
    check_results("iteration_limit")


@pytest.mark.parametrize("when", ["in the film", "in the run, too", "by Blender", "while the trajectory is written"])
def test_a_film_can_be_interrupted_and_the_curve_is_kept(when, terminated, monkeypatch, on_iterate, run):
    save = Trajectory.save

    def interrupted(iterate):
        if when == "in the run, too" and iterate.index == 2:
            terminated()

    def interrupted_save(self, path):
        if when == "while the trajectory is written":
            terminated()
        save(self, path)

    def film(path, *_):
        if when == "by Blender":
            raise KeyboardInterrupt
        assert when != "while the trajectory is written", "it is not begun"
        terminated()
        Path(path).write_text("too late")

    on_iterate(interrupted)
    monkeypatch.setattr(Trajectory, "save", interrupted_save)
    monkeypatch.setattr(signals._State, "together", 0.0)
    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    monkeypatch.setattr(places.export, "write_movie", film)
    status, _, said = run(*FILM)
    assert status == 130
    assert sorted(os.listdir()) == ["r.json", "t.npz", "trefoil.txt"]
    assert json.loads(Path("r.json").read_text())["iterations"] == (2 if when == "in the run, too" else 3)
    kept = re.fullmatch(
        r"mobius-flow: interrupted: .*film.mp4 is not written \(the result is kept as (.*obj)\)\n", said
    )
    assert kept is not None, said
    assert len(read_curve(kept[1])) == 60


@pytest.mark.usefixtures("interrupted_at_the_end")
def test_of_a_film_that_is_not_begun_the_curve_is_kept(monkeypatch, run):
    """As the signal has ended what was written to a pipe before."""
    os.mkfifo("pipe")
    reader = os.open("pipe", os.O_RDONLY | os.O_NONBLOCK)
    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    monkeypatch.setattr(places.export, "write_movie", lambda *_: pytest.fail("it is begun"))
    status, _, said = run(*FILM[:4], "pipe", *FILM[5:])
    os.close(reader)
    assert status == 130
    (kept,) = re.findall(r"film\.mp4 is not written \(the result is kept as (.*?)\)", said)
    assert len(read_curve(kept)) == 60


def test_memory_that_runs_out_keeps_the_curve(on_iterate, run):
    def failing(iterate):
        if iterate.index == 3:
            raise MemoryError

    on_iterate(failing)
    status, _, said = run(*COMMAND, "--max-iterations", 9)
    assert status == 1
    assert "memory ran out" in said
    check_results("stalled")


@pytest.mark.parametrize(("memory", "status", "said"), [(False, 130, "interrupted"), (True, 1, "not enough memory")])
def test_compare_keeps_the_methods_that_are_done(memory, status, said, terminated, monkeypatch, run):
    def interrupted(curve, methods, *more):
        yield from compare(curve, methods[:1], *more)
        if memory:
            raise MemoryError
        terminated()

    monkeypatch.setattr(compare_command, "compared", interrupted)
    found = run(*["compare", "trefoil.txt", "--methods", "cg,lbfgs", "--max-iterations", "2", "-o", "c.json"])
    assert found[0] == status
    assert said in found[2].splitlines()[-1]
    assert [run["method"] for run in json.loads(Path("c.json").read_text())] == ["cg"]
