"""The scene's settings, the operator's and the panels are the library's options: none is declared a second time."""

from dataclasses import asdict, dataclass
from io import BytesIO
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, relax, sentence, stored
from mobius_flow.addon import properties
from mobius_flow.addon.engine import wire
from mobius_flow.addon.engine.placement import Link, Placement
from mobius_flow.addon.sidebar.panels import VIEW3D_PT_mobius_flow_expert
from mobius_flow.addon.sidebar.relax import VIEW3D_PT_mobius_flow
from mobius_flow.core import METHODS, Curve, OptionError, RelaxOptions, Task, minimize
from mobius_flow.core.arguments import declared, option
from option_values import unlike_default
from shapes import torus_trefoil

SHOWN = {each.name: each for each in declared(RelaxOptions) if each.is_setting}
GIVEN = {name: unlike_default(each) for name, each in SHOWN.items()}


@dataclass(frozen=True, kw_only=True)
class OneMore(RelaxOptions):
    """With options that nothing but these lines know of."""

    patience: float | None = option(None, "Patience", "how long to wait", automatic="without limit", low=0, high=9)
    colour: str = option("red", "Colour", "what it looks like", choices=("red", "blue"), row=True)


def owners():
    operator = bpy.ops.curve.mobius_flow_relax.get_rna_type()
    return bpy.context.scene.mobius_flow.bl_rna.properties, operator.properties


def scene_values():
    scene = bpy.context.scene.mobius_flow
    return {name: getattr(scene, name) for name in properties.SETTINGS}


@pytest.mark.parametrize("each", SHOWN.values(), ids=SHOWN)
def test_every_option_is_a_setting_of_scene_and_operator(each):
    for owner in owners():
        shown = owner[each.name]
        assert shown.name == each.label
        assert shown.description.startswith(each.sentence())
        if each.choices is not None:
            automatic = ["AUTO"] if each.default is None else []
            assert [item.identifier for item in shown.enum_items] == automatic + list(each.choices)
            assert len({item.value for item in shown.enum_items}) == len(shown.enum_items)
        elif each.kind not in (bool, str):
            assert shown.hard_min == pytest.approx(0 if each.default is None else each.low)
            assert shown.hard_max >= min(each.high * (1 - 1e-7), 2**31 - 1)
        none = f"; {'Empty' if each.kind is str else 0}: "
        assert (none in shown.description) == (each.default is None and each.choices is None)


def test_defaults_are_the_librarys():
    options = asdict(properties.relax_options(scene_values()))
    for name, value in asdict(RelaxOptions()).items():
        assert options[name] == (pytest.approx(value) if isinstance(value, float) else value)


@pytest.mark.parametrize("name", GIVEN)
def test_every_option_can_be_set(name):
    setattr(bpy.context.scene.mobius_flow, name, GIVEN[name])
    assert getattr(properties.relax_options(scene_values()), name) == GIVEN[name]


def test_names_keep_their_numbers_in_files(tmp_path):
    owner = bpy.context.scene.mobius_flow.bl_rna.properties
    numbers = {"method": ("flow-l2", 1455206817), "energy": ("edge", 1963381606), "metric": ("h2", 606773968)}
    for name, (item, number) in numbers.items():
        assert owner[name].enum_items[item].value == number
        setattr(bpy.context.scene.mobius_flow, name, item)
    assert owner["metric"].enum_items["AUTO"].value == 0
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert bpy.context.scene.mobius_flow.metric == "AUTO"
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    for name, (item, _) in numbers.items():
        assert getattr(bpy.context.scene.mobius_flow, name) == item


def test_methods_have_names_for_people_and_those_for_comparison_are_apart():
    for owner in owners():
        shown = owner["method"]
        assert {item.identifier: item.name for item in shown.enum_items} == {
            k: each.label for k, each in METHODS.items()
        }
        menu = [item.name for item in shown.enum_items_static_ui]
        apart = menu.index("For Comparison")
        assert menu[0] == "Recommended"
        assert set(menu[apart + 1 :]) == {each.label for each in METHODS.values() if each.comparison}
        assert "Sobolev L-BFGS" in menu[:apart]
        assert "Sobolev Gradient Flow (the Paper's)" in menu[:apart]
        assert "projected fractional Sobolev gradients" in shown.enum_items["lbfgs"].description
    assert {name for name, each in METHODS.items() if each.label == name} == set()


def drawn(cls):
    """The settings that a panel shows."""
    names = []

    class Layout:
        def column(self, align=False):
            return self

        def prop(self, _owner, name):
            names.append(name)

    cls.draw(SimpleNamespace(layout=Layout(), rows=cls.rows), bpy.context)
    return names


def test_the_expert_panel_shows_what_artists_might_set():
    expert = VIEW3D_PT_mobius_flow_expert
    assert expert.is_registered
    assert expert.bl_parent_id == VIEW3D_PT_mobius_flow.__name__
    assert "DEFAULT_CLOSED" in expert.bl_options
    assert drawn(expert) == ["method", "max_iterations", "tolerance", "vertices", "energy", "untangle"]


def test_options_that_nothing_else_knows_of_appear_by_themselves(monkeypatch):
    monkeypatch.setattr(properties, "RelaxOptions", OneMore)
    declaration = properties.settings(set())
    patience, colour = declaration["patience"].keywords, declaration["colour"].keywords
    assert patience["description"] == "How long to wait; 0: without limit"
    assert (patience["min"], patience["max"], patience["default"]) == (0.0, 9.0, 0.0)
    assert ([item[0] for item in colour["items"]], colour["default"]) == (["red", "blue"], "red")
    assert "colour" in drawn(VIEW3D_PT_mobius_flow_expert)
    values = scene_values() | {"patience": 0.0, "colour": "blue"}
    assert asdict(properties.relax_options(values))["patience"] is None
    assert properties.relax_options(values | {"patience": 2.0}).patience == 2.0
    with pytest.raises(OptionError, match=r"patience is 10\.0; it must be a finite number above 0 and at most 9"):
        properties.relax_options(values | {"patience": 10.0})


@pytest.mark.parametrize(("name", "value"), [("max_iterations", -1), ("quadrature_points", 17), ("tolerance", 0.0)])
def test_settings_stay_within_the_bounds(name, value):
    setattr(bpy.context.scene.mobius_flow, name, value)
    assert getattr(bpy.context.scene.mobius_flow, name) != value
    properties.relax_options(scene_values())


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"penalty": 5.0}, "penalty is 5.0; the method keeps lengths and has no penalty"),
        ({"quadrature_points": 2, "metric": "l2"}, "metric 'l2' has no such rule"),
        ({"method": "trust-region", "energy": "edge"}, "second derivative"),
        ({"method": "penalty-cg", "stability": True}, "penalises lengths"),
    ],
)
def test_options_that_do_not_go_together(options, said):
    add_trefoil()
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_relax(**options)
    assert said in sentence(error.value)


@pytest.mark.parametrize(
    "options",
    [
        {"energy": "edge", "metric": "h2", "edge_lengths": "keep"},
        {"method": "penalty-lbfgs", "metric": "h3-2", "penalty": 8.0},
        {"energy": "moebius-k2", "quadrature_points": 2},
    ],
    ids=str,
)
def test_the_result_is_the_librarys(options):
    obj = add_trefoil()
    start = Curve.from_components([stored(obj.data).astype(np.float64)])
    wanted = {"max_iterations": 6} | options
    relax(keyframes="RESULT", **wanted)
    result = minimize(start, RelaxOptions(**wanted)).curve.vertices
    np.testing.assert_array_equal(stored(obj.data), result.astype(np.float32))
    plain = minimize(start, RelaxOptions(max_iterations=6)).curve.vertices
    assert not np.array_equal(stored(obj.data), plain.astype(np.float32))


def test_the_worker_is_sent_every_option():
    options = RelaxOptions(**GIVEN | {"mesh": "auto"})  # others make their own edge_lengths
    curve = torus_trefoil(30)
    pipe = BytesIO()
    wire.write(pipe, wire.pack_job(Task(curve=curve), options, Link((Placement(np.eye(3), np.zeros(3)),), (1,))))
    pipe.seek(0)
    _, received, _ = wire.unpack_job(wire.read(pipe))
    assert received == options
