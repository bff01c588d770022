"""The examples run, each in a process of its own, as users start them; what they claim, they assert."""

import importlib.util
import os
import sys
from pathlib import Path

import pytest
from processes import finished

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
SCRIPTS = sorted(EXAMPLES.glob("[0-9]*.py"))
NEEDED = {
    "17_table": "distributed",
    "18_film_in_blender": "bpy",
    "19_other_programs": "spherogram",
    "20_wire": "trimesh",
}


@pytest.mark.parametrize(
    "script",
    [pytest.param(path, marks=() if path is SCRIPTS[0] else pytest.mark.slow) for path in SCRIPTS],
    ids=lambda path: path.stem,
)
def test_an_example(script):
    needed = NEEDED.get(script.stem, "matplotlib")
    if importlib.util.find_spec(needed) is None:
        pytest.skip(f"{needed} is not installed")
    done = finished([sys.executable, str(script)], cwd=EXAMPLES, env={**os.environ, "MPLBACKEND": "Agg"})
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_an_example_is_short_and_asserts_what_it_claims(script):
    text = script.read_text(encoding="utf-8")
    assert "\nassert " in text or "    assert " in text
    assert len(text.splitlines()) <= 60
