"""Bars on a terminal."""

import pytest
from mobius_flow.cli.progress import Progress, bar
from mobius_flow.core import Curve, Mesh, RelaxOptions, minimize


def test_a_straight_segment_whose_energy_is_zero_has_a_bar_too():
    pytest.importorskip("tqdm")
    segment = Curve([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], Mesh((2,), (False,)))
    options = RelaxOptions(vertices=3)
    iterates = []
    progress = Progress(options)
    with bar(True) as shown:
        assert shown is not None
        result = minimize(segment, options, lambda each: (iterates.append(each), progress.update(shown, each)))
    assert result.energies[-1] == 0.0
    assert result.outcome.converged
