"""The line that tells what is going on, and what commands say in the end, on a terminal and elsewhere."""

import io
import sys
from types import SimpleNamespace

import pytest
from mobius_flow.cli import progress as module
from mobius_flow.cli.progress import live, progress
from mobius_flow.cli.terminal import digits, painted, report, sentence, table
from mobius_flow.core import RelaxOptions, minimize, tighten
from shapes import torus_trefoil


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def terminal(monkeypatch):
    """A terminal of 40 columns, in which every line is seen."""
    for name in ("NO_COLOR", "FORCE_COLOR", "TERM"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("COLUMNS", "40")
    monkeypatch.setattr(module, "_PAUSE", 0.0)
    return Terminal()


def test_a_run_is_shown_by_what_is_known_of_it(terminal, monkeypatch):
    """There is no share of the work that would be known; the line is no longer than the terminal, and vanishes."""
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("COLUMNS", "200")
    options = RelaxOptions(vertices=40, max_iterations=2)
    with progress(options) as draw:
        result = minimize(torus_trefoil(40), options, draw)
    *lines, end = terminal.getvalue().split("\r\x1b[K")[1:]
    assert len(lines) == len(result.energies)
    assert lines[0].startswith(f"iteration 0 · E {result.energies[0]:#.5g} · gradient ")
    assert end == ""
    with progress() as draw:
        tighten(torus_trefoil(40), vertices=100, callback=draw)
    _, found, rest = terminal.getvalue().partition("iteration 0 · radius ")
    assert found
    assert "gradient" not in rest
    monkeypatch.setenv("COLUMNS", "40")
    with live() as show:
        show("x" * 50)
    assert "x" * 39 in terminal.getvalue()
    assert "x" * 40 not in terminal.getvalue()


def test_pipes_see_nothing_of_it(capsys):
    with live() as show:
        show("something")
    assert capsys.readouterr() == ("", "")


def test_a_notebook_keeps_the_last_line(monkeypatch):
    shown = []
    place = SimpleNamespace(update=lambda data, raw: shown.append(data["text/plain"]))
    display = SimpleNamespace(display=lambda data, raw, display_id: place)
    shell = SimpleNamespace(kernel=None)
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    with live() as show:
        show("first")
        show("last, too soon after the first")
    assert shown == ["first", "last, too soon after the first"]


def test_reports_and_tables_are_wrapped_in_terminals_only(terminal):
    words = "no contact on the whole path, which is long enough to be wrapped"
    rows = [("certified", words), ("empty", ""), ("wrote", ["a b.txt", "c" * 20, "d.npz"])]
    plain = report(("✓ converged", "9 iterations"), rows, io.StringIO())
    assert plain.splitlines() == [
        "✓ converged   9 iterations", f"  certified   {words}", f"  wrote       a b.txt  {'c' * 20}  d.npz"
    ]  # fmt: skip
    shown = report(("✓ converged", "9 iterations"), rows, terminal).splitlines()
    assert shown[0] == "\x1b[32m✓ converged\x1b[0m   9 iterations"
    assert shown[2:4] == [" " * 14 + "path, which is long", " " * 14 + "enough to be wrapped"]
    assert shown[4:] == ["\x1b[2m  wrote\x1b[0m       a b.txt", " " * 14 + "c" * 20, " " * 14 + "d.npz"]
    cells = table(("name", "s", "note"), [("3_1", "9.5", words), ("8_19", "10.5", "")], terminal).splitlines()
    assert cells[1:3] == ["3_1    9.5  no contact on the whole", "            path, which is long enough"]
    assert cells[-1] == "8_19  10.5"
    assert all(len(line) < 40 for line in sentence(f"mobius-flow: {words}", terminal).splitlines())


@pytest.mark.parametrize(
    ("variables", "coloured"),
    [({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False), ({"TERM": "dumb", "FORCE_COLOR": "1"}, True)],
)
def test_colours_are_as_the_environment_wants_them(variables, coloured, terminal, monkeypatch):
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert ("\x1b" in painted("x", 32, terminal)) is coloured
    monkeypatch.setattr(sys, "stderr", terminal)
    with live() as show:
        show("what is going on")
    assert (terminal.getvalue() == "") is ("TERM" in variables)
    assert ("\x1b" in painted("x", 32, io.StringIO())) is ("FORCE_COLOR" in variables)


def test_digits():
    pairs = (74.46382, 0.037), (136.38, 0.3), (4.0, 1e-12), (812.6, 30.0), (0.0, 0.1)
    assert [digits(*pair) for pair in pairs] == ["74.464", "136.38", "4.00000000", "813", "0"]
