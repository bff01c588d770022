"""The plot and the marks lie in their view, whatever its size and theme, and nothing that happens there raises."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve
from mobius_flow.addon.curves import pins
from mobius_flow.addon.live import overlay, registry
from mobius_flow.core.keys.colours import contrast
from mobius_flow.core.knots import knot
from shapes import torus_trefoil


@pytest.fixture
def drawn(monkeypatch):
    """What is drawn instead of pixels: kind, points, colour, words."""
    things = []
    monkeypatch.setattr(overlay, "area", lambda low, high, colour: things.append(("area", (low, high), colour, "")))
    monkeypatch.setattr(
        overlay, "line", lambda points, colour, _width, kind="": things.append(("line", points, colour, kind))
    )
    monkeypatch.setattr(
        overlay, "text", lambda words, place, colour, _size, share=0.0: things.append(("text", [place], colour, words))
    )
    return things


def view(width=900, height=700, sidebar=None):
    """The context of a view."""
    region = SimpleNamespace(type="WINDOW", x=20, y=0, width=width, height=height)
    regions = [region] if sidebar is None else [region, SimpleNamespace(type="UI", x=20 + sidebar, width=200)]
    real = bpy.context.preferences
    system = SimpleNamespace(ui_scale=1.0)  # 0 where there is no window
    preferences = SimpleNamespace(system=system, themes=real.themes, ui_styles=real.ui_styles)
    area = SimpleNamespace(regions=regions)
    return SimpleNamespace(preferences=preferences, region=region, area=area, region_data=None)


@pytest.fixture
def run(operator):
    """A run of a curve that may be unknotted."""
    add_curve([knot("culprit").vertices])
    operator.given |= {"max_iterations": 8, "vertices": 0}
    operator.start()
    operator.until(lambda: False)
    return operator.run


def corners(drawn):
    return np.concatenate([np.reshape(np.array(points, dtype=float), (-1, 2)) for _, points, _, _ in drawn])


@pytest.mark.parametrize("sidebar", [None, 650])
def test_the_plot_is_in_the_view_beside_the_sidebar(run, drawn, sidebar):
    overlay._plot(view(sidebar=sidebar), run)
    low, high = corners(drawn).min(axis=0), corners(drawn).max(axis=0)
    (ground,) = [points for kind, points, _, _ in drawn if kind == "area"]
    np.testing.assert_array_equal(ground, [low, high])
    assert (low > 0).all()
    assert high[0] < (sidebar or 900)
    words = [said for kind, _, _, said in drawn if kind == "text"]
    assert words == ["circle = 4", f"Energy {run.last.energy:.4f}", "Step 8"]


@pytest.mark.parametrize("size", [(250, 700), (900, 150)])
def test_small_views_are_left_alone(run, drawn, size):
    overlay._plot(view(*size), run)
    assert drawn == []


@pytest.mark.parametrize("ground", [0.05, 0.5, 0.95])
def test_the_curve_can_be_seen_in_any_theme(run, drawn, ground):
    run.target = None  # then there is no line for it
    inner = bpy.context.preferences.themes[0].user_interface.wcol_tooltip
    before = tuple(inner.inner)
    inner.inner = (ground, ground, ground, 1)
    try:
        overlay._plot(view(), run)
    finally:
        inner.inner = before
    (colour,) = [colour for kind, _, colour, _ in drawn if kind == "line"]
    assert contrast(colour, (ground,) * 3) >= 3
    assert next(said for kind, _, _, said in drawn if kind == "text").startswith("Energy")


def test_marks_are_where_the_trouble_is(operator, drawn, monkeypatch):
    obj = add_curve([np.array([[0.0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0]])])
    operator.start()
    operator.until(lambda: False)
    places = []
    front = np.ones(1, dtype=bool)

    def projected(_region, points):
        places.extend(points)
        return np.array([[100.0, 50.0]]), None, front

    monkeypatch.setattr(overlay, "projected", projected)
    obj.location = (7, 0, 0)
    bpy.context.view_layer.update()
    overlay._marks(view(), operator.run)
    np.testing.assert_allclose(np.array(places), [[8, 1, 0]], atol=0.01)
    np.testing.assert_allclose(corners(drawn).mean(axis=0), [100, 50], atol=1)
    drawn.clear()
    front[:] = False
    overlay._marks(view(), operator.run)
    assert drawn == []


def test_whatever_happens_while_drawing_nothing_is_raised(monkeypatch, capfd):
    class Broken:
        def __getattr__(self, name):
            raise ReferenceError("StructRNA of type Window has been removed")

    monkeypatch.setattr(overlay.bpy, "context", Broken())
    overlay._draw()
    monkeypatch.setattr(registry, "shown", lambda _: 1 / 0)
    overlay._draw()
    assert capfd.readouterr() == ("", "")


def test_pinned_points_are_marked(drawn, monkeypatch):
    obj = add_curve([torus_trefoil(12).vertices])
    obj.location.x = 2
    bpy.context.view_layer.update()
    pins.pin(obj.data.splines[0], np.arange(12) < 2)
    monkeypatch.setattr(overlay, "projected", lambda _, points: (points[:, :2], None, points[:, 0] < np.inf))
    here = view()
    here.mode, here.selected_objects = "OBJECT", [obj]
    overlay._pins(here)
    ((_, corners, _, kind),) = drawn
    middles = np.reshape(corners, (2, -1, 2)).mean(axis=1)
    np.testing.assert_allclose(middles, torus_trefoil(12).vertices[:2, :2] + [2, 0], atol=1e-5)
    assert kind == "LINES"
