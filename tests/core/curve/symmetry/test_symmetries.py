"""The symmetry groups of curves: their names, whatever way the curve lies, and what they leave exactly in place."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, OptionError
from mobius_flow.core.curve.symmetry import SymmetryGroup, symmetries
from mobius_flow.core.curve.symmetry.group import schoenflies
from mobius_flow.core.knots import smooth_knot, torus_knot
from mobius_flow.lab.atlas.entries import standing
from scipy.spatial.transform import Rotation
from shapes import chain_of_rings, half_circle, regular_polygon

TURN = Rotation.from_rotvec([0.3, -1.1, 2.0]).as_matrix()
X, Z, INVERSION = np.diag([1.0, -1.0, -1.0]), np.diag([-1.0, -1.0, 1.0]), -np.eye(3)
CORNER = np.roll(np.eye(3), 1, axis=0)  # a third of a turn about (1, 1, 1)
FIFTH = Rotation.from_rotvec(0.4 * np.pi * np.array([0.0, 1.0, 0.5 + 0.5 * np.sqrt(5.0)]) / 1.902113032590307)


def about_z(turns):
    return Rotation.from_rotvec([0.0, 0.0, 2.0 * np.pi * turns]).as_matrix()


FLAT, UPRIGHT = np.diag([1.0, 1.0, -1.0]), np.diag([1.0, -1.0, 1.0])  # reflections in planes
GENERATORS = {
    "C1": [],
    "Cs": [FLAT],
    "Ci": [INVERSION],
    "C5": [about_z(1 / 5)],
    "C3v": [about_z(1 / 3), UPRIGHT],
    "C2v": [Z, UPRIGHT],
    "C4h": [about_z(1 / 4), FLAT],
    "C2h": [Z, FLAT],
    "S4": [FLAT @ about_z(1 / 4)],
    "S6": [FLAT @ about_z(1 / 6)],
    "S10": [FLAT @ about_z(1 / 10)],
    "D2": [Z, X],
    "D7": [about_z(1 / 7), X],
    "D2h": [Z, X, INVERSION],
    "D3h": [about_z(1 / 3), X, FLAT],
    "D2d": [FLAT @ about_z(1 / 4), X],
    "D3d": [about_z(1 / 3), X, INVERSION],
    "T": [CORNER, Z],
    "Td": [CORNER, FLAT @ about_z(1 / 4)],
    "Th": [CORNER, Z, INVERSION],
    "O": [CORNER, about_z(1 / 4)],
    "Oh": [CORNER, about_z(1 / 4), INVERSION],
    "I": [CORNER, FIFTH.as_matrix()],
    "Ih": [CORNER, FIFTH.as_matrix(), INVERSION],
}


def generated(matrices):
    found = [np.eye(3)]
    for each in found:  # which grows
        for one in matrices:
            if not any(np.allclose(each @ one, other) for other in found):
                found.append(each @ one)
    return np.stack(found)


@pytest.mark.parametrize("name", GENERATORS)
def test_every_kind_of_group_has_its_name(name):
    noise = 1.0 + 0.01 * np.random.default_rng(1).normal(size=(3, 3))
    assert schoenflies(noise * (TURN @ generated(GENERATORS[name]) @ TURN.T)) == name


def hidden(curve):
    """The same curve elsewhere, with components in another order, beginning elsewhere and run through backwards."""
    parts = [np.roll(part[::-1], 17, axis=0) for part in curve.components[::-1]]
    return Curve.from_components([3.0 * part @ TURN.T + [10.0, -5.0, 2.0] for part in parts])


def ellipses(count):
    """The Borromean rings as three ellipses."""
    t = 2.0 * np.pi * np.arange(count) / count
    one = np.stack([2.0 * np.cos(t), np.sin(t), 0.0 * t], axis=1)
    return Curve.from_components([np.roll(one, k, axis=1) for k in range(3)])


CURVES = {
    "D2": lambda: torus_knot(3, 2),
    "D3": lambda: torus_knot(2, 3, 100),  # not a multiple of three
    "D9": lambda: torus_knot(2, 9),
    "S4": lambda: smooth_knot("4_1"),
    "S8": lambda: smooth_knot("8_18"),
    "D2d": lambda: smooth_knot("L2a1"),
    "Th": lambda: ellipses(50),
    "D2h": lambda: Curve(regular_polygon(40).vertices * [1.0, 0.5, 0.0]),
    "D4h": lambda: Curve(regular_polygon(4).vertices),
    "C1": lambda: smooth_knot("6_3"),
}


@pytest.mark.parametrize("name", CURVES)
def test_curves_have_their_groups_wherever_they_lie(name):
    curve = CURVES[name]()
    group, other = symmetries(curve), symmetries(hidden(curve))
    assert group.name == other.name == symmetries(curve.with_vertices(-curve.vertices)).name == name
    assert other.distance == pytest.approx(group.distance, abs=2e-3)
    assert group.distance < 0.01


@pytest.mark.parametrize("begin", [0.0, 0.2, 0.5, 0.8])
def test_groups_are_found_wherever_samples_lie(begin):
    """On long curves samples are far apart, and where a direction is turned none lies on the image of another."""
    curve = torus_knot(3, 7, 210)
    tail, head = curve.vertices[:2]
    shifted = np.vstack([tail + begin * (head - tail), curve.vertices[1:], tail[None]])
    shifted = shifted if begin else curve.vertices
    assert symmetries(Curve(shifted), 1e-6).name == "D7"


@pytest.mark.parametrize("name", CURVES)
def test_the_mean_is_exactly_symmetric(name):
    curve = hidden(CURVES[name]())
    group = symmetries(curve)
    sizes = [part + 1 for part in curve.mesh.component_sizes]
    mean, symmetry, begins = group.symmetrised(curve, sizes)
    assert symmetry.error(mean) < 1e-12
    kept = mean.mesh == curve.mesh
    assert kept or all(n >= m for n, m in zip(mean.mesh.component_sizes, sizes, strict=True))
    assert len(begins) == len(curve.components)
    products = np.einsum("gij,hjk->ghik", group.matrices, group.matrices).reshape(-1, 1, 3, 3)
    assert np.abs(products - group.matrices).max(axis=(2, 3)).min(axis=1).max() < 1e-14  # a group
    for image in symmetry.images:
        assert sorted(image) == list(range(len(mean)))
        ends = np.sort(np.stack([image, image[mean.mesh.cycle]]), axis=0)
        edges = np.sort(np.stack([np.arange(len(mean)), mean.mesh.cycle]), axis=0)
        assert set(map(tuple, ends.T)) == set(map(tuple, edges.T))  # edges go to edges
    again, _, begins = symmetries(mean).symmetrised(mean, mean.mesh.component_sizes)  # which keeps the vertices
    np.testing.assert_allclose(again.vertices, mean.vertices, atol=1e-10)
    assert not any(begins)


def test_subgroups_are_found_by_name():
    group = symmetries(ellipses(48))
    for name, order in {"C1": 1, "Ci": 2, "C3": 3, "S6": 6, "D2": 4, "D2h": 8, "C2v": 4, "T": 12, "Th": 24}.items():
        part = group.subgroup(name)
        assert isinstance(part, SymmetryGroup)
        assert (part.name, len(part.elements)) == (name, order)
    assert group.subgroup("C4") is None


RING, COARSE = (regular_polygon(n).vertices for n in (80, 20))
UP = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    ("rings", "name"),
    [([RING], "D∞h"), ([COARSE], "D∞h"), ([RING, RING + UP], "D∞h"), ([RING, 0.5 * RING + UP], "C∞v")],
)
def test_what_is_round_has_a_name_but_no_elements(rings, name):
    group = symmetries(Curve.from_components(rings))
    assert group.name == name
    assert len(group.elements) == 1


def test_tolerances_are_what_they_say():
    curve = torus_knot(3, 4, 96)
    rough = curve.with_vertices(curve.vertices + 0.02 * np.random.default_rng(1).normal(size=(96, 3)))
    assert symmetries(rough, 1e-3).name == "C1"
    group = symmetries(rough, 0.1)
    assert group.name == "D4"
    assert 1e-3 < group.distance < 0.1
    with pytest.raises(OptionError, match="tolerance is 0"):
        symmetries(curve, 0.0)


@pytest.mark.parametrize(
    ("curve", "said"),
    [
        (half_circle(20), "component 1 is open; symmetries are for closed components"),
        (regular_polygon(20, 2), "the curve is in dimension 2; symmetries are for curves in space"),
        (chain_of_rings(11, (20,)), "the curve has 11 components; symmetries are found with up to 10"),
    ],
)
def test_curves_without_groups_are_refused(curve, said):
    with pytest.raises(CurveError) as caught:
        symmetries(curve)
    assert str(caught.value) == said


UPRIGHT_ELEMENTS = {"D3": 6, "S4": 4, "Th": 6, "D4h": 16}  # that keep the third axis, either way up


@pytest.mark.parametrize("name", [*UPRIGHT_ELEMENTS, "D2", "D2h", "C1"])
def test_curves_stand_on_their_axis_of_highest_order(name):
    curve = hidden(CURVES[name]())
    group = symmetries(curve)
    turn = standing(curve, group)
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(turn) > 0.0
    stood = turn @ group.matrices @ turn.T
    points = (curve.vertices - group.centre) @ turn.T
    if name in UPRIGHT_ELEMENTS:
        assert np.count_nonzero(np.abs(stood[:, 2, 2]) > 0.99) == UPRIGHT_ELEMENTS[name]
    else:
        assert np.square(points).sum(axis=0).argmin() == 2
    if name.startswith("D"):  # one of order two is upwards
        assert any(np.allclose(each, np.diag([-1.0, 1.0, -1.0]), atol=0.05) for each in stood)
        assert points[:, 1].max() > -points[:, 1].min() - 1e-6
