"""Knots in ropes: their types where ends are joined far away, and room enough to be pulled tight."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.collision import thickness
from mobius_flow.core.knots import knot, knot_type
from mobius_flow.core.knots.closures import closed_far_away
from mobius_flow.core.knots.formulas import ROPES

TYPES = {"open-figure-eight": "4_1", "open-square": "3_1#m3_1", "open-granny": "m3_1#m3_1"}
TYPES |= {"sheet-bend": "m6_2", "bowline": "6_3"}


def closed(curve):
    """One closed curve: bends of two ropes are joined in their plane, upper to upper ends and lower to lower ones."""
    if len(curve.components) == 1:
        return closed_far_away(curve)
    left, right = (part if part[0, 1] > part[-1, 1] else part[::-1] for part in curve.components)
    return Curve(np.concatenate([left, [[-40, -40, 0], [40, -40, 0]], right[::-1], [[40, 40, 0], [-40, 40, 0]]]))


@pytest.mark.parametrize("name", ROPES)
@pytest.mark.parametrize("vertices", [100, 200])
def test_types_and_thickness(name, vertices):
    curve = knot(name, vertices)
    assert len(curve) == vertices
    assert not any(curve.mesh.closed)
    assert curve.length / thickness(curve) < 250.0
    ends = curve.vertices[curve.mesh.ends.ravel()]
    assert np.abs(ends[:, 0]).min() >= np.abs(curve.vertices[:, 0]).max() - 6.0  # nothing can slip over them
    found = knot_type(closed(curve))
    assert found.proved
    assert found.names == (TYPES[name],)


def test_too_few_vertices_are_refused():
    with pytest.raises(CurveError, match="99 vertices are too few for this knot; give 100 or more"):
        knot("bowline knot", 99)
