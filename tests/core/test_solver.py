"""The options solver and accuracy: what they promise, and what they do not go together with."""

import pytest
from mobius_flow.core import Iterate, OptionError, RelaxOptions, relax
from shapes import torus_trefoil


def start(**options: object) -> Iterate:
    return next(relax(torus_trefoil(300), RelaxOptions(vertices=300, **options)))  # type: ignore[arg-type]


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-8])
def test_solvers_agree_as_far_as_the_option_says(accuracy: float) -> None:
    """The hierarchical metric is another one, and the error of the energy does not depend on the accuracy."""
    dense, fast = start(solver="dense"), start(solver="hierarchical", accuracy=accuracy)
    assert fast.energy == pytest.approx(dense.energy, rel=2e-6)
    assert fast.gradient_norm == pytest.approx(dense.gradient_norm, rel=0.03)
    exact = start(solver="hierarchical", accuracy=1e-12)
    assert fast.gradient_norm == pytest.approx(exact.gradient_norm, rel=accuracy)


@pytest.mark.parametrize(
    ("options", "obstacle"),
    [
        ({"method": "trust-region"}, "trust-region with these options needs a second derivative"),
        ({"stability": True}, "lbfgs with these options needs a second derivative"),
        ({"quadrature_points": 2}, "2 Gauss points need all pairs of edges one by one"),
        ({"energy": "tangent-point"}, "energy 'tangent-point' needs all pairs of edges one by one"),
    ],
)
def test_what_needs_dense_matrices_is_refused_in_one_sentence(options: dict[str, object], obstacle: str) -> None:
    with pytest.raises(OptionError) as caught:
        start(solver="hierarchical", **options)
    assert str(caught.value) == f"{obstacle}; solver='hierarchical' does without: leave it out"
