"""Signals interrupt the work, not the writing of its results."""

import json
import os
import re
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mobius_flow.cli import main, places, signals
from mobius_flow.core import Curve, Iterate, Result, Trajectory, read_curve, relax, write_curve
from mobius_flow.core.base.deadline import termination_raises
from mobius_flow.core.driver import finish
from mobius_flow.core.proof import verify
from mobius_flow.lab.compare import command as compare_command
from mobius_flow.lab.compare.comparison import History, compare
from shapes import torus_trefoil

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals")
OnIterate = Callable[[Callable[[Iterate], object]], None]
ENDING = [signal.SIGTERM, signal.SIGHUP]  # SIGINT is ignored where tests run in the background


@pytest.fixture(autouse=True)
def defaults() -> Iterator[None]:
    """SIGTERM and SIGHUP as in a terminal, whatever pytest was started from."""
    before = {number: signal.signal(number, signal.SIG_DFL) for number in ENDING}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def send(number: signal.Signals) -> None:
    os.kill(os.getpid(), number)


@pytest.mark.parametrize("number", ENDING)
def test_the_first_signal_raises_and_the_next_wait(number: signal.Signals) -> None:
    with signals.raised():
        with pytest.raises(KeyboardInterrupt):
            send(number)
        send(number)
    assert signal.getsignal(number) is signal.SIG_DFL


def test_held_signals_wait_until_they_are_allowed() -> None:
    with signals.raised():
        signals.hold()
        send(signal.SIGTERM)
        send(signal.SIGTERM)
        with pytest.raises(KeyboardInterrupt):
            signals.allow()
        signals.allow()  # both were one


def test_signals_wait_while_an_iterate_is_recorded() -> None:
    """They interrupt the computation of the next one: what is written ends with one and the same iterate."""
    with signals.raised():
        iterates = signals.interruptible(relax(torus_trefoil(60)))
        next(iterates)
        send(signal.SIGTERM)
        with pytest.raises(KeyboardInterrupt):
            next(iterates)


def test_one_that_comes_later_interrupts_again(monkeypatch: pytest.MonkeyPatch) -> None:
    with signals.raised():
        with pytest.raises(KeyboardInterrupt):
            send(signal.SIGTERM)
        monkeypatch.setattr(signals, "_TOGETHER", 0.0)
        signals.allow()
        with pytest.raises(KeyboardInterrupt):
            send(signal.SIGTERM)


def test_ignored_signals_stay_ignored() -> None:
    signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    with signals.raised():
        send(signal.SIGHUP)
    assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN


@pytest.mark.parametrize("number", ENDING)
def test_termination_raises_what_is_wanted(number: signal.Signals) -> None:
    with pytest.raises(SystemExit), termination_raises(SystemExit(143)):
        send(number)
    assert signal.getsignal(number) is signal.SIG_DFL


@pytest.fixture
def command(tmp_path: Path) -> list[str]:
    write_curve(tmp_path / "trefoil.txt", torus_trefoil(60))
    names = [str(tmp_path / name) for name in ("trefoil.txt", "o.txt", "r.json", "t.npz")]
    return [
        "relax",
        *names[:2],
        "--report",
        names[2],
        "--trajectory",
        names[3],
        "--vertices",
        "60",
        "--method",
        "flow-l2",
    ]


def check_results(room: Path, status: str) -> None:
    assert json.loads((room / "r.json").read_text())["status"] == status
    assert verify(room / "t.npz").accepted
    with np.load(room / "t.npz") as archive:
        assert np.array_equal(archive["stage_000"][-1], read_curve(room / "o.txt").vertices)
    assert sorted(os.listdir(room)) == ["o.txt", "r.json", "t.npz", "trefoil.txt"]


@pytest.mark.parametrize("number", ENDING)
def test_signals_while_results_are_written_cost_nothing(
    command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, on_iterate: OnIterate, number: signal.Signals
) -> None:
    """Two at once in the run, and more while the trajectory is written."""
    save = Trajectory.save

    def interrupted(iterate: Iterate) -> None:
        if iterate.index == 3:
            send(number)
            send(signal.SIGTERM)

    def interrupted_save(self: Trajectory, path: str) -> None:
        send(number)
        save(self, path)
        send(number)

    on_iterate(interrupted)
    monkeypatch.setattr(Trajectory, "save", interrupted_save)
    monkeypatch.setattr(signals, "_TOGETHER", 0.0)
    assert main([*command, "--max-iterations", "1000000"]) == 130
    check_results(tmp_path, "interrupted")


@pytest.fixture
def interrupted_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """A signal comes after the last step, before the results are written."""

    def interrupted(*arguments: Any) -> Result:
        result = finish(*arguments)
        send(signal.SIGTERM)
        return result

    monkeypatch.setattr("mobius_flow.cli.relax.finish", interrupted)


@pytest.mark.usefixtures("interrupted_at_the_end")
def test_a_signal_after_the_last_step_costs_nothing(
    command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*command, "--max-iterations", "3"]) == 130
    check_results(tmp_path, "iteration_limit")
    assert capsys.readouterr().err == "mobius-flow: interrupted\n"


@pytest.mark.usefixtures("interrupted_at_the_end")
def test_files_come_before_streams_that_may_be_interrupted(command: list[str], tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    reader = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    command[4] = str(tmp_path / "pipe")
    assert main([*command, "--max-iterations", "3"]) == 130
    assert os.read(reader, 100) == b""
    os.close(reader)
    assert len(read_curve(tmp_path / "o.txt")) == 60
    assert verify(tmp_path / "t.npz").accepted


@pytest.mark.parametrize("before", [False, True])
def test_a_film_can_be_interrupted_and_the_curve_is_kept(
    command: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    on_iterate: OnIterate,
    capsys: pytest.CaptureFixture[str],
    before: bool,
) -> None:
    """Also that of a run which was interrupted itself."""

    def interrupted(iterate: Iterate) -> None:
        if before and iterate.index == 2:
            send(signal.SIGTERM)

    def film(path: str, *_arguments: object) -> None:
        send(signal.SIGTERM)
        Path(path).write_text("too late")

    on_iterate(interrupted)
    monkeypatch.setattr(signals, "_TOGETHER", 0.0)
    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    monkeypatch.setattr(places.export, "write_movie", film)
    command[2] = str(tmp_path / "film.mp4")
    assert main([*command, "--max-iterations", "3"]) == 130
    assert sorted(os.listdir(tmp_path)) == ["r.json", "t.npz", "trefoil.txt"]
    assert json.loads((tmp_path / "r.json").read_text())["iterations"] == (2 if before else 3)
    said = capsys.readouterr().err
    kept = re.fullmatch(
        r"mobius-flow: interrupted: .*film.mp4 is not written \(the result is kept as (.*obj)\)\n", said
    )
    assert kept is not None, said
    assert len(read_curve(kept[1])) == 60


def test_an_interrupt_while_a_report_is_written_keeps_the_curve_of_a_film_that_is_not_begun(
    command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    save = Trajectory.save

    def interrupted_save(self: Trajectory, path: str) -> None:
        send(signal.SIGTERM)
        save(self, path)

    def film(path: str, *_arguments: object) -> None:
        Path(path).write_text("a film")

    monkeypatch.setattr(Trajectory, "save", interrupted_save)
    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    monkeypatch.setattr(places.export, "write_movie", film)
    command[2] = str(tmp_path / "film.mp4")
    assert main([*command, "--max-iterations", "3"]) == 130
    assert sorted(os.listdir(tmp_path)) == ["r.json", "t.npz", "trefoil.txt"]
    assert "kept as" in capsys.readouterr().err


def test_memory_that_runs_out_keeps_the_curve(
    command: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    on_iterate: OnIterate,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def failing(iterate: Iterate) -> None:
        if iterate.index == 3:
            raise MemoryError

    on_iterate(failing)
    assert main([*command, "--max-iterations", "9"]) == 1
    check_results(tmp_path, "stalled")
    assert "memory ran out" in capsys.readouterr().err


@pytest.mark.parametrize(("memory", "status", "said"), [(False, 130, "interrupted"), (True, 1, "not enough memory")])
def test_compare_keeps_the_methods_that_are_done(
    command: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    memory: bool,
    status: int,
    said: str,
) -> None:
    def interrupted(curve: Curve, methods: list[str], *more: Any) -> Iterator[History]:
        yield from compare(curve, methods[:1], *more)
        if memory:
            raise MemoryError
        send(signal.SIGTERM)

    monkeypatch.setattr(compare_command, "compared", interrupted)
    table = tmp_path / "c.json"
    words = ["compare", command[1], "--methods", "cg,lbfgs", "--max-iterations", "2", "-o", str(table)]
    assert main(words) == status
    assert [run["method"] for run in json.loads(table.read_text())] == ["cg"]
    assert said in capsys.readouterr().err.splitlines()[-1]
