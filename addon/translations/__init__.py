"""Languages other than English: a ``.po`` file each, registered with Blender, and the functions that translate.

Blender itself translates what classes declare: names of operators, panels and settings, and their tooltips. Sentences
that are made when they are shown go through ``iface_``, ``tip_`` or ``rpt_``, as they are called in Blender's own
scripts: the user may want buttons, tooltips and reports each in English or not. Those of `core` are English everywhere.

All names have a context of their own, since Blender's words for the same English ones may mean something else: the
table of knots has no hyperlinks.
"""

import json
import re
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any

import bpy
from bpy.app import translations
from bpy.app.translations import pgettext_iface, pgettext_rpt, pgettext_tip

from ...core.base import Message

CONTEXT = "Möbius Flow"  # of all but tooltips, which Blender looks up without a context
ANY = "*"  # what Blender calls the context of entries that have none

Table = dict[tuple[str, str], str]
_ENTRY = re.compile(r'^(?:msgctxt (".*")\n)?msgid (".*")\nmsgstr (".*")$', re.MULTILINE)


def _said(gettext: Callable[[str, str], str], template: str, **values: Any) -> str:
    """Translate a template, and fill it in, or a phrase that is filled in already."""
    phrase = template if isinstance(template, Message) else Message(template, **values)
    return phrase.said(lambda text: gettext(text, CONTEXT))


iface_ = partial(_said, pgettext_iface)  # text of the interface
tip_ = partial(_said, pgettext_tip)  # of tooltips
rpt_ = partial(_said, pgettext_rpt)  # of reports


def mark(classes: Iterable[type]) -> None:
    """Give classes that are about to be registered, and their properties, the context of our names."""
    for cls in classes:
        if not issubclass(cls, bpy.types.PropertyGroup):
            cls.bl_translation_context = CONTEXT  # type: ignore[attr-defined]
        for base in cls.__mro__:
            ours = base.__module__.startswith(__package__.rpartition(".")[0])
            for each in base.__annotations__.values() if ours else ():
                if isinstance(each, bpy.props._PropertyDeferred):
                    each.keywords["translation_context"] = CONTEXT


def register() -> None:
    """Hand Blender the tables of all languages."""
    translations.register(__package__, tables(Path(__file__).parent))


def unregister() -> None:
    translations.unregister(__package__)


def tables(folder: Path) -> dict[str, Table]:
    """Read the ``.po`` files of a folder, named by Blender's codes of languages: ``de`` serves for de_AT, too."""
    return {path.stem: read_po(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.po"))}


def read_po(text: str) -> Table:
    """Read a PO file, each text of which is on one line, into what Blender takes: translations by context and original.

    Examples
    --------
    >>> read_po('msgctxt "Möbius Flow"\\nmsgid "Links"\\nmsgstr "Verschlingungen"')
    {('Möbius Flow', 'Links'): 'Verschlingungen'}
    """
    # PO quotes as JSON does
    entries = [map(json.loads, (context or f'"{ANY}"', *words)) for context, *words in _ENTRY.findall(text)]
    return {(context, original): said for context, original, said in entries if original}
