"""What the sidebar shows: buttons that there are, radii in the scene's units, and sentences in lines that fit."""

import itertools
from types import SimpleNamespace

import bpy
import pytest
from blender_scenes import add_trefoil
from mobius_flow.addon import registration
from mobius_flow.addon.curves.splines import length
from mobius_flow.addon.settings import GROUPS_OF_SCENE
from mobius_flow.addon.sidebar import menus, panels
from mobius_flow.addon.sidebar.layout import wrapped
from mobius_flow.core import METHODS
from panel_layout import Layout, shown


@pytest.mark.parametrize("curve", [True, False])
@pytest.mark.parametrize(
    "cls",
    [each for module in (panels, menus) for each in registration.declared(module) if "report" not in each.__name__],
    ids=lambda cls: cls.__name__,
)
def test_every_button_is_an_operator(cls, curve, monkeypatch):
    if curve:
        add_trefoil()
    monkeypatch.setattr(panels, "sentence", lambda *_, **__: None)  # sentences want a window
    layout = shown(cls)
    assert layout.buttons or layout.settings
    ours = {name.removeprefix("curve.") for name in layout.buttons} - {"wm.url_open"}
    assert ours <= set(dir(bpy.ops.curve))


def test_the_sidebar_has_few_settings_and_one_place_for_each(monkeypatch):
    """16 settings at most beside Expert, 25 in all, Blender's own among them, while the last run is shown."""
    add_trefoil()
    over = SimpleNamespace(value="Done", over=True)
    run = dict.fromkeys(("recoverable", "waits", "failed", "last", "report", "message", "trouble"))
    run |= {"state": over, "session": SimpleNamespace(names=["Knot"]), "energies": [1.0]}
    monkeypatch.setattr(panels.registry, "shown", lambda _obj: SimpleNamespace(**run))
    monkeypatch.setattr(panels, "sentence", lambda *_, **__: None)
    panels_drawn = registration.declared(panels)
    layouts = {cls: shown(cls) for cls in panels_drawn}
    settings = [name for layout in layouts.values() for name in set(layout.settings)]  # qualities are one setting
    expert = set(layouts[panels.VIEW3D_PT_mobius_flow_expert].settings)
    assert {"quality", "show_plot", "knot", "options", "resolution_percentage"} <= set(settings)
    assert len(set(settings)) == len(settings) <= 25
    assert len(set(settings) - expert) <= 16
    kept = [name for cls in GROUPS_OF_SCENE.values() for name in cls.__annotations__]
    assert len(kept) <= 25, "no more is hidden in scenes"
    buttons = [name for layout in layouts.values() for name in layout.buttons]
    for twice in ("pick_knot", "fit_tube"):  # the gallery's and the search's; each of two choices
        buttons.remove(f"curve.mobius_flow_{twice}")
    assert len(set(buttons)) == len(buttons)


def test_nothing_is_below_the_report_that_would_move_when_it_comes():
    shown_in_order = [cls for cls in registration.CLASSES if issubclass(cls, bpy.types.Panel)]
    assert shown_in_order[-1] is panels.VIEW3D_PT_mobius_flow_report
    assert not hasattr(shown_in_order[-1], "bl_parent_id"), "it is below all sub-panels of the others, too"
    assert not panels.VIEW3D_PT_mobius_flow_report.poll(bpy.context), "before there is anything to report"


def test_what_the_curves_are_relaxed_by_is_said_where_it_is_no_quality(monkeypatch):
    said = []
    monkeypatch.setattr(panels, "sentence", lambda _layout, _context, text, icon="": said.append(str(text)))
    scene = bpy.context.scene.mobius_flow
    panels._qualities(Layout(), bpy.context)
    scene.method = "flow-moebius"
    panels._qualities(Layout(), bpy.context)
    scene.method = "penalty-cg"
    panels._qualities(Layout(), bpy.context)
    scene.options = "method="
    panels._qualities(Layout(), bpy.context)
    label = METHODS["flow-moebius"].label
    assert said[:2] == [f"{label}, after Reiter and Schumacher (2021)", METHODS["penalty-cg"].label]
    assert said[2].startswith("Further Options have 'method='")


def test_nodes_that_get_no_curve_are_told_of(monkeypatch):
    """Geometry nodes make points of a curve, and none of its tube."""
    said = []
    monkeypatch.setattr(panels, "sentence", lambda _layout, _context, text: said.append(str(text)))
    obj = add_trefoil()
    tree = bpy.data.node_groups.new("Points", "GeometryNodeTree")
    for kind in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=kind, socket_type="NodeSocketGeometry")
    ends = [tree.nodes.new(f"NodeGroup{kind}") for kind in ("Input", "Output")]
    points = tree.nodes.new("GeometryNodeCurveToPoints")
    tree.links.new(ends[0].outputs[0], points.inputs[0])
    tree.links.new(points.outputs[0], ends[1].inputs[0])
    obj.modifiers.new("Points", "NODES").node_group = tree

    def count():
        depsgraph = bpy.context.evaluated_depsgraph_get()
        clouds = [each.object for each in depsgraph.object_instances if each.object.type == "POINTCLOUD"]
        return sum(len(each.data.points) for each in clouds)

    panels._hidden_from_nodes(Layout(), bpy.context)
    assert (count() > 0, said) == (True, [])
    obj.data.bevel_depth = 0.1
    panels._hidden_from_nodes(Layout(), bpy.context)
    assert count() == 0
    assert said[0].startswith("The nodes of 'Knot' get the mesh of its tube")


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


@pytest.mark.parametrize("room", [1, 9, 20, 1000])
def test_every_line_fits_and_no_word_is_lost(room):
    text = "Points of 'Knot' were added or removed; its relaxation has ended"
    lines = wrapped(text, lambda line: len(line) <= room)
    assert " ".join(lines) == text
    assert all(len(line) <= room or " " not in line for line in lines)
    assert all(len(f"{line} {following.split()[0]}") > room for line, following in itertools.pairwise(lines))


@pytest.mark.usefixtures("defaults")
def test_a_timing_that_no_film_can_have_is_said_beside_its_settings(monkeypatch):
    """The film keeps its own until then."""
    said, scene = [], bpy.context.scene.mobius_flow
    monkeypatch.setattr(panels, "sentence", lambda _layout, _context, text, icon="": said.append(str(text)))
    add_trefoil()
    both = panels.VIEW3D_PT_mobius_flow_film, panels.VIEW3D_PT_mobius_flow_expert
    for scene.length, scene.hold_start in ((40, 0), (40, 60)):
        for cls in both:
            shown(cls)
    assert [text.partition(",")[0] for text in said] == 2 * ["Length is 40 frames"]
    scene.length, scene.hold_start = 2, 0
    monkeypatch.setattr(panels.bake, "key_count", lambda _data: 10_000)
    shown(both[0])
    assert said[2:] == ["2 frames are too few for 10000 keys; give a larger Length"]
