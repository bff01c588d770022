"""Writhe and average crossing number: known values, symmetries, and the mean of what is seen."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Mesh
from mobius_flow.core.curve.measures import writhe_and_crossings
from mobius_flow.core.knots import smooth_knot
from mobius_flow.core.knots.diagrams import views


def test_linked_squares_by_hand() -> None:
    """Two flat components cross, seen from anywhere, as often as signs make twice the linking number, or more."""
    square = np.array([[1.0, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    linked = Curve.from_components([square, square[:, [0, 2, 1]] + [1.0, 0, 0]])
    writhe, crossings = writhe_and_crossings(linked)
    assert abs(writhe) == pytest.approx(2.0, abs=1e-12)
    assert crossings > 2.0
    with pytest.raises(CurveError, match="dimension 2"):
        writhe_and_crossings(Curve(square[:, :2]))
    assert np.allclose(writhe_and_crossings(Curve(square)), 0.0, atol=1e-12)


@pytest.mark.parametrize("name", ["3_1", "5_2", "4_1"])
def test_mirror_images_and_directions(name: str) -> None:
    curve = smooth_knot(name, 150)
    writhe, crossings = writhe_and_crossings(curve)
    mirrored = curve.with_vertices(curve.vertices * [1.0, 1.0, -1.0])
    assert writhe_and_crossings(mirrored) == pytest.approx((-writhe, crossings), abs=1e-12)
    assert writhe_and_crossings(Curve(curve.vertices[::-1] * 7.0 + 3.0)) == pytest.approx(
        (writhe, crossings), abs=1e-10
    )


def test_both_are_means_over_views() -> None:
    curve = smooth_knot("5_2", 60)
    seen = np.array([(view.writhe, view.crossings) for view in list(views(curve, 600))[1:]])
    error = 4.0 * seen.std(axis=0) / np.sqrt(len(seen))
    assert (np.abs(seen.mean(axis=0) - writhe_and_crossings(curve)) < error).all()


def test_blocks_of_rows_make_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    curve = smooth_knot("8_19", 130)
    together = writhe_and_crossings(curve)
    monkeypatch.setattr("mobius_flow.core.curve.measures._ROWS", 7)
    assert writhe_and_crossings(curve) == pytest.approx(together, abs=1e-12)


def test_the_arcs_without_one_edge_have_all_pairs_of_edges_but_those_with_it() -> None:
    curve = smooth_knot("5_2", 40)
    arcs = [Curve(np.roll(curve.vertices, k, axis=0), Mesh((40,), (False,))) for k in range(40)]
    total = np.sum([writhe_and_crossings(arc) for arc in arcs], axis=0)
    np.testing.assert_allclose(total, 38 * np.array(writhe_and_crossings(curve)), rtol=1e-12)
