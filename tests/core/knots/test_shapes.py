"""Stored shapes: each has the type its name says, faces +z, and makes polygons that are proved to have its type."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest
from curve_checks import strand_distance
from families import family
from knot_type import knot_invariants
from mobius_flow.core import knots
from mobius_flow.core.collision import is_free
from mobius_flow.core.curve.refine import subdivide
from mobius_flow.core.knots import ALIASES, KNOTS, UnknownKnotError, smooth_knot
from mobius_flow.core.knots.inscribed import equal_steps, is_isotopic
from mobius_flow.core.knots.shapes import FILE, QUANTUM, least_energies, shapes
from mobius_flow.lab.smooth.rest import energy_of


def test_every_name_of_the_table_has_a_shape():
    assert list(shapes()) == list(KNOTS)
    assert FILE.stat().st_size < 80_000


@pytest.mark.parametrize("name", family(KNOTS))
def test_shapes_are_flat_fill_their_room_and_have_little_more_than_the_least_energy(name):
    least, _ = least_energies()[name]
    assert least * (1.0 - 1e-6) < energy_of(shapes()[name]) < 1.03 * least
    curve = smooth_knot(name)
    widths = np.ptp(curve.vertices, axis=0)
    assert widths.max() == pytest.approx(2.0, abs=0.03)
    assert abs(curve.vertices.max(axis=0) + curve.vertices.min(axis=0)).max() < 0.03
    assert widths[2] <= 1.3 * max(widths[:2])
    for part in curve.components:
        lengths = np.linalg.norm(np.diff(part, axis=0, append=part[:1]), axis=1)
        assert lengths.max() < 1.5 * lengths.min()
    assert strand_distance(curve, apart=8) > 0.028


def test_other_spellings_mirror_images_and_names_without_a_shape():
    assert np.array_equal(smooth_knot("Trefoil Knot").vertices, smooth_knot("3_1").vertices)
    assert np.array_equal(smooth_knot("m m trefoil").vertices, smooth_knot("3_1").vertices)
    assert np.array_equal(smooth_knot("m3_1").vertices, smooth_knot("3_1").vertices * [1, 1, -1])
    assert knot_invariants(smooth_knot("m3_1").vertices).tau == -1
    assert all(len(smooth_knot(name)) >= 64 for name, meant in ALIASES.items() if "#" not in meant)
    missing = dict.fromkeys(("granny", "T(2,3)", "goeritz"), "none of the table")
    for name, said in (missing | {"trefol": "did you mean trefoil", "": "known are"}).items():
        with pytest.raises(UnknownKnotError, match=re.escape(said)):
            smooth_knot(name)


def test_a_motion_through_itself_is_not_isotopic():
    curve, mirrored = smooth_knot("3_1"), smooth_knot("m3_1")
    assert is_isotopic(curve, equal_steps(curve), curve, equal_steps(curve))
    assert not is_isotopic(curve, equal_steps(curve), mirrored, equal_steps(mirrored))


def sharpest(curve):
    """The largest angle between an edge and the next, in degrees."""
    edges = np.diff(curve.components[0], axis=0)
    edges /= np.linalg.norm(edges, axis=1, keepdims=True)
    return np.degrees(np.arccos(np.clip((edges[1:] * edges[:-1]).sum(axis=1), -1, 1))).max()


@pytest.mark.parametrize("name", ["goeritz", "thistlethwaite", "3_1", "L6a4", "overhand"])
def test_corners_are_rounded_by_a_free_motion(name):
    curve = knots.knot(name)
    round_ = knots.rounded(curve)
    assert len(round_) >= 320
    assert sharpest(round_) < 0.4 * sharpest(curve)
    split = subdivide(curve, np.full(curve.mesh.edges, round_.mesh.edges // curve.mesh.edges))
    assert is_free(split.mesh, split.vertices, round_.vertices)
    np.testing.assert_array_equal(round_.vertices[round_.mesh.ends], split.vertices[split.mesh.ends])


_FILE = Path(__file__).resolve().parents[3] / "tools" / "knot_shapes.py"
_SPEC = importlib.util.spec_from_file_location("knot_shapes", _FILE)
tool = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(tool)


@pytest.mark.kernels
@pytest.mark.parametrize("name", family(["3_1", "4_1"], every=2))
def test_shapes_are_made_anew_as_they_are_stored(name, tmp_path, monkeypatch):
    """To a few quanta, as linear algebra may round otherwise than where they were made; links turn over freely."""
    monkeypatch.setattr(tool, "KEPT", tmp_path)
    made, stored = tool.shape(name).coefficients, shapes()[name].coefficients
    assert len(made) == len(stored)
    for one, other in zip(made, stored, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=4 * QUANTUM)
