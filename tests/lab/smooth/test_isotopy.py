"""Polygons have the type of a smooth curve where this is proved, and nothing is proved of those which may not."""

import numpy as np
import pytest
from fourier_curves import CIRCLE, CUSPS, DOUBLE_POINT, DUAL_CIRCLE, values
from mobius_flow.core import Curve, CurveError, Mesh
from mobius_flow.core.knots.inscribed import equal_steps, is_isotopic
from mobius_flow.core.knots.shapes import shapes

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
