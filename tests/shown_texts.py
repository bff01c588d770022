"""All that the extension shows in words: what its classes declare, and the sentences in its code."""

import ast
from functools import cache
from pathlib import Path

import bpy
from mobius_flow.addon import registration
from mobius_flow.core.knots import KNOTS

ADDON = Path(registration.__file__).parent
CORE = ADDON.parent / "core"
# what is called with a text, and as which argument
_MARKS = dict.fromkeys(["Condition", "Message", "adding", "iface_", "rpt_", "stalled", "stalling", "tip_"], 0)
_MARKS |= {"_refused": 1, "sentence": 2, "value": 1}
_SAYS = {"report": 2, "poll_message_set": 1, "Refusal": 1}  # what must be told marked texts, by its arguments
_DRAWS = {"invoke_confirm", "label", "menu", "operator", "prop", "prop_enum"}  # what Blender draws
_WORDS = {"message", "text", "title"}  # what it is told to draw, by these names


def labels():
    """Titles of operators, panels and menus, names of settings and of what they let choose."""
    names = {cls.bl_label for cls in registration.CLASSES if hasattr(cls, "bl_label")}
    for each in _properties():
        names |= {each.name, *(item.name for item in _items(each))}
    return {name for name in names if name and name not in KNOTS}


def tooltips():
    """Descriptions of the same."""
    told = {_rna(cls).description for cls in registration.CLASSES if issubclass(cls, bpy.types.Operator)}
    for each in _properties():
        told |= {each.description, *(item.description for item in _items(each))}
    return {text for text in told if text}


def _rna(cls):
    if not issubclass(cls, bpy.types.Operator):
        return cls.bl_rna
    room, name = cls.bl_idname.split(".")
    return getattr(getattr(bpy.ops, room), name).get_rna_type()


def _properties():
    """The properties that our classes declare; Blender's own are not ours to translate."""
    for cls in registration.CLASSES:
        declared = {name for base in cls.__mro__ if _is_ours(base) for name in _deferred(base)}
        yield from (each for each in _rna(cls).properties if each.identifier in declared)


def _is_ours(cls):
    return cls.__module__.startswith("mobius_flow.")


def _deferred(cls):
    return (name for name, each in cls.__annotations__.items() if isinstance(each, bpy.props._PropertyDeferred))


def _items(each):
    return [*each.enum_items, *each.enum_items_static_ui] if each.type == "ENUM" else []


@cache
def sentences(*paths):
    """Templates of what is said, which are marked, and labels that buttons are given where they are drawn."""
    paths = paths or [*ADDON.rglob("*.py"), *CORE.rglob("*.py")]
    return {text for path in paths for text in _marked(ast.parse(path.read_text("utf-8")))}


def _marked(tree):
    constants = _constants(tree)
    for call in _calls(tree):
        name = _name(call)
        given = call.args[_MARKS[name] :][:1] if name in _MARKS else []
        given += [each.value for each in call.keywords if each.arg in _WORDS and name in _DRAWS]
        for text in given:
            yield from _texts(text, constants)


def _constants(tree):
    """The texts that names are given anywhere in a module."""
    found = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign):
            names, values = _several(node.targets[0]), _several(node.value)
            for name, value in zip(names, values, strict=False):
                if isinstance(name, ast.Name):
                    found.setdefault(name.id, set()).update(_texts(value, {}))
    return found


def _several(node):
    return node.elts if isinstance(node, ast.Tuple) else [node]


def _texts(node, constants):
    """The texts that an expression may be."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield from [node.value] if any(map(str.isalpha, node.value)) else []
    elif isinstance(node, ast.IfExp):
        yield from _texts(node.body, constants)
        yield from _texts(node.orelse, constants)
    elif isinstance(node, ast.Name):
        yield from constants.get(node.id, ())


def unmarked(path):
    """Lines where something is shown that cannot be translated: said as it is, or put together from pieces."""
    for call in _calls(ast.parse(path.read_text("utf-8"))):
        shown = _shown(call)
        if any(isinstance(each, ast.JoinedStr) and any(map(_has_words, each.values)) for each in shown):
            yield call.lineno
        if _name(call) in _SAYS and not all(isinstance(each, ast.Call) and _name(each) in _MARKS for each in shown):
            yield call.lineno


def _has_words(part):
    return isinstance(part, ast.Constant) and any(map(str.isalpha, part.value))


def _shown(call):
    name = _name(call)
    said = call.args[-1:] if _SAYS.get(name) == len(call.args) else []
    drawn = [each.value for each in call.keywords if each.arg in _WORDS] if name in _DRAWS else []
    return said + drawn + (call.args[_MARKS[name] :] if name in _MARKS else [])


def _calls(tree):
    return (node for node in ast.walk(tree) if isinstance(node, ast.Call))


def _name(call):
    return getattr(call.func, "attr", getattr(call.func, "id", ""))
