"""The examples run, each in a process of its own, as users start them."""

import sys
from pathlib import Path

import pytest
from processes import finished

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
CALL = """
import runpy, sys
film = runpy.run_path(sys.argv[1])["film"]
film(sys.argv[2], length=4, size=(64, 36), look="FINE")

from mobius_flow.addon.pictures.movie import length_of
print("frames:", length_of(sys.argv[2]))
"""


def test_a_film_of_a_knot(tmp_path):
    pytest.importorskip("bpy")
    done = finished([sys.executable, "-P", "-c", CALL, str(EXAMPLES / "film_of_a_knot.py"), str(tmp_path / "film.mp4")])
    assert done.returncode == 0, done.stdout + done.stderr
    assert "frames: 4" in done.stdout
    assert "proved free of contact" in done.stdout


def test_a_table_of_knots(tmp_path):
    pytest.importorskip("distributed")
    done = finished([sys.executable, str(EXAMPLES / "table_of_knots.py"), "0_1", "3_1"], cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = sorted(line.split() for line in done.stdout.splitlines())
    assert [row[0] for row in rows] == ["0_1", "3_1"]
    assert [float(row[2]) for row in rows] == pytest.approx([4.0, 74.45], abs=0.05)
