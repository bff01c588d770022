"""The least energy that relaxations lead to: 4 for each component unless it seems knotted."""

import numpy as np
import pytest
from mobius_flow.addon.engine.rest import CIRCLE, target_of
from mobius_flow.core import Curve, Mesh, MoebiusEnergy, Obstacle, RelaxOptions
from mobius_flow.core.knots import knot, overhand
from shapes import hopf_link, torus_trefoil
from tasks import wanted

POST = Obstacle([[0.0, 0.0, -9.0], [0.0, 0.0, 9.0]], [[0, 1]])
LINK = Curve.from_components([*hopf_link(24).components, overhand(60).vertices + 20], (True, True, False))
TARGETS = {
    "an unknot may become a circle": (knot("culprit"), {}, "circle = 4"),
    "so may another": (knot("goeritz"), {}, "circle = 4"),
    "and another": (knot("thistlethwaite"), {}, "circle = 4"),
    "a knot does not": (knot("3_1"), {}, None),
    "nor an achiral one": (knot("4_1"), {}, None),
    "nor one that is not alternating": (knot("8_19"), {}, None),
    "a link has a circle's energy for each component": (hopf_link(24), {}, "floor = 8"),
    "arcs add nothing": (LINK, {}, "floor = 8"),
    "an arc may become straight": (overhand(60), {}, "straight = 0"),
    "pins keep it from that": (overhand(60), {"pins": (0, 59)}, None),
    "and so do obstacles": (knot("culprit"), {"avoid": (POST,)}, None),
    "other energies have other minima": (knot("culprit"), {"energy": "edge"}, None),
}


@pytest.mark.parametrize(("curve", "settings", "label"), TARGETS.values(), ids=TARGETS)
def test_where_curves_lead(curve, settings, label):
    target = target_of(*wanted(curve, **settings))
    assert (target and target.label) == label
    assert target is None or target.energy == float(label.split()[-1])


def test_the_type_of_curves_with_very_many_vertices_is_left_open():
    assert target_of(torus_trefoil(60), RelaxOptions(), most=59).label == "circle = 4"
    assert target_of(torus_trefoil(59), RelaxOptions(), most=59) is None


@pytest.mark.parametrize("n", [50, 400])
def test_it_is_the_energy_of_the_circle_and_of_the_segment(n):
    angles = 2 * np.pi * np.arange(n) / n
    circle = Curve(np.column_stack([np.cos(angles), np.sin(angles), 0 * angles]))
    assert MoebiusEnergy().value(circle) == pytest.approx(CIRCLE, rel=10 / n**2)
    segment = Curve(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]]), Mesh((3,), (False,)))
    assert MoebiusEnergy().value(segment) == pytest.approx(0.0, abs=1e-12)
