"""Random closures of open curves."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.curve import Mesh
from mobius_flow.core.knots import knot
from mobius_flow.core.knots.closures import closed_far_away, closures


def test_deep_knots_stay_and_shallow_ones_depend_on_the_direction():
    assert closures(knot("overhand"), 20) == {"3_1": 20}
    trefoil = knot("3_1", 120)
    cut = Curve(trefoil.vertices[: len(trefoil) * 2 // 3], Mesh((len(trefoil) * 2 // 3,), (False,)))
    types = closures(cut, 60, seed=3)
    assert types == closures(cut, 60, seed=3)
    assert types != closures(cut, 60, seed=4)
    assert set(types) == {"3_1", "unknot"}


def test_links_close_component_by_component():
    hopf = knot("hopf", 80)
    arc = Curve(hopf.vertices[:-1], Mesh((40, 39), (True, False)))
    closed = closed_far_away(arc, (0.0, 0.6, 0.8))
    check_embedded(closed)
    assert closed.mesh.all_closed
    np.testing.assert_array_equal(closed.components[0], hopf.components[0])
    both = Curve(hopf.vertices[1:-1], Mesh((39, 39), (False, False)))
    check_embedded(closed_far_away(both, (0.0, 0.6, 0.8)))


@pytest.mark.parametrize(
    ("curve", "count", "said"),
    [
        (knot("3_1"), 5, "all components are closed"),
        (knot("overhand"), 0, "number of closures is 0"),
        (Curve(np.eye(4)[:, :2] + [[0.0, 3.0]], Mesh((4,), (False,))), 5, "dimension 2"),
    ],
)
def test_refusals(curve, count, said):
    with pytest.raises(CurveError, match=said):
        closures(curve, count)
