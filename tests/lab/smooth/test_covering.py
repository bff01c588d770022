"""Balls of coefficients, spreads that cover curves and polygons, and the proof that a polygon follows its curve."""

from dataclasses import replace

import numpy as np
import pytest
from fourier_curves import CIRCLE, CUSPS, DOUBLE_POINT, DUAL_CIRCLE, ELLIPSE, fitted, values
from mobius_flow.core import Curve, CurveError, Mesh
from mobius_flow.core.knots.inscribed import equal_steps, is_isotopic
from mobius_flow.core.knots.shapes import shapes

covering = pytest.importorskip("mobius_flow.lab.smooth.covering")
TREFOIL = shapes()["3_1"].coefficients[0]
LINK = shapes()["L6a4"].coefficients


def norm(vectors):
    return np.linalg.norm(vectors.real, axis=-1) + np.linalg.norm(vectors.imag, axis=-1)


@pytest.fixture(scope="module")
def trefoil():
    return covering.CurveArcs.of(TREFOIL)


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("height", [0.0, 0.005, 0.02])
@pytest.mark.parametrize("level", [4, 6, 9])
def test_curves_are_within_their_spreads(trefoil, order, height, level):
    reach = covering._HALVES + height
    spread = trefoil.spread(order, reach)
    for node in 2**level + np.arange(0, 2**level, 2 ** (level - 3)):
        center = (node - 2**level + 0.5) / 2**level
        np.testing.assert_allclose(trefoil.centers[node], values(TREFOIL, [center])[0].real, atol=1e-13)
        x, y = np.meshgrid(np.linspace(-1, 1, 9) * covering._HALVES[level], np.linspace(-1, 1, 9) * height)
        off = values(TREFOIL, center + (x + 1j * y).ravel(), order) - values(TREFOIL, [center], order).real
        assert norm(off).max() <= spread[node] + 1e-13
        if reach[level] < 0.02:
            assert spread[node] <= 2.0 * norm(off).max()


def test_curves_that_are_flat_to_a_high_order_turn_somewhere_else():
    """(1 + cos 2πt)⁸ is 0 at ½, and its first 15 derivatives are, but it is 256 at 0."""
    arcs = covering.CurveArcs.of(fitted(np.outer((1.0 + np.cos(2.0 * np.pi * np.arange(32) / 32)) ** 8, [1, 0, 0]), 8))
    np.testing.assert_allclose(arcs.centers[1], 0.0, atol=1e-10)
    assert arcs.spread(0, covering._HALVES)[1] >= 256.0


@pytest.mark.parametrize("count", [20, 77])
def test_polygons_are_within_the_spreads_around_the_curve(trefoil, count):
    noise = 0.01 * np.random.default_rng(1).normal(size=(count, 3))
    vertices = values(TREFOIL, np.arange(count) / count).real + noise
    turns = np.roll(noise, -1, axis=0) - noise
    edges = covering.PolygonEdges(
        count, np.linalg.norm(noise, axis=1).max(), count * np.linalg.norm(turns, axis=1).max()
    )
    moved = replace(trefoil, edges=edges)
    spreads = [moved.spread(order, covering._HALVES) for order in (0, 1)]
    slopes = count * (np.roll(vertices, -1, axis=0) - vertices)
    for node in 2**7 + np.arange(0, 2**7, 3):
        t = (node - 2**7 + np.linspace(0.0, 1.0, 33)) / 2**7
        edge, part = (t * count).astype(int) % count, (t * count % 1.0)[:, None]
        points = (1.0 - part) * vertices[edge] + part * np.roll(vertices, -1, axis=0)[edge]
        tangent = values(TREFOIL, t[16:17], 1)[0].real
        assert np.linalg.norm(points - moved.centers[node], axis=1).max() <= spreads[0][node]
        assert np.linalg.norm(slopes[edge] - tangent, axis=1).max() <= spreads[1][node]


@pytest.mark.parametrize("curves", [[ELLIPSE], [TREFOIL], [CIRCLE, DUAL_CIRCLE], LINK[:2]])
@pytest.mark.parametrize("share", [0.05, 0.15, 0.25])
def test_ratios_are_below_their_bound_on_a_dense_mesh(curves, share):
    arcs = [covering.CurveArcs.of(c) for c in curves]
    height = share * arcs[0].height
    bound = covering.cover(arcs[0], arcs[-1], height)
    s, t = np.arange(700) / 700 + 1j * height, np.arange(700) / 700
    speeds = norm(values(curves[0], s, 1))[:, None] * norm(values(curves[-1], t, 1))
    ratios = speeds / np.abs(((values(curves[0], s)[:, None] - values(curves[-1], t)) ** 2).sum(axis=2))
    steps = (s[:, None] - t + 0.5).real % 1.0 - 0.5 + 1j * height
    near = 400.0 / np.abs(steps) ** 2 if len(curves) == 1 else np.zeros(steps.shape)
    assert (ratios <= np.maximum(bound, near)).all()
    assert bound < 2e3 * ratios.max()


@pytest.mark.parametrize(("part", "covered"), [(1.001, False), (0.25, True)])
def test_strips_end_before_speeds_vanish(part, covered):
    """γ'² = 4 sin² + cos² of 2πs is 0 where tanh(2π Im s) = ½."""
    arcs = covering.CurveArcs.of(ELLIPSE)
    assert (covering.cover(arcs, arcs, part * np.arctanh(0.5) / (2.0 * np.pi)) is not None) == covered


@pytest.mark.parametrize(("part", "covered"), [(1.001, False), (0.6, True)])
@pytest.mark.parametrize("gap", [0.3, 0.01])
def test_strips_end_before_parallel_circles_meet(part, covered, gap):
    """(γ₁(s) − γ₂(t))² = 2 − 2 cos 2π(s − t) + gap²."""
    first, second = (covering.CurveArcs.of(CIRCLE + np.outer([1, 0], [0, 0, z])) for z in (0.0, gap))
    height = np.arccosh(1.0 + 0.5 * gap**2) / (2.0 * np.pi)
    assert (covering.cover(first, second, part * height) is not None) == covered


@pytest.mark.parametrize("c", [DOUBLE_POINT, CUSPS, CIRCLE[[0, 0, 1]], CIRCLE[:1], np.zeros((3, 3))])
def test_what_meets_itself_is_not_covered(c):
    arcs = covering.CurveArcs.of(c)
    assert covering.cover(arcs, arcs) is None


@pytest.mark.parametrize(
    "c", [CIRCLE[:, :2], CIRCLE[0], np.empty((0, 3)), CIRCLE * np.nan, np.where(CIRCLE, np.inf, 0)]
)
def test_coefficients_of_no_curve(c):
    with pytest.raises(CurveError, match="must be finite numbers, of shape"):
        covering.scaled([c])


@pytest.mark.parametrize("nodes", [1, 9, 100])  # fewer than modes too, where frequencies are folded
@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("shift", [0, 1])
def test_points_are_those_of_the_series(nodes, order, shift):
    high, low = covering.points(TREFOIL, nodes, order, shift)
    t = (np.arange(nodes) + shift / 2) / nodes
    np.testing.assert_allclose(high, values(TREFOIL, t, order).real.T, rtol=1e-11, atol=1e-9)
    with covering.precise():
        for j in range(0, nodes, 8):
            wave = [covering.acb(covering.arb(k * (2 * j + shift)) / nodes).exp_pi_i() for k in range(len(TREFOIL))]
            wave = [w * covering.acb(0, 2 * k * covering.arb.pi()) ** order for k, w in enumerate(wave)]
            for a in range(3):
                exact = sum(
                    (covering.acb(complex(c)) * w for c, w in zip(TREFOIL[:, a], wave, strict=True)), covering.acb(0)
                )
                assert abs(float(exact.real - high[a, j] - low[a, j])) < 2.0**-100 * max(1.0, abs(high[a, j]))


isotopy = pytest.importorskip("mobius_flow.lab.smooth.isotopy")


def is_followed(shape, polygon):
    """Whether a fine polygon in a smooth curve moves to another without contact, by collision detection."""
    fine = shape.polygon([4 * max(n, 100) for n in polygon.mesh.component_sizes])
    return is_isotopic(fine, equal_steps(fine), polygon, equal_steps(polygon))


@pytest.mark.parametrize("name", ["0_1", "3_1", "8_19", "9_40", "L2a1", "L6a4"])
def test_inscribed_polygons_follow_the_curve(name):
    shape = shapes()[name]
    polygon = isotopy.inscribed(shape.coefficients)
    assert isotopy.proves(shape.coefficients, polygon)
    assert len(polygon) <= 100 * len(polygon.components) + 40 * sum(len(c) for c in shape.coefficients)
    assert is_followed(shape, polygon)


@pytest.mark.parametrize("exponent", [-1000, -530, 900])
def test_proofs_do_not_depend_on_the_unit(exponent):
    c = np.ldexp(1.0, exponent) * shapes()["3_1"].coefficients[0]
    polygon = isotopy.inscribed([c])
    assert len(polygon) == len(isotopy.inscribed(shapes()["3_1"].coefficients))
    assert isotopy.proves([c], polygon)
    assert not isotopy.proves([2.0**-40 * c], polygon)
    assert not isotopy.proves([c], polygon.with_vertices(polygon.vertices[::3].repeat(3, axis=0)[: len(polygon)]))


@pytest.mark.parametrize("name", ["3_1", "4_1", "7_4"])
def test_nothing_is_proved_of_polygons_that_do_not_follow(name):
    shape, count = shapes()[name], 0
    for n in range(3, 40, 2):
        polygon = shape.polygon([n])
        if not is_followed(shape, polygon):
            count += 1
            assert not isotopy.proves(shape.coefficients, polygon)
    assert count


def test_polygons_need_not_be_inscribed_exactly():
    c = shapes()["3_1"].coefficients
    polygon = isotopy.inscribed(c)
    noise = np.random.default_rng(3).normal(size=polygon.vertices.shape)
    assert isotopy.proves(c, polygon.with_vertices(polygon.vertices + 1e-4 * noise))
    assert not isotopy.proves(c, polygon.with_vertices(polygon.vertices + 0.3 * noise))


def test_many_vertices_out_of_order_prove_nothing():
    """They are where they should be, nearly, but the polygon turns back."""
    shape = shapes()["3_1"]
    vertices = shape.polygon([2_000]).vertices[np.arange(2_000) ^ 1]
    assert not isotopy.proves(shape.coefficients, Curve(vertices))


def test_components_that_were_pulled_through_each_other():
    near = DUAL_CIRCLE + np.array([[1.7 - np.sqrt(2.0), 0.0, 0.0], [0.0, 0.0, 0.0]])  # .3 apart
    first, second = (values(c, np.arange(400) / 400).real for c in (CIRCLE, near))
    for shift, follows in (0.1, True), (0.35, False):
        polygons = Curve.from_components([first, second + np.array([shift, 0.0, 0.0])])
        assert isotopy.proves([CIRCLE, near], polygons) == follows


def test_other_numbers_of_components_arcs_and_planes():
    c = [CIRCLE]
    polygon = isotopy.inscribed(c)
    assert not isotopy.proves(c, Curve.from_components([polygon.vertices, polygon.vertices + 5.0]))
    assert not isotopy.proves(c, Curve(polygon.vertices, Mesh((len(polygon),), (False,))))
    assert not isotopy.proves(c, Curve(polygon.vertices[:, :2]))


@pytest.mark.parametrize("c", [DOUBLE_POINT, CUSPS, np.zeros((1, 3))])
def test_curves_without_a_type(c):
    with pytest.raises(CurveError, match="meets itself or has a cusp, or nearly so: its type cannot be proved"):
        isotopy.inscribed([c])
    with pytest.raises(CurveError, match="its type cannot be proved"):
        isotopy.proves([c], isotopy.inscribed([CIRCLE]))
