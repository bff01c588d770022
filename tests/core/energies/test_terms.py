"""Terms beside the energy: their derivatives, what they do to a relaxation, and what their capabilities decide."""

import numpy as np
import pytest
from mobius_flow.core import MobiusFlowError, MoebiusEnergy, Objective, RelaxOptions, minimize
from mobius_flow.core.energies import ENERGIES, TERMS, Bending, Weighted, is_moebius_invariant
from shapes import regular_polygon, torus_trefoil
from smooth_curves import random_polygon
from taylor import derivative_slope

TERM = pytest.mark.parametrize("term", TERMS.values(), ids=lambda term: term.name)


@TERM
def test_taylor_slope(term):
    """Of a weighted sum, beside the barrier; those of terms alone are in `test_contract`."""
    curve, objective = random_polygon(3, (5, 7), 3), Objective(further=(Weighted(term, 0.3),))
    v = np.random.default_rng(5).normal(size=curve.vertices.shape)
    expected = Objective().value(curve) + 0.3 * term.value(curve)
    assert objective.value(curve) == pytest.approx(expected, rel=1e-12)
    assert derivative_slope(objective, curve, v, largest=1e-4) == pytest.approx(2, abs=0.01)


def test_the_stiffness_of_bending_is_its_second_derivative_across_a_nearly_straight_curve():
    curve, term = regular_polygon(400), Bending()
    t = 2.0 * np.pi * np.arange(400) / 400
    v = np.zeros_like(curve.vertices)
    v[:, 2] = 1e-3 * np.sin(9.0 * t)
    along = [term.value(curve.with_vertices(curve.vertices + s * v)) for s in (-1.0, 0.0, 1.0)]
    form = float(np.sum(v * (term.stiffness(curve) @ v)))
    assert form == pytest.approx(along[0] - 2.0 * along[1] + along[2], rel=0.05)


def test_the_stiffness_of_several_terms_adds_up():
    curve, term = regular_polygon(20), Bending()
    both = Objective(further=(Weighted(term, 2.0), Weighted(term, 0.5)))
    np.testing.assert_allclose(both.stiffness(curve).toarray(), 2.5 * term.stiffness(curve).toarray())


class Height:
    """Σ z, with neither stiffness nor second derivative, and a scale of its own."""

    name = "height"
    description = "Σ z"

    def value(self, curve):
        return float(curve.vertices[:, 2].sum())

    def value_and_derivative(self, curve):
        return self.value(curve), np.full_like(curve.vertices, 1.0) * [0.0, 0.0, 1.0]


def test_capabilities_are_those_of_all_terms():
    plain, bent = Objective.of(MoebiusEnergy()), Objective.of(MoebiusEnergy(), further=[Weighted(Bending())])
    own = Objective.of(MoebiusEnergy(), further=[Weighted(Height())])
    assert [each.sees_size for each in (plain, bent, own)] == [False, False, True]
    assert [each.without_hessian is None for each in (plain, bent, own)] == [True, False, False]
    assert own.stiffness(torus_trefoil(20)) is None
    invariant = {name for name, energy in ENERGIES.items() if is_moebius_invariant(energy)}
    assert invariant == set(ENERGIES) - {"tangent-point"}


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"terms": [("bending", 0.1)], "balance": True}, "another bending than the curve"),
        ({"energy": "tangent-point", "balance": True}, "another tangent-point than the curve"),
        ({"terms": [("bending", 0.1)], "stability": True}, "needs a second derivative; bending has none"),
        ({"terms": [("bnding", 0.1)]}, "did you mean bending"),
        ({"terms": [("bending", np.nan)]}, "a pair of a term and its weight"),
        ({"terms": "bending"}, "it must be a tuple, such as"),
        ({"terms": [Bending]}, "a pair of a term and its weight"),
        ({"terms": [("bending", -0.01)]}, "'bending' has weight -0.01, which would make its stiffness negative"),
        ({"terms": [("bending", 1e300)]}, "give terms smaller weights"),
        ({"terms": [("bending", 10**400)]}, "it must be a pair of a term and its weight"),
    ],
)
def test_what_does_not_go_together_is_refused(options, said):
    with pytest.raises(MobiusFlowError, match=said):
        minimize(torus_trefoil(40), RelaxOptions(vertices=40, max_iterations=1, **options))
