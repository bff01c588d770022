"""What the sidebar shows: buttons that there are, radii in the scene's units, and sentences in lines that fit."""

import itertools
from types import SimpleNamespace

import bpy
import pytest
from blender_scenes import add_trefoil
from mobius_flow.addon import registration
from mobius_flow.addon.curves.exchange import length
from mobius_flow.addon.sidebar import menus, panels, relax
from mobius_flow.addon.sidebar.layout import wrapped


class Layout:
    """A double that keeps the labels, the settings and the buttons."""

    def __init__(self):
        self.labels, self.settings, self.buttons = [], [], []

    def label(self, text, **_):
        self.labels.append(text)

    def operator(self, name, **_):
        self.buttons.append(name)
        return SimpleNamespace()

    def prop(self, owner, name, **_):
        assert hasattr(owner, name)
        self.settings.append(name)

    def prop_enum(self, owner, name, _value):
        self.prop(owner, name)

    def template_icon_view(self, owner, name, **_):
        self.prop(owner, name)

    def __getattr__(self, _name):
        return lambda *_, **__: self


def shown(cls):
    layout = Layout()
    cls.draw(SimpleNamespace(layout=layout, rows=getattr(cls, "rows", ())), bpy.context)
    return layout


@pytest.mark.parametrize("curve", [True, False])
@pytest.mark.parametrize(
    "cls",
    [each for module in (relax, panels, menus) for each in registration.declared(module)],
    ids=lambda cls: cls.__name__,
)
def test_every_button_is_an_operator(cls, curve, monkeypatch):
    if curve:
        add_trefoil()
    monkeypatch.setattr(relax, "refused", lambda *_: None)  # sentences want a window
    layout = shown(cls)
    assert layout.buttons or layout.settings
    assert {name.removeprefix("curve.") for name in layout.buttons} <= set(dir(bpy.ops.curve))


def test_the_sidebar_has_few_panels_few_settings_and_one_place_for_each(monkeypatch):
    """Twenty settings at most, Blender's own among them, while the last run is shown; presets are a popover."""
    add_trefoil()
    over = SimpleNamespace(value="Done", over=True)
    run = dict.fromkeys(("recoverable", "waits", "failed", "last", "report", "message", "trouble"))
    run |= {"state": over, "group": SimpleNamespace(names=["Knot"]), "energies": [1.0]}
    monkeypatch.setattr(relax.registry, "shown", lambda _obj: SimpleNamespace(**run))
    monkeypatch.setattr(relax, "refused", lambda *_: None)
    panels_drawn = [cls for module in (relax, panels) for cls in registration.declared(module)]
    layouts = [shown(cls) for cls in panels_drawn]
    settings = [name for layout in layouts for name in set(layout.settings)]  # levels of quality are one setting
    buttons = [name for layout in layouts for name in layout.buttons]
    buttons.remove("curve.mobius_flow_pick_knot")  # the gallery's, and the search's
    assert len(panels_drawn) <= 6
    assert {"quality", "show_plot", "knot", "method", "resolution_percentage"} <= set(settings)
    assert len(set(settings)) == len(settings) <= 20
    assert len(set(buttons)) == len(buttons)


def test_what_a_film_would_lack_is_said_below_its_buttons(monkeypatch):
    add_trefoil()
    monkeypatch.setattr(panels.staging, "fits", lambda _scene: False)
    monkeypatch.setattr(panels, "unseen", lambda *_: "Frames are cut off")
    monkeypatch.setattr(panels, "sentence", lambda layout, *_: layout.buttons.append("said"))
    assert shown(panels.VIEW3D_PT_mobius_flow_film).buttons[-3:] == ["curve.mobius_flow_play_film", "said", "said"]


@pytest.mark.parametrize(
    ("system", "scale", "said"),
    [("NONE", 1.0, "0.125"), ("METRIC", 1.0, "12.5 cm"), ("METRIC", 0.01, "1.25 mm"), ("IMPERIAL", 1.0, '4.921"')],
)
def test_lengths_are_in_the_scenes_units(system, scale, said):
    units = bpy.context.scene.unit_settings
    units.system, units.scale_length = system, scale
    assert length(bpy.context.scene, 0.125) == said


def test_the_radius_is_in_the_world_and_somebodys():
    obj = add_trefoil()
    assert shown(panels.VIEW3D_PT_mobius_flow_shape).labels[-2:] == ["Radius", "None"]
    obj.data.bevel_depth, obj.scale = 0.125, (2, 2, 2)
    bpy.context.view_layer.update()
    assert shown(panels.VIEW3D_PT_mobius_flow_shape).labels[-2:] == ["Radius", "25 cm (your own)"]
    bpy.ops.curve.mobius_flow_fit_tube()
    assert shown(panels.VIEW3D_PT_mobius_flow_shape).labels[-1].endswith(" m (fitted)")


@pytest.mark.parametrize("room", [1, 9, 20, 1000])
def test_every_line_fits_and_no_word_is_lost(room):
    text = "Points of 'Knot' were added or removed; its relaxation has ended"
    lines = wrapped(text, lambda line: len(line) <= room)
    assert " ".join(lines) == text
    assert all(len(line) <= room or " " not in line for line in lines)
    assert all(len(f"{line} {following.split()[0]}") > room for line, following in itertools.pairwise(lines))
