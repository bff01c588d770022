"""Curves drawn by hand, and diagrams drawn of curves."""

import re
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, contents, sentence, stored
from knot_type import UNKNOT, knot_invariants
from mobius_flow.addon.buttons import drawing
from mobius_flow.core import Curve
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.knots import Drawing, torus_knot


def scribble(p=2, q=3, n=60):
    """The points of a flat drawing of a torus knot."""
    return torus_knot(p, q, n).vertices * [1, 1, 0]


def lifted(**options):
    """The object that the selected drawing becomes, and its points in world space."""
    assert bpy.ops.curve.mobius_flow_draw_knot(**options) == {"FINISHED"}
    obj = bpy.context.object
    bpy.context.view_layer.update()
    matrix = np.array(obj.matrix_world)
    return obj, stored(obj.data).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


@pytest.mark.parametrize("kind", ["closed", "open", "NURBS", "filled"])
def test_a_drawn_trefoil(kind):
    """An open stroke is closed by its chord; Blender's 2D curves are filled, and drawn as faces."""
    polygon = kind in ("closed", "open")
    drawn = add_curve([scribble(n=60 if polygon else 24)], kind="POLY" if polygon else "NURBS", cyclic=kind != "open")
    drawn.data.dimensions = "2D" if kind == "filled" else "3D"
    before = contents()["splines"]["Knot"]
    obj, points = lifted()
    assert obj.name == "Drawn m3_1"
    check_embedded(Curve(points))
    assert knot_invariants(points).genus == 1
    assert contents()["splines"]["Knot"] == before
    assert drawn.hide_get()
    assert drawn.hide_render
    assert (obj.select_get(), drawn.select_get()) == (True, False)
    assert obj.data.bevel_depth > 0.02
    assert bpy.ops.curve.mobius_flow_relax(max_iterations=1) == {"FINISHED"}


def test_a_stroke_is_named_as_it_stands():
    """One with many crossings is only counted, and one that touches itself has no name for a moment."""
    path = [120.0 * place[:2] for place in scribble()]
    wanted = {len(path): "3 crossings: m3_1, proved", len(path) // 3: "0 crossings: it is not knotted", 2: ""}
    for length, said in wanted.items():
        assert drawing._name(path[:length]) == said
    turns = np.linspace(0.0, 34.0 * np.pi, 2000)
    many = drawing._name([*(100.0 * np.stack([turns / 20 + np.sin(turns), np.cos(turns)], axis=1))])
    assert re.fullmatch(r"\d+ crossings", many)


def sharpest(points):
    edges = np.roll(points, -1, axis=0) - points
    edges /= np.linalg.norm(edges, axis=1, keepdims=True)
    return np.degrees(np.arccos((edges * np.roll(edges, 1, axis=0)).sum(axis=1).clip(-1.0, 1.0)).max())


def test_a_coarse_stroke_has_no_corners_and_its_type():
    path = [200.0 * place[:2] for place in scribble(n=15)]
    smooth = drawing._even(path)
    assert sharpest(np.array(path)) > 50
    assert sharpest(smooth) < 8
    knotted = Drawing.of(Curve(smooth)).lifted()
    assert knot_invariants(knotted.vertices).genus == 1


def test_a_stroke_crosses_where_its_polygon_does(monkeypatch):
    """A spline may swing out and cross what the stroke does not; then its corners are rounded only."""
    zigzag = [np.array(place) for place in ((0.0, 0), (400, 0), (400, 20), (40, 20), (40, 40), (400, 40), (0.0, 300))]
    assert len(Drawing.of(Curve(drawing._even(zigzag))).crossings) == 0
    monkeypatch.setattr(drawing, "_crossings", lambda _points: [])
    assert len(Drawing.of(Curve(drawing._even(zigzag))).crossings) > 0


def test_a_crossing_is_changed_and_all_are_numbered():
    add_curve([scribble()])
    change = [False] * 32
    change[1] = True
    obj, points = lifted(change=change, hide_drawing=False, number=True)
    assert obj.name == "Drawn Unknot"
    assert knot_invariants(points) == UNKNOT
    assert sorted(child.name for child in obj.children) == ["1", "2", "3"]
    assert all(child.show_name for child in obj.children)


@pytest.mark.parametrize(
    ("place", "turn"), [((0, 0, 5), (0, 0, 0)), ((40, -3, 2), (1.2, 0.4, 0.3)), ((0, 0, 5), (np.pi, 0, 0))]
)
def test_it_lies_over_the_drawing_wherever_that_is(place, turn):
    drawn = add_curve([scribble()])
    drawn.location, drawn.rotation_euler, drawn.scale = place, turn, (2, 2, 2)
    bpy.context.view_layer.update()
    _, points = lifted()
    flat = np.linalg.solve(np.array(drawn.matrix_world), np.column_stack([points, np.ones(len(points))]).T)[:3].T
    assert abs(flat[:, 2]).max() < 0.3
    assert abs(flat[:, 2]).max() > 0.02
    assert abs(flat[:, :2]).max() == pytest.approx(abs(scribble()).max(), rel=0.02)


def test_a_click_swaps_the_crossing_that_is_under_it(monkeypatch):
    """Crossings are numbered along the curve, here seen as drawn, a hundred pixels to the unit; none is elsewhere."""
    obj = add_curve([scribble()])
    obj.data[drawing._PLANE] = [0.0, 0.0, 0.0, *np.eye(3).ravel()]
    monkeypatch.setattr(drawing, "projected", lambda _, at: (100.0 * at[:, :2], None, np.ones(len(at), dtype=bool)))
    system = SimpleNamespace(ui_scale=1.0)
    context = SimpleNamespace(object=obj, region=None, preferences=SimpleNamespace(system=system))
    places, aside = 100.0 * Drawing.seen(Curve(scribble())).crossings, np.array([10.0, 0.0])
    assert [drawing._crossing(context, place + aside)[2] for place in places] == [1, 2, 3]
    assert drawing._crossing(context, places[0] + 1.6 * aside) is None


def test_several_curves_make_a_link():
    circle = np.column_stack([np.cos(t := np.linspace(0, 6, 40)), np.sin(t), 0 * t])
    first, second = add_curve([circle], "A"), add_curve([circle + np.array([1.1, 0, 0])], "B")
    first.select_set(True)
    obj, _ = lifted()
    assert len(obj.data.splines) == 2
    assert len(obj.data.materials) == 2
    assert first.hide_get()
    assert second.hide_get()


def spiral():
    points = scribble()
    points[:, 2] = np.linspace(0, 2, len(points))
    return points


@pytest.mark.parametrize(
    ("points", "said"),
    [
        (spiral(), "not flat"),
        (scribble() * [1, 0, 0], "touch without crossing"),
        (scribble() * 0, "same"),
        ([(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 0, 0), (0, 1, 0)], "touch without crossing"),
    ],
)
def test_what_is_no_drawing_is_refused(points, said):
    add_curve([points])
    before = contents()
    with pytest.raises(RuntimeError, match=said) as error:
        bpy.ops.curve.mobius_flow_draw_knot()
    assert len(sentence(error.value)) > 10
    assert contents() == before


def draw(path, **options):
    return bpy.ops.curve.mobius_flow_draw_diagram(filepath=str(path), **options)


def test_selected_curves_are_drawn(tmp_path):
    add_trefoil()
    assert draw(tmp_path / "out.pdf", arrows=True, numbers=True) == {"FINISHED"}
    assert (tmp_path / "out.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize(("name", "said"), [("out.png", "give 'out.png' one of these"), ("no/out.svg", "no/out.svg")])
def test_other_files_and_places_are_refused(name, said, tmp_path):
    add_trefoil()
    with pytest.raises(RuntimeError, match=said):
        draw(tmp_path / name)
    assert not list(tmp_path.iterdir())
