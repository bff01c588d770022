"""What is written is read back: bit for bit, in every format."""

import logging

import numpy as np
import pytest
from curve_formats import OF_VERTICES
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from mobius_flow.core.base.errors import CurveFileError
from mobius_flow.core.curve import Curve
from mobius_flow.core.io import read_curve, write_curve
from shapes import lattice_knot

COORDINATES = st.floats(allow_nan=False, allow_infinity=False, width=64)


@st.composite
def curves(draw, dimension=3):
    closed = draw(st.lists(st.booleans(), min_size=1, max_size=3))
    sizes = [draw(st.integers(3 if flag else 2, 6)) for flag in closed]
    parts = [draw(hnp.arrays(np.float64, (size, dimension), elements=COORDINATES)) for size in sizes]
    for part in parts:  # a last vertex equal to the first is the closing point, dropped by design
        if (part[0] == part[-1]).all():
            part[-1, 0] += max(1.0, abs(part[-1, 0]) * 1e-3) * (-1.0 if part[-1, 0] > 0 else 1.0)
    return Curve.from_components(parts, closed)


@pytest.mark.parametrize("suffix", OF_VERTICES)
@given(curve=curves())
@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_round_trip_is_exact(tmp_path, suffix, curve):
    path = tmp_path / f"curve{suffix}"
    write_curve(path, curve)
    again = read_curve(path)
    assert again.mesh == curve.mesh
    assert np.array_equal(again.vertices, curve.vertices)


@pytest.mark.parametrize(
    ("suffix", "dimension"), [(".txt", 2), (".csv", 2), (".json", 2), (".json", 5), (".obj", 2), (".vect", 2)]
)
def test_other_dimensions_round_trip_or_get_a_third_coordinate(tmp_path, suffix, dimension):
    points = np.random.default_rng(5).normal(size=(7, dimension))
    write_curve(tmp_path / f"curve{suffix}", Curve(points))
    more = 1 if suffix in (".obj", ".vect") else 0
    assert np.array_equal(read_curve(tmp_path / f"curve{suffix}").vertices, np.pad(points, ((0, 0), (0, more))))


@pytest.mark.parametrize("suffix", [".txt", ".csv", ".obj", ".vect"])
def test_four_dimensions_are_refused_and_leave_no_file(tmp_path, suffix):
    path = tmp_path / f"curve{suffix}"
    with pytest.raises(CurveFileError, match=r"dimension.*json"):
        write_curve(path, Curve(np.eye(4)))
    assert list(tmp_path.iterdir()) == []


def test_suffixes_are_not_case_sensitive(tmp_path):
    write_curve(tmp_path / "CURVE.OBJ", Curve(np.eye(3)))
    assert len(read_curve(str(tmp_path / "CURVE.OBJ"))) == 3


@pytest.mark.parametrize("suffix", OF_VERTICES)
def test_what_is_written_is_read_silently_and_in_order(tmp_path, caplog, suffix):
    link = lattice_knot("L6a4")
    write_curve(tmp_path / f"link{suffix}", link)
    with caplog.at_level(logging.WARNING):
        again = read_curve(tmp_path / f"link{suffix}")
    assert not caplog.records
    assert again.mesh == link.mesh
    assert len(again.mesh.component_sizes) == 3
    assert np.array_equal(again.vertices, link.vertices)
