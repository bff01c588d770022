"""Outcomes are the same wherever they are computed: sums are rounded otherwise by other processors' kernels.

`.ci/run` runs these tests under several of them; here a curve that is turned, and moved by an ulp, stands for them.
"""

from dataclasses import replace

import numpy as np
import pytest
from families import crossed
from mobius_flow.core import Curve, Mesh, Obstacle, minimize
from scipy.spatial.transform import Rotation
from shapes import torus_trefoil
from solids import box, rod
from tasks import wanted

pytestmark = pytest.mark.kernels

t = 2.0 * np.pi * np.arange(30) / 30
BENT = Curve(
    np.column_stack([np.cos(t) + 0.2 * np.cos(2 * t + 0.5), np.sin(t) - 0.1 * np.sin(3 * t), np.sin(2 * t) / 3])
)
s = np.linspace(0.0, 1.0, 24)
ARC = Curve(np.column_stack([np.cos(4 * s), np.sin(4 * s), s + 0.1 * np.sin(9 * s)]), Mesh((24,), closed=(False,)))
# nearer the ridge between two minima, a millionth of the energy apart, rounding does decide
LINK = Curve.from_components([BENT.vertices, BENT.vertices[:, [0, 2, 1]] * [1.0, 1.0, 0.8] + [1.1, 0.2, 0.3]])
KINDS = {
    "plain": wanted(torus_trefoil(36)),
    "pinned": wanted(BENT, pins=(0, 9, 17), mesh="fixed"),
    "around a rod": wanted(BENT, avoid=(rod(0.1, 0.05),), pins=(0,)),  # along the rod it would slide at no cost
    "in a box": wanted(BENT, avoid=(box(-1.4, 1.4),), pins=(0, 9, 17)),
    "arc": wanted(ARC),
    "link": wanted(LINK),
}


def relaxed(kind, seed, method, tolerance):
    """A curve's relaxation, or that of the same curve elsewhere, as floating-point numbers have it."""
    task, options = KINDS[kind]
    options = replace(options, method=method, tolerance=tolerance, vertices=len(task.curve), max_iterations=120)
    if seed is None:
        return minimize(task, options)
    turn = Rotation.random(random_state=seed).as_matrix()
    moved = task.curve.vertices @ turn.T
    moved = np.nextafter(moved, np.random.default_rng(seed).choice([-np.inf, np.inf], size=moved.shape))
    walls = tuple(Obstacle(each.vertices @ turn.T, each.faces, each.name) for each in task.obstacles)
    return minimize(replace(task, curve=task.curve.with_vertices(moved), obstacles=walls), options)


@pytest.mark.parametrize(
    ("kind", "rule"), crossed(KINDS, [("lbfgs", 1e-4), ("trust-region", 1e-4), ("trust-region", 1e-7)])
)
def test_rounding_decides_nothing(kind, rule):
    """Not how a run ends, and of its energy what the tolerance leaves open, its square at most, as rounding does."""
    method, tolerance = rule
    usual = relaxed(kind, None, method, tolerance)
    assert usual.outcome.converged
    scale = max(usual.last.energy, 4.0)
    other = relaxed(kind, 1, method, tolerance)
    assert other.status is usual.status
    assert other.fallback_steps == usual.fallback_steps == ()
    assert other.last.energy == pytest.approx(usual.last.energy, abs=scale * max(tolerance**2, 1e-12))
    assert other.certified
