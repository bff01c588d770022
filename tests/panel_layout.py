"""A double of what panels draw into."""

from types import SimpleNamespace

import bpy


class Layout:
    """A double that keeps the labels, the settings and the buttons."""

    def __init__(self):
        self.labels, self.settings, self.buttons = [], [], []

    def label(self, text, **_):
        self.labels.append(text)

    def operator(self, name, **_):
        self.buttons.append(name)
        return SimpleNamespace()

    def operator_menu_enum(self, name, _property):
        self.buttons.append(name)

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
