"""Metrics on the unit circle, where they have closed forms, and what every metric must be."""

import numpy as np
import pytest
from mobius_flow.core import OptionError, RelaxOptions, minimize
from mobius_flow.core.curve import Mesh
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.energies.quadrature import ENDS, TAIL, Rule
from mobius_flow.core.solve.metrics import METRICS, DenseInnerProduct, MoebiusMetric, SparseInnerProduct, WithoutRule
from mobius_flow.core.solve.metrics.moebius import DifferenceForm, Stencil, stripes
from scipy.integrate import quad
from scipy.special import sici
from shapes import hopf_link, opened, regular_polygon, straight_arc, torus_trefoil


def term_2(k):
    """Term 2 of J_C for u = cos kx: ∬ |u(x) − u(y)|²/r² (1/r² − 1/ϱ²) = 4π ∫_0^π (1 − cos kt)/r² (1/r² − 1/t²) dt."""

    def integrand(t):
        r2 = (2 * np.sin(0.5 * t)) ** 2
        return (1 - np.cos(k * t)) / r2 * (1 / r2 - 1 / t**2)

    return float(4 * np.pi * quad(integrand, 1e-3, np.pi)[0] + 4 * np.pi * 1e-3 * k**2 / 24)


def test_term_2_of_the_first_mode():
    """It is 2π [1/t − cot(t/2)/2]_0^π = 2."""
    assert term_2(1) == pytest.approx(2, abs=1e-8)


def closed_form(name, k):
    """⟨u, u⟩ of u = cos kx on the unit circle."""
    pi = np.pi
    # ∬ |u'(x) − u'(y)|²/ϱ² = 4π k² ∫_0^π (1 − cos kt)/t² dt
    fractional = 4 * pi * k**3 * (sici(k * pi)[0] - (1 - np.cos(k * pi)) / (k * pi))
    return {
        "l2": pi,
        "h1": pi + pi * k**2,
        "h2": pi + pi * k**4,
        "h3-2": pi + fractional,
        "moebius": 2 * pi**2 * k**3 + term_2(k),
    }[name]


@pytest.mark.parametrize("k", [1, 2, 3, 5])
@pytest.mark.parametrize("name", METRICS)
def test_circle(name, k):
    counts = np.array([100, 200, 400])
    values = []
    for n in counts:
        u = np.cos(2 * np.pi * k * np.arange(n) / n)
        values.append(u @ METRICS[name].at(regular_polygon(int(n))).apply(u[:, None])[:, 0])
    errors = np.abs(np.array(values) - closed_form(name, k))
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order > (0.85 if name in ("h3-2", "moebius") else 1.9)
    assert errors[-1] < (0.045 if name in ("h3-2", "moebius") else 0.002) * closed_form(name, k)


@pytest.mark.parametrize("metric", METRICS.values(), ids=list(METRICS))
@pytest.mark.parametrize(
    "curve",
    [torus_trefoil(80), hopf_link(40), opened(hopf_link(40), 1), *map(straight_arc, (1, 2, 3, 60))],
    ids=["trefoil", "link", "arc through a ring", "one edge", "two edges", "three edges", "straight"],
)
def test_symmetric_positive_definite(metric, curve):
    matrix = metric.at(curve).dense()
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12 * np.abs(matrix).max())
    assert np.linalg.eigvalsh(matrix)[0] > 0


RULES = {"midpoint": Rule.gauss(1), "Gauss": Rule.gauss(2), "tails": TAIL, "ends": ENDS}


@pytest.mark.parametrize("arcs", [(), (0,), (0, 1)])
@pytest.mark.parametrize("rule", RULES.values(), ids=list(RULES))
def test_moebius_metric_against_its_definition(rule, arcs):
    """The terms summed pair by pair, on an uneven link two strands of which nearly touch."""
    rng = np.random.default_rng(17)
    curve = hopf_link(9)
    vertices = curve.vertices + 0.1 * rng.normal(size=curve.vertices.shape)
    vertices[9:] += vertices[2] - vertices[12] + 1e-6
    curve = opened(curve.with_vertices(vertices), *arcs)
    u = rng.normal(size=len(curve))
    assert u @ MoebiusMetric(rule).at(curve).dense() @ u == pytest.approx(_by_definition(curve, u, rule), rel=1e-12)


def _by_definition(curve, u, rule):
    mesh, ell = curve.mesh, curve.edge_lengths
    t, omega = rule.points, rule.weights
    at = np.concatenate([np.cumsum(ell[s]) - ell[s] for s in mesh.edge_slices])
    total = float(np.sum(ell * (u[mesh.tails] + u[mesh.heads]) / 2)) ** 2
    for i in range(mesh.edges):
        if not mesh.closed[mesh.edge_component[i]]:
            total += (u[mesh.heads[i]] - u[mesh.tails[i]]) ** 2 / ell[i]
        for j in range(mesh.edges):
            if {mesh.tails[i], mesh.heads[i]} & {mesh.tails[j], mesh.heads[j]}:
                continue
            slope = (u[mesh.heads[i]] - u[mesh.tails[i]]) / ell[i] - (u[mesh.heads[j]] - u[mesh.tails[j]]) / ell[j]
            for a in range(len(t)):
                for b in range(len(t)):
                    x = (1 - t[a]) * curve.vertices[mesh.tails[i]] + t[a] * curve.vertices[mesh.heads[i]]
                    y = (1 - t[b]) * curve.vertices[mesh.tails[j]] + t[b] * curve.vertices[mesh.heads[j]]
                    ui = (1 - t[a]) * u[mesh.tails[i]] + t[a] * u[mesh.heads[i]]
                    uj = (1 - t[b]) * u[mesh.tails[j]] + t[b] * u[mesh.heads[j]]
                    nearest = MoebiusMetric.least_distance * (ell[i] + ell[j])
                    s = 1 / max(np.sum((x - y) ** 2), nearest**2)
                    density = s
                    if (own := mesh.edge_component[i]) == mesh.edge_component[j]:
                        length = ell[mesh.edge_slices[own]].sum() if mesh.closed[own] else np.inf
                        gap = abs(at[i] + t[a] * ell[i] - at[j] - t[b] * ell[j])
                        density -= 1 / max(min(gap, length - gap), nearest) ** 2
                    weight = ell[i] * ell[j] * omega[a] * omega[b]
                    total += weight * s * (slope**2 + (ui - uj) ** 2 * density)
    return total


@pytest.mark.parametrize(("name", "order"), [("l2", -1), ("h1", 1), ("h3-2", 2), ("h2", 3)])
def test_local_metrics_see_no_size(name, order):
    """A(λ P) = λ^(1 − 2s) A(P), also where the parts of a link have other lengths: gradients are the same up to λ."""
    curve = hopf_link(9)
    curve = curve.with_vertices(np.where(np.arange(18)[:, None] < 9, 1.0, 1.7) * curve.vertices)
    form, larger = (METRICS[name].at(curve.with_vertices(s * curve.vertices)).dense() for s in (1.0, 1.4))
    np.testing.assert_allclose(1.4**order * larger, form, atol=1e-13 * np.abs(form).max())


def test_stripes_meet_every_pair_once():
    """With weights that tell pairs apart, on a link of which the longest component takes several stripes."""
    mesh, rng = Mesh((300, 3, 130)), np.random.default_rng(19)
    weights, u = rng.random((mesh.size, mesh.size)), rng.normal(size=mesh.size)
    weights += weights.T
    stencil = Stencil(rng.random(mesh.size), rng.random(mesh.size))
    edges = np.arange(mesh.size)
    counts = mesh.disjoint(edges[:, None], edges[None, :])
    form = DifferenceForm(mesh)
    for stripe in stripes(mesh):
        ones = np.ones((len(stripe.rows), mesh.size - stripe.columns.start))
        stripe.exclude_neighbours(mesh, ones)
        form.add(stripe, np.where(np.isinf(ones), 0.0, weights[stripe.rows, stripe.columns]), stencil, stencil)
    assert len(list(stripes(mesh))) > 5
    values = stencil.tail * u[mesh.tails] + stencil.head * u[mesh.heads]
    expected = np.sum(np.where(counts, weights, 0.0) * np.subtract.outer(values, values) ** 2)
    assert u @ DenseInnerProduct(form.assembled()).apply(u[:, None]) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("energy", "rule"),
    [
        ("moebius", Rule.gauss(1)),
        ("edge", Rule.gauss(1)),
        ("vertex", TAIL),
        ("moebius-k3", Rule.gauss(3)),
        ("tangent-point", ENDS),
    ],
)
def test_the_metric_has_the_energys_rule_unless_told_otherwise(energy, rule):
    """Section 6.1.2 of the paper."""
    assert start_problem(torus_trefoil(30), RelaxOptions(energy=energy)).metric.rule == rule
    other = RelaxOptions(energy=energy, quadrature_points=2)
    assert start_problem(torus_trefoil(30), other).metric.rule == Rule.gauss(2)
    local = RelaxOptions(energy=energy, metric="h2")
    assert start_problem(torus_trefoil(30), local).metric is METRICS["h2"]


class Own(WithoutRule):
    """L² with another weight, under a name that a metric of the table has, too."""

    name = "moebius"
    description = "ten times L²"
    extends_penalty = False
    most_vertices = 100

    def at(self, curve):
        return SparseInnerProduct(10.0 * METRICS["l2"].at(curve).matrix)


def test_a_metric_beside_a_method_that_names_another_is_refused():
    with pytest.raises(OptionError, match=r"flow-l2 and metric h2 contradict each other; .* choose method flow-h2"):
        start_problem(torus_trefoil(20), RelaxOptions(method="flow-l2", metric="h2"))
    assert start_problem(torus_trefoil(20), RelaxOptions(method="flow-l2", metric="l2")).metric.name == "l2"


@pytest.mark.parametrize(
    ("metric", "said"),
    [
        (Own, "metric is <class '.*Own'>; it must be a name or a metric"),
        (5, "metric is 5; it must be a name or a metric"),
    ],
)
def test_what_is_no_metric_is_refused(metric, said):
    with pytest.raises(OptionError, match=said):
        RelaxOptions(metric=metric)


def test_a_metric_that_gives_no_inner_product_is_named(monkeypatch):
    monkeypatch.setattr(Own, "at", lambda _, curve: np.eye(len(curve)))
    with pytest.raises(OptionError, match="metric 'moebius' gives an object of type ndarray at a curve; give an inner"):
        minimize(torus_trefoil(40), RelaxOptions(metric=Own(), vertices=40))
