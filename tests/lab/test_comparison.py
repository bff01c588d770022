"""Methods are compared as they are: step by step, from one start, on one mesh and clock."""

from dataclasses import replace

import numpy as np
import pytest
from changed_moves import change
from mobius_flow.core import Curve, MobiusFlowError, RelaxOptions, minimize, relax
from mobius_flow.core.driver.moves import CoarseStart
from mobius_flow.core.knots import knot
from mobius_flow.lab.compare.comparison import compare
from shapes import torus_trefoil

# evening its edges out costs energy, and their lengths cost a penalised method much to begin with
UNEVEN = Curve(np.delete(torus_trefoil(80).vertices, slice(1, 40, 2), axis=0))


def alone(curve, method, stages=(), **options):
    (history,) = compare(curve, [method], RelaxOptions(**{"vertices": 60} | options), 60.0, stages)
    return history


def test_steps_are_compared_on_one_mesh(monkeypatch):
    """Also of curves that `relax` would begin with fewer vertices, or untangle."""
    change(monkeypatch, CoarseStart, min_vertices=100)
    options = RelaxOptions(radius="none", vertices=600, max_iterations=40)
    (history,) = compare(torus_trefoil(600), ["cg"], options, 60.0)
    fixed = minimize(torus_trefoil(600), replace(options, method="cg", mesh="fixed", edge_lengths="keep"))
    assert (history.energy, history.status) == (fixed.energies, fixed.status.value)
    assert alone(knot("tuzun-sikora"), "lbfgs", max_iterations=2, vertices=None).iterations == 2


def test_methods_are_compared_as_they_are():
    """L-BFGS alone, without the Newton steps that it ends with elsewhere."""
    history = alone(torus_trefoil(60), "lbfgs", tolerance=1e-4)
    usual = minimize(torus_trefoil(60), RelaxOptions(radius="none", vertices=60, mesh="fixed", edge_lengths="keep"))
    assert history.status == "converged"
    assert history.gradient_norm[-1] > 1e3 * usual.last.gradient_norm


def test_methods_are_compared_in_several_metrics():
    """Names are patterns, too; a metric that is the method's own is not said."""
    methods = ["flow-h*", "cg", "penalty-cg:h[12]", "paper:*2"]
    found = compare(torus_trefoil(20), methods, RelaxOptions(vertices=20, max_iterations=0), 60.0)
    labels = ["flow-h1", "flow-h3-2", "flow-h2", "cg", "penalty-cg:h1", "penalty-cg:h2"]
    labels += ["paper:l2", "paper:h3-2", "paper:h2"]
    kinds = ["flow"] * 3 + ["cg"] + ["penalty-cg"] * 2 + ["paper"] * 3
    assert [(each.label, each.kind) for each in found] == list(zip(labels, kinds, strict=True))


def test_lengths_stay_and_penalties_are_left_out():
    history = alone(UNEVEN, "flow-l2", (0, 3), max_iterations=3)
    np.testing.assert_allclose(history.stages[3].edge_lengths, history.stages[0].edge_lengths, rtol=1e-9)
    assert history.rises == 0
    penalised = alone(UNEVEN, "penalty-cg", max_iterations=2)
    start = next(relax(UNEVEN, RelaxOptions(vertices=60, method="penalty-cg")))
    assert penalised.energy[0] == pytest.approx(history.energy[0], rel=1e-12)
    assert start.energy > penalised.energy[0] + 1.0


TAKES_OTHER_STEPS = ({"hops": 3}, {"mesh": "finer"}, {"stability": True}, {"time_limit": 3.0}, {"untangle": "always"})


@pytest.mark.parametrize(
    ("methods", "options", "said"),
    [
        *(
            (["cg"], each, f"{next(iter(each))}=.* has no part in a comparison of methods")
            for each in TAKES_OTHER_STEPS
        ),
        ("lbfgs", {}, "methods is 'lbfgs'; give a list"),
        (["lbfgs", "cg", "lbfgs"], {}, "methods are lbfgs,cg,lbfgs; give each of them once"),
        (["cg", "cg:moe*"], {}, "methods are cg,cg:moe.*; give each of them once"),
        (["cg:h5"], {}, "metric 'h5' is unknown"),
    ],
    ids=str,
)
def test_what_cannot_be_compared_is_refused(methods, options, said):
    with pytest.raises(MobiusFlowError, match=said):
        compare(torus_trefoil(20), methods, RelaxOptions(**options), 60.0)
