"""Edge lengths on their way to the targets: they arrive, soon, and what that costs is told of."""

import itertools

import numpy as np
import pytest
from mobius_flow.core import Curve, RelaxOptions, Status, minimize
from shapes import torus_trefoil


def uneven_circle() -> Curve:
    """A circle whose longest edge is four times the shortest; only that is left to mend."""
    gaps = 1 + 0.6 * np.cos(2 * np.pi * np.arange(60) / 60)
    t = 2 * np.pi * np.cumsum(gaps) / gaps.sum()
    return Curve(np.stack([np.cos(t), np.sin(t)], axis=1))


@pytest.mark.parametrize("method", ["lbfgs", "trust-region", "flow-moebius", "implicit-moebius"])
def test_unequal_edges_become_equal(method):
    result = minimize(torus_trefoil(70), RelaxOptions(method=method, max_iterations=25, vertices=70))
    assert result.last.edge_length_error < 1e-8


@pytest.mark.parametrize("method", ["lbfgs", "cg", "flow-moebius", "flow-h1"])
def test_lengths_do_not_creep_where_nothing_is_left_to_gain(method):
    """Steps may miss their prediction there, which is next to nothing; otherwise they are halved again and again."""
    result = minimize(uneven_circle(), RelaxOptions(method=method, vertices=60))
    assert result.status is Status.CONVERGED
    assert result.last.edge_length_error < 1e-8
    assert len(result.energies) < 40


def test_energy_spent_on_edge_lengths_is_told_of():
    """A circle with uneven edges has nothing to gain, and in L² lengths change in rough motions."""
    iterates = []
    result = minimize(uneven_circle(), RelaxOptions(method="flow-l2", max_iterations=10, vertices=60), iterates.append)
    rises = [b.energy - a.energy for a, b in itertools.pairwise(iterates) if b.energy > a.energy * (1 + 1e-9)]
    assert len(rises) > 3
    told = f"the energy rose in {len(rises)} of {iterates[-1].index} steps, by {sum(rises):.3g} in total"
    assert told in result.message
    assert iterates[-1].edge_length_error < iterates[0].edge_length_error
    assert "rose" not in minimize(torus_trefoil(60), RelaxOptions(max_iterations=5)).message


def test_a_direction_without_length_is_tried_all_the_same():
    """In L² nothing of a triangle's gradient is left beside the lengths, which are off their targets still."""
    corners = [[0.12573022, -0.13210486], [0.64042265, 0.10490012], [-0.53566937, 0.36159505]]
    triangle, options = Curve(np.array(corners)), RelaxOptions(method="flow-l2", vertices=3, max_iterations=2)
    result = minimize(triangle, options)
    assert result.status is Status.CONVERGED
    assert result.last.gradient_norm == 0.0
    assert result.last.edge_length_error < 1e-6
