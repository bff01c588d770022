"""Models of inner products: what Fourier transforms, resolvents and the graph of components invert."""

import numpy as np
import pytest
from hard_curves import hard_unknot, lattice_closure, unknot_word
from mobius_flow.core import Mesh
from mobius_flow.core.curve import refine
from mobius_flow.core.knots import knot
from mobius_flow.core.solve.constraints import ConstraintDerivative
from mobius_flow.core.solve.hierarchical import moebius_inner_product
from mobius_flow.core.solve.metrics import MoebiusMetric
from mobius_flow.core.solve.saddle.iterative import conjugate_gradients, relative
from mobius_flow.core.solve.saddle.models import Circulants, ComponentTransform, Resolvents
from scipy.linalg import circulant, eigvalsh
from shapes import chain_of_rings, graded_trefoil, regular_polygon, torus_trefoil

MODELS = {"circulants": Circulants, "resolvents": Resolvents}
MODEL = pytest.mark.parametrize("model", MODELS)


def spread(curve, model):
    """Condition number of the exact J_C against the model, on functions of mean 0 on every component."""
    inner = MoebiusMetric().at(curve)
    n, matrix = len(curve), inner.dense()
    inverse = MODELS[model](curve.mesh, curve.edge_lengths, inner.apply).solve(np.eye(n))
    np.testing.assert_allclose(inverse, inverse.T, atol=1e-10 * np.abs(inverse).max())
    indicators = (curve.mesh.component[:, None] == np.arange(len(curve.mesh.component_sizes))).astype(float)
    basis = np.linalg.qr(indicators, mode="complete")[0][:, indicators.shape[1] :]
    eigenvalues = eigvalsh(basis.T @ matrix @ basis, np.linalg.inv(basis.T @ inverse @ basis))
    assert eigenvalues[0] > 0
    return float(eigenvalues[-1] / eigenvalues[0])


@MODEL
@pytest.mark.parametrize(
    ("curve", "most"),
    [
        *((regular_polygon(n), 6.0) for n in (5, 50, 51, 400)),
        *((torus_trefoil(n), 12.0) for n in (100, 400)),
        *((graded_trefoil(400, ratio), 40.0) for ratio in (1.0, 100.0, 1000.0)),
        (chain_of_rings(12, (5, 40, 11, 4)), 30.0),
    ],
)
def test_models_are_equivalent(curve, model, most):
    if most < 40.0 or model == "resolvents":  # which alone do not mind the mesh
        assert spread(curve, model) < most


@MODEL
def test_triangles_have_none(model):
    with pytest.raises(np.linalg.LinAlgError, match="not positive definite"):
        spread(regular_polygon(3), model)


def tension_spread(curve, model):
    """Condition number of C M⁻¹ Cᵀ, on the lengths, preconditioned by the model's own near inverse."""
    m = MODELS[model](curve.mesh, curve.edge_lengths, moebius_inner_product(curve).apply)
    rows = ConstraintDerivative.of_lengths(curve)
    unit = np.eye(len(curve))
    schur = np.column_stack([rows.apply(m.solve(rows.apply_transpose(e))) for e in unit])
    tension = np.column_stack([m.tension(rows.tangents)(e) for e in unit])
    np.testing.assert_allclose(tension, tension.T, atol=1e-8 * np.abs(tension).max())
    eigenvalues = eigvalsh(schur, np.linalg.inv(0.5 * (tension + tension.T)))
    assert eigenvalues[0] > 0
    return float(eigenvalues[-1] / eigenvalues[0])


@MODEL
@pytest.mark.parametrize("curve", [regular_polygon(60), chain_of_rings(4, (20,))], ids=["circle", "chain"])
def test_tension_on_circles(model, curve):
    """Exact with circulants and equal edges."""
    assert tension_spread(curve, model) < (1.0 + 1e-8 if model == "circulants" else 4.0)


@MODEL
@pytest.mark.parametrize(
    ("curve", "bound"),
    [(refine(hard_unknot(20, seed=20), 600), 9), (refine(lattice_closure(unknot_word(20, seed=20))), 120)],
    ids=["braid", "lattice"],
)
def test_tension_where_curves_turn_fast(model, curve, bound):
    """Between strands that press, long waves cost much; a curve that turns leaves none of them in its lengths.

    A near inverse for directions that hardly change from edge to edge has condition numbers of 34 and 292.
    """
    assert tension_spread(curve, model) < bound


def test_transforms_are_circulant_matrices():
    mesh = Mesh((5, 8, 5, 3))
    transform, u = ComponentTransform(mesh), np.random.default_rng(43).normal(size=(21, 2))
    result = transform.filtered(u, transform.sampled(lambda theta: 2.0 + np.cos(theta)))
    for part in mesh.slices:
        size = part.stop - part.start
        column = np.zeros(size)
        column[0] = 2.0
        column[1] += 0.5
        column[-1] += 0.5
        np.testing.assert_allclose(result[part], circulant(column) @ u[part], atol=1e-14)


def test_many_components_move_as_they_should():
    """Translations of the rings of a chain: on these the model is all but exact."""
    curve = chain_of_rings(40, (9, 14))
    inner = moebius_inner_product(curve)
    indicators = (curve.mesh.component[:, None] == np.arange(40)).astype(float)
    shifts = np.cumsum(np.random.default_rng(47).normal(size=40))
    u = indicators @ shifts[:, None]
    restricted = indicators.T @ inner.apply(indicators)
    np.testing.assert_allclose(
        np.linalg.solve(restricted, indicators.T @ inner.apply(u))[:, 0], shifts, atol=1e-8 * np.abs(shifts).max()
    )
    coupling = inner.coupling.toarray() + np.outer(indicators.T @ inner.vectors, indicators.T @ inner.vectors)
    eigenvalues = eigvalsh(coupling, restricted)
    assert eigenvalues[0] > 0.5
    assert eigenvalues[-1] < 1.01


@pytest.mark.parametrize(
    ("curve", "transforms"), [(refine(knot("ochiai-3"), 1000), True), (graded_trefoil(1000, 20.0), False)]
)
def test_transforms_are_taken_up_to_the_ratio_where_they_take_longer(curve, transforms):
    """On a tangle whose edges differ by 12:1 either model takes a hundred iterations, resolvents three times longer."""
    inner, expected = moebius_inner_product(curve), Circulants if transforms else Resolvents
    products = 0

    def apply(u):
        nonlocal products
        products += 1
        return inner.apply(u)

    assert isinstance(inner.model._fine, expected)
    load = np.sin(3.0 * curve.vertices) * curve.edge_lengths[:, None]
    conjugate_gradients(apply, relative(inner.model.solve, 1e-2), load, 500)
    assert products < (100 if transforms else 15)
