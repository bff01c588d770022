"""Soft modes by products against the dense eigenvalue problem."""

import numpy as np
import pytest
from dense_stability import POINTS, at, dense_modes, saddle
from mobius_flow.core.base.tolerances import BULK
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.descent import Point
from mobius_flow.core.descent.hessian import smooth_starts, soft_modes
from mobius_flow.core.descent.second_order import Curvature
from mobius_flow.core.driver.moves import rest as stability_module
from mobius_flow.core.driver.moves.rest import stability
from mobius_flow.core.knots import torus_knot
from shapes import torus_trefoil


def starts(point: Point) -> FloatArray:
    return smooth_starts(point, np.random.default_rng(5))


@pytest.mark.parametrize("name", POINTS)
def test_all_soft_modes_are_those_of_the_matrix(name: str) -> None:
    """Differences make the hierarchical products, to five digits; its metric is solved with to two."""
    point = POINTS[name]()
    expected, _ = dense_modes(point)
    found = soft_modes(point, starts(point))
    soft = max(1, np.count_nonzero(expected < BULK))
    assert np.count_nonzero(found.values[: len(found.residuals)] < BULK) == np.count_nonzero(expected < BULK)
    np.testing.assert_allclose(found.values[:soft], expected[:soft], atol=2e-5 if name == "hierarchical" else 1e-9)
    assert (found.residuals[:soft] <= 1e-6).all()


@pytest.mark.parametrize("factorised", [True, False])
@pytest.mark.parametrize("name", POINTS)
def test_the_index_is_that_of_the_matrix(name: str, factorised: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether factors tell it or Ritz values."""
    if not factorised:
        monkeypatch.setattr(Curvature, "is_known", lambda point: False)
    point = POINTS[name]()
    found = stability(point)
    assert found.index == np.count_nonzero(dense_modes(point)[0] < -found.zero)


def test_soft_modes_are_tangent_orthonormal_and_end_at_pins() -> None:
    for point in (saddle(), POINTS["pins"]()):
        vectors = soft_modes(point, starts(point), most=32).vectors
        assert max(np.abs(point.tangent_space.constraints.apply(u)).max() for u in vectors) < 1e-9
        duals = np.stack([point.tangent_space.apply(u) for u in vectors])
        np.testing.assert_allclose(np.tensordot(vectors, duals, ((1, 2), (1, 2))), np.eye(len(vectors)), atol=1e-9)
        assert not vectors[:, point.problem.constraints.pins.vertices].any()


def test_a_few_products_find_the_ways_down_from_a_saddle() -> None:
    """Ritz values are above the eigenvalues in their places, and residuals bound how far one is."""
    expected, _ = dense_modes(saddle())
    found = soft_modes(saddle(), starts(saddle()), most=32)
    assert (found.values > expected[: len(found.values)] - 1e-10).all()
    assert (found.values[:2] < 0.0).all()
    looked_at = found.values[: len(found.residuals), None]
    assert (np.abs(looked_at - expected).min(axis=1) <= found.residuals + 1e-10).all()
    assert found.residuals.max() > 1e-3


def test_every_eigenvalue_is_found_if_that_is_asked_for() -> None:
    """Beyond the last one there are no more dimensions."""
    regular = torus_knot(3, 4, 24)
    point = at(regular.with_vertices(regular.vertices + np.random.default_rng(7).normal(0.0, 0.03, (24, 3))))
    expected, _ = dense_modes(point)
    found = soft_modes(point, starts(point), below=np.inf)
    np.testing.assert_allclose(found.values, expected, atol=1e-8)


def test_nothing_is_soft_where_nothing_can_move() -> None:
    held = at(torus_trefoil(12), pins=tuple(range(12)))
    assert len(soft_modes(held, starts(held)).values) == 0
    assert stability(held).index == 0


def test_what_is_not_near_enough_is_no_index(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where Ritz values tell the index, because the matrix is too large."""
    monkeypatch.setattr(Curvature, "is_known", lambda point: False)
    assert stability(saddle()).index is not None
    monkeypatch.setattr(stability_module, "soft_modes", lambda point, starts, _: soft_modes(point, starts, most=16))
    assert stability(saddle()).index is None
