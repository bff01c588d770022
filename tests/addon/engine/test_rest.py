"""Minimum or saddle, in a sentence."""

import numpy as np
import pytest
from mobius_flow.addon.engine import rest
from mobius_flow.addon.engine.rest import Rest
from mobius_flow.core import CurveError, RelaxOptions, minimize
from mobius_flow.core.knots import torus_knot
from shapes import lattice_knot, regular_polygon

OPTIONS = RelaxOptions(max_iterations=3)  # what was asked of the relaxation before does not matter


def as_stored(curve):
    return curve.with_vertices(curve.vertices.astype(np.float32))


def test_a_minimum():
    found = Rest.of(as_stored(minimize(torus_knot(2, 3, 120)).curve), OPTIONS)
    assert found == Rest(0, "at a minimum, no small motion lowers the energy")


def test_a_saddle():
    curve = minimize(torus_knot(3, 4, 160), RelaxOptions(vertices=160)).curve
    assert Rest.of(as_stored(curve), OPTIONS) == Rest(
        2, "at a saddle, 2 independent ways lead down; press Leave Saddle"
    )


def test_a_curve_that_was_stopped_on_its_way(monkeypatch):
    monkeypatch.setattr(rest, "_ITERATIONS", 3)
    assert Rest.of(lattice_knot("4_1"), OPTIONS) == Rest(None, "not at rest yet; press Continue first")


def test_too_many_points():
    with pytest.raises(CurveError, match=r"have 1501 points; minimum or saddle is told up to 1500$"):
        Rest.of(regular_polygon(1501), OPTIONS)
