"""Times of compressed inner products: python benchmarks/metric.py [vertices ...]

One line per curve: building J_C, its product with three columns, its model, a projected gradient, a pseudo-inverse and
a step of Newton's method back to the constraints, in milliseconds of processor time, the least of three. Run it with
one BLAS thread on a quiet machine.
"""

from collections.abc import Callable
from dataclasses import replace
from time import process_time
from typing import TypeVar

import numpy as np
from hard_curves import chain_of_rings, graded_trefoil
from mobius_flow.core import Curve
from mobius_flow.core.constraints import Constraints
from mobius_flow.core.curve import refine
from mobius_flow.core.hierarchy.inner_product import moebius_inner_product
from mobius_flow.core.knots import knot, torus_knot
from words import words

_Value = TypeVar("_Value")


CURVES: dict[str, Callable[[int], Curve]] = {
    "torus knot (2,3)": lambda n: torus_knot(2, 3, n),
    "Ochiai's unknot": lambda n: refine(knot("ochiai-1"), n),
    "chain of rings": lambda n: chain_of_rings(n // 20, (20,)),
    "graded trefoil": lambda n: graded_trefoil(n, 100.0),
}


def timed(function: Callable[[], _Value]) -> tuple[float, _Value]:
    """Milliseconds, and the value."""
    times = []
    for _ in range(3):
        start = process_time()
        value = function()
        times.append(process_time() - start)
    return 1e3 * min(times), value


def line(curve: Curve) -> str:
    """All times of one curve."""
    constraints, load = (
        Constraints.of(curve).derivative(curve),
        np.sin(3 * curve.vertices) * curve.edge_lengths[:, None],
    )
    build, inner = timed(lambda: moebius_inner_product(curve))
    product, _ = timed(lambda: inner.apply(load))
    model, _ = timed(lambda: replace(inner).model)
    space = inner.tangent_space(constraints)
    gradient, _ = timed(lambda: space.gradient(load))
    error = constraints.apply(np.sin(3 * curve.vertices))
    residual, targets = 1e-3 * error / np.abs(error).max(), Constraints.of(curve)
    large, _ = timed(lambda: space.pseudo_inverse(error))
    small, _ = timed(lambda: space.restoration(targets, curve, residual))
    times = "".join(f"{value:10.1f}" for value in (build, product, model, gradient, large, small))
    return f"{len(curve):8}{times}"


def main() -> None:
    """All curves in all sizes."""
    sizes = words(__doc__, "vertices", [1000, 10_000, 100_000], int)
    print(f"{'':18}{'n':>8}   build   product     model  gradient   C^† big     small")
    for name, make in CURVES.items():
        for n in sizes:
            print(f"{name:18}{line(make(n))}", flush=True)


if __name__ == "__main__":
    main()
