"""Other languages than English: their tables, told to Blender, and the functions that say a sentence in the user's.

Blender itself translates what classes declare: names of operators, panels and settings, and their tooltips. Sentences
that are made when they are shown go through ``iface_``, ``tip_`` or ``rpt_``, as they are called in Blender's own
scripts: the user may want buttons, tooltips and reports each in English or not. Those of `core` are English everywhere.

All names have a context of their own, since Blender's words for the same English ones may mean something else: the
table of knots has no hyperlinks.
"""

from collections.abc import Callable, Iterable
from typing import Any

import bpy
from bpy.app import translations
from bpy.app.translations import pgettext_iface, pgettext_rpt, pgettext_tip

from ..engine.phrase import Phrase
from . import de

CONTEXT = "Möbius Flow"
LANGUAGES = {"de": de}  # a module each, with LABELS, SENTENCES and TOOLTIPS; "de" is for de_AT too
_ANY = "*"  # the context of tooltips: Blender looks for them nowhere else


def iface_(template: str, **values: Any) -> str:
    """Say what stands in the interface; ``template`` may be a phrase that is filled in already."""
    return _said(pgettext_iface, template, values)


def tip_(template: str, **values: Any) -> str:
    """Say what stands in a tooltip."""
    return _said(pgettext_tip, template, values)


def rpt_(template: str, **values: Any) -> str:
    """Say what is reported."""
    return _said(pgettext_rpt, template, values)


def _said(gettext: Callable[[str, str], str], template: str, values: dict[str, Any]) -> str:
    phrase = template if isinstance(template, Phrase) else Phrase(template, **values)
    return phrase.said(lambda text: gettext(text, CONTEXT))


def mark(classes: Iterable[type]) -> None:
    """Give classes that are about to be registered, and their properties, the context of our names."""
    for cls in classes:
        if not issubclass(cls, bpy.types.PropertyGroup):
            cls.bl_translation_context = CONTEXT  # type: ignore[attr-defined]
        for base in cls.__mro__:
            for each in _own_properties(base):
                each.keywords["translation_context"] = CONTEXT


def _own_properties(cls: type) -> list[Any]:
    """The properties that a class declares, if it is one of ours."""
    if not cls.__module__.startswith(__package__.rpartition(".")[0]):
        return []
    return [each for each in cls.__annotations__.values() if isinstance(each, bpy.props._PropertyDeferred)]


def register() -> None:
    """Tell Blender the tables."""
    translations.register(__package__, {code: _table(language) for code, language in LANGUAGES.items()})


def unregister() -> None:
    """Take them back."""
    translations.unregister(__package__)


def _table(language: Any) -> dict[tuple[str, str], str]:
    names = language.LABELS | language.SENTENCES
    return {(CONTEXT, text): said for text, said in names.items()} | {
        (_ANY, text): said for text, said in language.TOOLTIPS.items()
    }
