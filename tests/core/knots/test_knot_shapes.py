"""The tool that makes the stored shapes: what it makes anew is what is stored."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from families import family
from mobius_flow.core.curve.fourier import FourierCurve
from mobius_flow.core.knots.shapes import QUANTUM, shapes

_FILE = Path(__file__).resolve().parents[3] / "tools" / "knot_shapes.py"
_SPEC = importlib.util.spec_from_file_location("knot_shapes", _FILE)
tool = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(tool)


@pytest.mark.kernels
@pytest.mark.parametrize("name", family(["3_1", "4_1"], every=2))
def test_shapes_are_made_anew_as_they_are_stored(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """To a few quanta, as linear algebra may round otherwise than where they were made; links turn over freely."""
    monkeypatch.setattr(tool, "KEPT", tmp_path)
    made, stored = tool.shape(name).coefficients, shapes()[name].coefficients
    assert len(made) == len(stored)
    for one, other in zip(made, stored, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=4 * QUANTUM)


def test_what_is_stored_is_read_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(3)
    parts = [QUANTUM * rng.integers(-9000, 9000, size=(n, 3, 2)) for n in (4, 2, 7)]
    first, second, third = (part[..., 0] + 1j * part[..., 1] for part in parts)
    tool.store({"a": FourierCurve((first, second)), "b": FourierCurve((third,))}, tmp_path / "shapes.npz")
    monkeypatch.setattr("mobius_flow.core.knots.shapes.FILE", tmp_path / "shapes.npz")
    found = shapes.__wrapped__()
    assert list(found) == ["a", "b"]
    for got, given in zip((*found["a"].coefficients, *found["b"].coefficients), (first, second, third), strict=True):
        assert np.array_equal(got, given)
