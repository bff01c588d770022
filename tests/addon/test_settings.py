"""The scene's settings, the operator's and the panels are the library's options: none is declared a second time."""

from dataclasses import asdict

import bpy
import pytest
from blender_scenes import add_trefoil, sentence
from mobius_flow.addon import properties
from mobius_flow.addon.sidebar.panels import VIEW3D_PT_mobius_flow, VIEW3D_PT_mobius_flow_expert
from mobius_flow.core import METHODS, OptionError, RelaxOptions, minimize
from mobius_flow.core.base.arguments import declared
from option_values import unlike_default
from panel_layout import shown
from shapes import torus_trefoil

pytestmark = pytest.mark.usefixtures("defaults")
SHOWN = {each.name: each for each in declared(RelaxOptions) if not each.repeated}
GIVEN = {name: unlike_default(each) for name, each in SHOWN.items()}


def owners():
    operator = bpy.ops.curve.mobius_flow_relax.get_rna_type()
    return bpy.context.scene.mobius_flow.bl_rna.properties, operator.properties


def scene_values():
    scene = bpy.context.scene.mobius_flow
    return {name: getattr(scene, name) for name in properties.SETTINGS}


@pytest.mark.parametrize("each", SHOWN.values(), ids=SHOWN)
def test_every_option_is_a_setting_of_scene_and_operator(each):
    on_scene, on_operator = owners()
    assert (each.name in on_scene.keys()) == each.row == (each.name not in properties.FURTHER)  # noqa: SIM118
    for owner in (on_scene, on_operator) if each.row else (on_operator,):
        shown = owner[each.name]
        assert shown.name == each.label
        assert shown.description.startswith(each.sentence())
        if each.read is not str:  # a name, or numbers in text
            assert shown.default == each.default
        elif each.choices is not None:
            automatic = ["AUTO"] if each.default is None else []
            assert [item.identifier for item in shown.enum_items] == automatic + list(each.choices)
            assert len({item.value for item in shown.enum_items}) == len(shown.enum_items)
        elif each.kind not in (bool, str):
            assert shown.hard_min == pytest.approx(0 if each.default is None else each.low)
            assert shown.hard_max >= min(each.high * (1 - 1e-7), 2**31 - 1)
        none = f"; {'Empty' if each.kind is str else 0}: "
        assert (none in shown.description) == (each.default is None and each.choices is None)


def test_a_radius_may_be_a_name_or_numbers():
    values = scene_values() | {"radius": "0.05,0.1"}
    assert properties.relax_options(values).radius == (0.05, 0.1)
    assert properties.further("radius=0.05,0.1 vertices=90") == {"radius": "0.05,0.1", "vertices": 90}


def test_defaults_are_the_librarys():
    options = asdict(properties.relax_options(scene_values()))
    for name, value in asdict(RelaxOptions()).items():
        assert options[name] == (pytest.approx(value) if isinstance(value, float) else value)


@pytest.mark.parametrize("name", GIVEN)
def test_every_option_can_be_set(name):
    setattr(bpy.context.scene.mobius_flow, name, GIVEN[name])
    assert getattr(properties.relax_options(scene_values()), name) == GIVEN[name]


def test_names_keep_their_numbers_in_files(tmp_path):
    scene = bpy.context.scene.mobius_flow
    assert scene.bl_rna.properties["untangle"].enum_items["never"].value == 438673936
    written = scene.bl_rna.properties["keyframes"].enum_items  # 1 was an F-curve for every coordinate
    assert {item.identifier: item.value for item in written} == {"SHAPE_KEYS": 0, "RESULT": 2}
    scene.untangle, scene.method, scene.tolerance, scene.metric = "never", "flow-l2", 1e-9, "h2"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert bpy.context.scene.mobius_flow.metric == "AUTO"
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    scene = bpy.context.scene.mobius_flow
    assert (scene.untangle, scene.options) == ("never", "method=flow-l2 tolerance=1e-09 metric=h2")
    assert (scene.method, scene.tolerance, scene.metric) == ("flow-l2", 1e-9, "h2")


def test_what_differs_from_defaults_is_written_as_text():
    scene = bpy.context.scene.mobius_flow
    scene.options = "stability=true vertices=300"
    assert (scene.stability, scene.vertices, scene.method) == (True, 300, "lbfgs")
    scene.vertices = 0
    assert scene.options == "stability=True"
    with pytest.raises(OptionError, match="method is 'flow-l3'; did you mean flow-l2"):
        scene.method = "flow-l3"
    assert scene.options == "stability=True"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("metod=cg", "Further Options have 'metod=cg'; write NAME=VALUE, with one of the names method, "),
        ("length=9", "Further Options have 'length=9'"),
        ("vertices", "Further Options have 'vertices'"),
        ("vertices=many", "vertices is 'many'; it must be a whole number"),
        ("stability=perhaps", "stability is 'perhaps'; it must be True or False"),
        ("tolerance=nan", "tolerance is nan; it must be a finite number above 0"),
        ("max_iterations=-1", "max_iterations is -1; it must be 0 or more"),
        ("max_keys=-3", "max_keys is -3; it must be 0 or more"),
        ("view_every=-1", "view_every is -1; it must be 0 or more"),
        ("quadrature_points=17", "quadrature_points is 17; it must be from 1 to 16"),
    ],
)
def test_what_is_wrong_in_the_text_is_said_and_nothing_is_relaxed(text, said):
    obj = add_trefoil()
    bpy.context.scene.mobius_flow.options = text
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_relax()
    assert sentence(error.value).startswith(said)
    assert obj.data.shape_keys is None


def test_methods_have_names_for_people():
    shown = owners()[1]["method"]
    assert {item.identifier: item.name for item in shown.enum_items} == {k: each.label for k, each in METHODS.items()}
    assert "projected fractional Sobolev gradients" in shown.enum_items["lbfgs"].description
    assert {name for name, each in METHODS.items() if each.label == name} == set()


def test_the_expert_panel_shows_what_artists_might_set():
    expert = VIEW3D_PT_mobius_flow_expert
    assert expert.is_registered
    assert expert.bl_parent_id == VIEW3D_PT_mobius_flow.__name__
    assert "DEFAULT_CLOSED" in expert.bl_options
    wanted = ["untangle", "timing", "start_frame", "hold_start", "keyframes", "keep_size", "options"]
    assert shown(expert).settings == wanted
    assert "Sobolev Gradients for the Möbius Energy" in expert.bl_description


QUALITIES = properties.QUALITIES


def panel():
    return bpy.context.scene.mobius_flow_panel


@pytest.mark.parametrize("name", QUALITIES)
def test_choosing_a_quality_sets_its_options(name, capfd):
    settings = bpy.context.scene.mobius_flow
    assert panel().quality == "GOOD"
    panel().quality = "CUSTOM"
    assert panel().quality == "GOOD", "that leaves all as it is"
    settings.method, settings.vertices, settings.energy = "flow-l2", 77, "edge"
    assert panel().quality == "CUSTOM"
    settings.options += " nonsense"
    panel().quality = name
    assert (panel().quality, capfd.readouterr().err) == ("CUSTOM", "")
    settings.options = settings.options.removesuffix(" nonsense")
    panel().quality = name
    assert panel().quality == name
    for each, value in QUALITIES[name].values.items():
        assert getattr(settings, each) == (pytest.approx(value) if isinstance(value, float) else value)
    assert settings.energy == "edge"
    assert bpy.data.scenes.new("Other").mobius_flow_panel.quality == "GOOD", "every scene has its own"
    item = panel().bl_rna.properties["quality"].enum_items[name]
    assert (item.name, item.description) == (QUALITIES[name].label, QUALITIES[name].description)
    assert item.description.isprintable()


def test_good_is_what_the_library_does_by_itself_and_better_ones_have_less_energy():
    default = RelaxOptions()
    assert QUALITIES["GOOD"].values == {name: getattr(default, name) or 0 for name in QUALITIES["GOOD"].values}
    options = [RelaxOptions(**each.values | {"vertices": None}) for each in QUALITIES.values()]
    preview, good, exact = (minimize(torus_trefoil(60), each).final_energy for each in options)
    assert exact == pytest.approx(good, rel=1e-8)
    assert good < preview
    assert good - exact < 1e-4 * exact
    assert preview - exact < 0.05 * exact
