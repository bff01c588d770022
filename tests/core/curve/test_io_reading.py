"""What the readers understand, and what they drop with a note."""

import logging
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core.curve.io import read_curve

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
SQUARE = [[0, 0, 5], [1, 0, 5], [1, 1, 5], [0, 1, 5]]
SQUARE_V = "".join(f"v {x} {y} {z}\n" for x, y, z in SQUARE)
TRIANGLE_V = "".join(f"v {x} {y} {z}\n" for x, y, z in TRIANGLE)

UNDERSTOOD = {
    "spaces.txt": ("0 0 0\n1 0 0\n0 1 0\n", [TRIANGLE]),
    "tabs.xyz": ("0\t0\t0\n1\t0\t0\n0\t1\t0", [TRIANGLE]),
    "commas.txt": ("0,0,0\n 1, 0 ,0 \n0 , 1, 0e0\n", [TRIANGLE]),
    "semicolons.txt": ("0;0;0\n1; 0; 0\n0;1;0\n", [TRIANGLE]),
    "plane.txt": ("0 0\n1 0\n0 1", [[p[:2] for p in TRIANGLE]]),
    "windows.txt": ("0 0 0\r\n1 0 0\r\n0 1 0\r\n\r\n", [TRIANGLE]),
    "comments.txt": ("# head\n\n\n0 0 0 # first\n# between\n1 0 0\n0 1 0\n\n # tail\n", [TRIANGLE]),
    "mark.txt": ("\ufeff0 0 0\n1 0 0\n0 1 0\n", [TRIANGLE]),
    "two.txt": ("0 0 0\n1 0 0\n0 1 0\n\n\n0 0 5\n1 0 5\n1 1 5\n0 1 5", [TRIANGLE, SQUARE]),
    "one_line.obj": (SQUARE_V + "l 1 2 3 4 1\n", [SQUARE]),
    "texture.obj": (SQUARE_V + "vt 0 0\nl 1/1 2/1 3/1 4/1 1/1\n", [SQUARE]),
    "negative.obj": (SQUARE_V + "l -4 -3 -2 -1 -4\n", [SQUARE]),
    "pairs.obj": (SQUARE_V + "l 3 4\nl 1 2\nl 4 1\nl 2 3\n", [SQUARE]),
    "mixed_directions.obj": (SQUARE_V + "l 3 2\nl 1 2\nl 4 1\nl 3 4\n", [SQUARE]),
    "backwards.obj": (SQUARE_V + "l 4 3 2 1 4\n", [[SQUARE[0], *SQUARE[:0:-1]]]),
    "chains.obj": (SQUARE_V + "l 3 4 1\nl 1 2 3\n", [SQUARE]),
    "unused.obj": ("v 9 9 9\n" + SQUARE_V + "v 8 8 8\nl 2 3 4 5 2\n", [SQUARE]),
    "two.obj": (TRIANGLE_V + SQUARE_V + "g a\nl 4 5 6 7 4\no b\nl 1 2 3 1\n", [TRIANGLE, SQUARE]),
    "late.obj": ("l 1 2 3 1\n" + TRIANGLE_V, [TRIANGLE]),
    "continued.obj": (TRIANGLE_V + "l 1 2 \\\n 3 1 # end\n", [TRIANGLE]),
    "colours.obj": (TRIANGLE_V.replace("\n", " .5 .5 .5\n") + "l 1 2 3 1\n", [TRIANGLE]),
    "closed.vect": ("VECT\n1 3 0\n-3\n0\n0 0 0 1 0 0\n0 1 0\n", [TRIANGLE]),
    "commented.vect": (
        "VECT # Geomview\n1 3 1 # counts\n-3\n1\n# points\n0 0 0\n1 0 0\n0 1 0\n1 0 0 1 # red\n",
        [TRIANGLE],
    ),
    "two.vect": ("VECT 2 7 0 -3 -4 0 0 0 0 0 1 0 0 0 1 0  0 0 5 1 0 5 1 1 5 0 1 5", [TRIANGLE, SQUARE]),
    "object.json": (f'{{"name": "x", "components": [{TRIANGLE}, {SQUARE}]}}', [TRIANGLE, SQUARE]),
    "components.json": (f"[{TRIANGLE}, {SQUARE}]", [TRIANGLE, SQUARE]),
    "points.json": (f"{TRIANGLE}", [TRIANGLE]),
    "object_points.json": (f'{{"components": {TRIANGLE}}}', [TRIANGLE]),
}


def _write(tmp_path: Path, name: str, text: str) -> Path:
    path = tmp_path / name
    path.write_bytes(text.encode())
    return path


@pytest.mark.parametrize("name", UNDERSTOOD)
def test_understood(tmp_path: Path, name: str, caplog: pytest.LogCaptureFixture) -> None:
    text, expected = UNDERSTOOD[name]
    with caplog.at_level(logging.WARNING):
        curve = read_curve(_write(tmp_path, name, text))
    assert not caplog.records
    assert curve.mesh.component_sizes == tuple(map(len, expected))
    assert np.array_equal(curve.vertices, np.concatenate(expected))


OPEN = {
    "marked.txt": ("# open\n0 0 0\n1 0 0\n0 1 0\n", (False,)),
    "second.txt": ("0 0 0\n1 0 0\n0 1 0\n\n#  open \n0 0 5\n1 0 5\n1 1 5\n0 1 5\n", (True, False)),
    "no_blank_line.txt": ("0 0 0\n1 0 0\n0 1 0\n# open\n0 0 5\n1 0 5\n1 1 5\n0 1 5\n", (True, False)),
    "first.txt": ("# open\n# of course\n0 0 0\n1 0 0\n0 1 0\n\n0 0 5\n1 0 5\n1 1 5\n0 1 5\n", (False, True)),
    "path.obj": (TRIANGLE_V + "l 2 3\nl 1 2\n", (False,)),
    "both.obj": (TRIANGLE_V + SQUARE_V + "l 1 2 3 1\nl 7 6 5 4\n", (True, False)),
    "path.vect": ("VECT 1 3 0 3 0 0 0 0 1 0 0 0 1 0", (False,)),
    "both.vect": ("VECT 2 7 0 -3 4 0 0 0 0 0 1 0 0 0 1 0  0 0 5 1 0 5 1 1 5 0 1 5", (True, False)),
    "path.json": (f'{{"components": [{TRIANGLE}], "closed": [false]}}', (False,)),
    "points.json": (f'{{"closed": [false], "components": {TRIANGLE}}}', (False,)),
    "both.json": (f'{{"components": [{TRIANGLE}, {SQUARE}], "closed": [true, false]}}', (True, False)),
}


@pytest.mark.parametrize("name", OPEN)
def test_open_components(tmp_path: Path, name: str, caplog: pytest.LogCaptureFixture) -> None:
    text, closed = OPEN[name]
    with caplog.at_level(logging.WARNING):
        curve = read_curve(_write(tmp_path, name, text))
    assert not caplog.records
    assert curve.mesh.closed == closed
    rows = sorted(map(tuple, curve.vertices.tolist()))
    assert rows == sorted(map(tuple, (TRIANGLE + SQUARE)[: len(curve)]))


NOTED = {
    "closing.txt": ("0 0 0\n1 0 0\n0 1 0\n0 0 0\n", "repeats its first"),
    "closing.json": (f"[{[*TRIANGLE, TRIANGLE[0]]}]", "repeats its first"),
    "closing.vect": ("VECT 1 4 0 -4 0 0 0 0 1 0 0 0 1 0 0 0 0", "repeats its first"),
    "closing.obj": (TRIANGLE_V + "v 0 0 0\nl 1 2 3 4\n", "repeats its first"),
    "vertices_only.obj": (TRIANGLE_V, "no polyline"),
    "faces.obj": (TRIANGLE_V + "l 1 2 3 1\nf 1 2 3\n", "1 faces"),
}


@pytest.mark.parametrize("name", NOTED)
def test_noted(tmp_path: Path, name: str, caplog: pytest.LogCaptureFixture) -> None:
    text, note = NOTED[name]
    with caplog.at_level(logging.WARNING):
        curve = read_curve(_write(tmp_path, name, text))
    assert np.array_equal(curve.vertices, TRIANGLE)
    assert len(caplog.records) == 1
    assert note in caplog.text
