"""Smooth layouts of diagrams: the diagram, all of it and nothing else, and as regular as it can be."""

from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.core import CurveError
from mobius_flow.core.knots import HARD_UNKNOTS, KNOTS, layout
from mobius_flow.core.knots.braids import braid_diagram
from mobius_flow.core.knots.diagrams import Diagram, diagram_of
from mobius_flow.core.knots.diagrams.projection import plane_crossings
from mobius_flow.core.knots.layout import laid_out, upright
from mobius_flow.core.knots.names import named_diagram
from taylor import taylor_slope

LOOP = Diagram((((0, True), (0, False)),), (1,))
DIAGRAMS = {
    "a circle": Diagram(((),), ()),
    "a loop": LOOP,
    "nugatory": braid_diagram((1, 1, 1, 2, -3)),
    "a sum": named_diagram("3_1#m4_1"),
    "parts": Diagram(((), *braid_diagram((1, 1, 3, 3, 3)).passes), (1, 1, 1, 1, 1)),
    "goeritz": diagram_of(HARD_UNKNOTS["goeritz"]),
    **{name: named_diagram(name) for name in ("4_1", "10_139", "L5a1", "L6n1")},
}


def numbered(passes, signs):
    """A code whose crossings are numbered as they are reached."""
    number = {}
    parts = [[(number.setdefault(c, len(number)), over) for c, over in part] for part in passes]
    return parts, [signs[c] for c in number]


def read_off(drawing):
    """The code of a drawing in the plane, from its places alone."""
    mesh, points, passes, signs = drawing.curve.mesh, drawing.curve.vertices, {}, []
    forward = points[mesh.cycle] - points[mesh.anticycle]
    for c, (pair, first_over) in enumerate(zip(drawing.passes.astype(int), drawing.first_over, strict=True)):
        (ux, uy), (vx, vy) = forward[pair if first_over else pair[::-1]]
        signs.append(1 if ux * vy - uy * vx > 0.0 else -1)
        passes |= {pair[0]: (c, bool(first_over)), pair[1]: (c, not first_over)}
        np.testing.assert_allclose(points[pair[0]], points[pair[1]], atol=1e-12)
    parts = [[passes[k] for k in sorted(passes) if a <= k < b] for a, b in pairwise(mesh.offsets)]
    return numbered(parts, signs)


@pytest.mark.parametrize("diagram", DIAGRAMS.values(), ids=DIAGRAMS)
def test_a_layout_has_the_crossings_of_its_diagram_and_no_others(diagram):
    drawing = laid_out(diagram)
    whole = [(piece.passes, piece.signs) for piece in diagram.pieces()]
    passes = [[(c + 100 * k, over) for c, over in part] for k, (parts, _) in enumerate(whole) for part in parts]
    signs = {c + 100 * k: sign for k, (_, own) in enumerate(whole) for c, sign in enumerate(own)}
    assert read_off(drawing) == numbered(passes, signs)
    assert not len(plane_crossings(drawing.curve.mesh, drawing.curve.vertices, -1e-6).turn)


def pulled_across(x):
    """A vertex far from crossings on the other side of everything."""
    k = len(x) - 3
    return np.concatenate([x[:k], x[k : k + 1] + 3.0 * (x.mean(axis=0) - x[k]), x[k + 1 :]])


@pytest.mark.parametrize("spoilt", [lambda x: x * [-1.0, 1.0], pulled_across])
def test_what_would_be_another_diagram_is_not_taken(spoilt, monkeypatch):
    """A mirror image, or edges that cross: the drawing before it is kept, at worst that on the grid."""
    right, diagram = layout.at_rest, named_diagram("4_1")
    calls = []
    for first in (0, 2):
        calls.clear()
        monkeypatch.setattr(
            layout, "at_rest", lambda *a, k=first: (calls.append(1), right(*a) if len(calls) <= k else spoilt(a[1]))[1]
        )
        assert read_off(laid_out(diagram)) == numbered(diagram.passes, diagram.signs)
        assert len(calls) == first + 1


def test_the_derivative_of_the_energy():
    diagram = named_diagram("4_1")
    x, edges = layout.relaxed(diagram)
    strands = layout.charged(diagram, edges, np.linspace(0.7, 1.3, len(edges)))
    way = np.random.default_rng(11).normal(size=x.shape)
    slope = taylor_slope(
        lambda t: strands.energy(x + t * way), [strands.energy(x), np.sum(strands.derivative(x) * way)], largest=1e-3
    )
    assert slope == pytest.approx(2.0, abs=0.1)
    assert np.sum(strands.derivative(layout.at_rest(strands, x, 1e-12)) ** 2) < 1e-6 * np.sum(
        strands.derivative(x) ** 2
    )


def test_faces_of_hundreds_of_edges_stay_on_the_grid(monkeypatch):
    monkeypatch.setattr(layout, "at_rest", None)
    diagram = braid_diagram((1,) * 81)
    assert read_off(laid_out(diagram)) == numbered(diagram.passes, diagram.signs)


def test_strands_are_smooth_and_even_and_cross_at_right_angles():
    drawing = laid_out(named_diagram("8_18"))
    mesh, points = drawing.curve.mesh, drawing.curve.vertices
    edge = drawing.curve.edge_vectors / drawing.curve.edge_lengths[:, None]
    assert (edge * np.roll(edge, 1, axis=0)).sum(axis=1).min() > np.cos(0.35)
    forward = points[mesh.cycle] - points[mesh.anticycle]
    forward /= np.linalg.norm(forward, axis=1)[:, None]
    first, second = forward[drawing.passes.astype(int)].transpose(1, 0, 2)
    assert np.abs((first * second).sum(axis=1)).max() < 0.5


def test_symmetries_are_found_and_stand_upright():
    drawing = laid_out(named_diagram("3_1"))
    (a, b), (c, d), (e, f) = drawing.crossings
    sides = np.hypot([a - c, c - e, e - a], [b - d, d - f, f - b])
    assert np.ptp(sides) < 0.02 * sides.max()
    middle = drawing.curve.vertices - drawing.curve.vertices.mean(axis=0)
    assert abs(np.ptp(middle[:, 0]) / np.ptp(middle[:, 1]) - 1.0) < 0.1
    angle = 2.0 * np.pi * np.arange(90) / 90
    egg = np.column_stack([(2.0 + np.cos(angle)) * np.cos(angle), np.sin(angle)])  # its pointed end to the left
    x, y = (egg @ upright(egg)).T
    assert np.ptp(x) == pytest.approx(2.0, abs=0.01)
    assert y.mean() < 0.5 * (y.min() + y.max())


@pytest.mark.parametrize(
    ("name", "crossings"),
    [("10_81", 10), ("m9_42", 9), ("T(3,4)", 8), ("3_1#m3_1", 6), ("goeritz", 11), ("braid(1,-1,1)", 3),
     ("DT: [4 6 2]", 3), ("plat(2,2,-1,2)", 4), ("figure-eight", 4), ("L7n1", 7)],
)  # fmt: skip
def test_names_have_diagrams_of_fewest_crossings_and_codes_their_own(name, crossings):
    assert named_diagram(name).crossings == crossings


def test_arcs_have_no_diagram_of_their_own():
    assert named_diagram("overhand") is None


@pytest.mark.slow
def test_all_names_of_the_table_have_least_diagrams():
    for name in KNOTS:
        assert named_diagram(name).crossings == int(name.strip("L").replace("a", "_").replace("n", "_").split("_")[0])


@pytest.mark.parametrize(
    ("diagram", "said"), [(Diagram((), ()), "empty"), (braid_diagram((1,) * 201), "at most 200 can be laid out")]
)
def test_what_cannot_be_laid_out(diagram, said):
    with pytest.raises(CurveError, match=said):
        laid_out(diagram)
