"""∬ 1/r² over two straight edges against mpmath, however near and however shaped they are."""

import mpmath as mp
import numpy as np
import pytest
from energy_references import inverse_square_integral
from families import crossed
from mobius_flow.core.energies.barrier import inverse_square
from mobius_flow.core.energies.edge_pairs import EdgePairs, change, stepped

SHAPES = {
    "crossing": lambda g: ([0, 0, 0], [1, 0, 0], [0.3, -0.6, g], [0.5, 0.4, g]),
    "crossing at a small angle": lambda g: ([0, 0, 0], [1, 0, 0], [0.1, -0.01, g], [0.9, 0.02, g]),
    "crossing at an end": lambda g: ([0, 0, 0], [1, 0, 0], [1, -0.5, g], [1, 0.5, g]),
    "parallel": lambda g: ([0, 0, 0], [1, 0, 0], [0.2, 0, g], [1.1, 0, g]),
    "antiparallel": lambda g: ([0, 0, 0], [1, 0, 0], [1, 0, g], [0, 0, g]),
    "almost parallel": lambda g: ([0, 0, 0], [1, 0, 0], [0, 0, g], [1, 0, 3 * g]),
    "T upright": lambda g: ([0, 0, 0], [1, 0, 0], [0.37, g, 0], [0.37, 1, 0]),
    "T leaning": lambda g: ([0, 0, 0], [1, 0, 0], [0.37, 0, g], [0.4, 0.3, 1]),
    "tip at tip": lambda g: ([0, 0, 0], [1, 0, 0], [1 + g, 0, 0], [1.5, 0.7, 0.1]),
    "collinear": lambda g: ([0, 0, 0], [1, 0, 0], [1 + g, 0, 0], [2, 0, 0]),
    "almost collinear": lambda g: ([0, 0, 0], [1, 0, 0], [1 + g, 1e-7, 0], [2, 1e-5, 0]),
    "short and long": lambda g: ([0.3, 4e-4, g], [0.3005, -4e-4, g], [0, 0, 0], [1, 0, 0]),
    "short above long": lambda g: ([0.3, g, 0], [0.3, 2e-3, 0], [0, 0, 0], [1, 0, 0]),
    "apart": lambda g: ([0, 0, 0], [1, 0, 0], [0.1, 1.2 + g, 0.3], [0.5, 1.6, -0.3]),
}


def points_of(shape, gap):
    p, q, r, s = (np.array(point, dtype=float) for point in SHAPES[shape](gap))
    return p, q, r, s


def pairs_of(points):
    x0, x1, y0, y1 = (p[None] for p in points)
    return EdgePairs(0.5 * ((x0 - y0) + (x1 - y1)), x1 - x0, y1 - y0)


@pytest.mark.parametrize(("shape", "gap"), crossed(SHAPES, [1e-2, 1e-5, 1e-9]))
def test_value(shape, gap):
    x0, x1, y0, y1 = points_of(shape, gap)
    reference = float(inverse_square_integral(x0, x1, y0, y1))
    # the geometry itself is rounded: a gap of 1e-9 is known to 1e-7 of itself, and the integral sees its logarithm
    tolerance = 1e-8 if gap == 1e-9 else 1e-10
    assert inverse_square(pairs_of((x0, x1, y0, y1))).value[0] == pytest.approx(reference, rel=tolerance)
    assert inverse_square(pairs_of((y0, y1, x0, x1))).value[0] == pytest.approx(reference, rel=tolerance)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_random_pairs(seed, dimension):
    points = np.random.default_rng(seed).normal(size=(4, dimension))
    if dimension == 2:
        points[2:] += 4.0  # in the plane edges must not cross
    reference = float(inverse_square_integral(*points))
    assert inverse_square(pairs_of(tuple(points))).value[0] == pytest.approx(reference, rel=1e-11)


@pytest.mark.parametrize(
    ("shape", "gap"), crossed(["crossing", "parallel", "tip at tip", "collinear", "short and long"], [0.1, 1e-4])
)
def test_derivatives(shape, gap):
    points = points_of(shape, gap)
    velocity = np.random.default_rng(7).normal(size=(4, 3))
    dx0, dx1, dy0, dy1 = velocity
    direction = np.concatenate([0.5 * ((dx0 - dy0) + (dx1 - dy1)), dx1 - dx0, dy1 - dy0])
    jet = inverse_square(pairs_of(tuple(map(stepped, points, velocity))))
    step = mp.mpf(gap) / 10**4

    def moved(steps):
        ends = zip(points, velocity, strict=True)
        return inverse_square_integral(*([c + steps * step * w for c, w in zip(p, v, strict=True)] for p, v in ends))

    plus, middle, minus = moved(1), moved(0), moved(-1)
    first, second = (plus - minus) / (2 * step), (plus - 2 * middle + minus) / step**2
    assert jet.first[0].real @ direction == pytest.approx(float(first), rel=1e-6)
    assert change(jet.value)[0] == pytest.approx(float(first), rel=1e-6)
    assert change(jet.first)[0] @ direction == pytest.approx(float(second), rel=1e-6)
