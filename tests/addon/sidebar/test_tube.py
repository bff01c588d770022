"""What the sub-panel says of a tube: its radius in the scene's units, and whose it is."""

from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy")

from blender_scenes import add_trefoil  # noqa: E402
from mobius_flow.addon.curves.units import length  # noqa: E402
from mobius_flow.addon.sidebar.panels import VIEW3D_PT_mobius_flow_tube  # noqa: E402


@pytest.mark.parametrize(
    ("system", "scale", "said"),
    [("NONE", 1.0, "0.125"), ("METRIC", 1.0, "12.5 cm"), ("METRIC", 0.01, "1.25 mm"), ("IMPERIAL", 1.0, '4.921"')],
)
def test_lengths_are_in_the_scenes_units(system, scale, said):
    units = bpy.context.scene.unit_settings
    units.system, units.scale_length = system, scale
    assert length(bpy.context.scene, 0.125) == said


class Layout:
    """A double that keeps the labels and the buttons."""

    def __init__(self):
        self.labels, self.buttons, self.alignment = [], [], ""

    def column(self, align=False):
        return self

    row = split = lambda self, **_: self

    def label(self, text, translate):
        assert not translate, "it is in the user's language already"
        self.labels.append(text)

    def operator(self, name, icon):
        self.buttons.append(name)

    def prop(self, _owner, name):
        self.buttons.append(name)


def shown():
    layout = Layout()
    VIEW3D_PT_mobius_flow_tube.draw(SimpleNamespace(layout=layout, rows=VIEW3D_PT_mobius_flow_tube.rows), bpy.context)
    return layout


def test_the_radius_is_in_the_world_and_somebodys():
    obj = add_trefoil()
    assert shown().labels == ["Radius", "None"]
    obj.data.bevel_depth, obj.scale = 0.125, (2, 2, 2)
    bpy.context.view_layer.update()
    assert shown().labels == ["Radius", "25 cm (your own)"]
    bpy.ops.curve.mobius_flow_fit_tube()
    assert shown().labels[1].endswith(" m (fitted)")


def test_without_a_curve_there_are_the_buttons():
    layout = shown()
    assert layout.labels == []
    assert len(layout.buttons) == 5
    assert all(hasattr(bpy.ops.curve, name.removeprefix("curve.")) for name in layout.buttons)
