"""Languages other than English: a ``.po`` file each, registered with Blender, and the functions that translate.

Blender itself translates what classes declare: names of operators, panels and settings, and their tooltips. Sentences
that are made when they are shown go through ``iface_``, ``tip_`` or ``rpt_``, as they are called in Blender's own
scripts: the user may want buttons, tooltips and reports each in English or not. Those of `core` are English everywhere.

All names have a context of their own, since Blender's words for the same English ones may mean something else: the
table of knots has no hyperlinks.
"""

import json
import logging
import re
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any

import bpy
from bpy.app import translations
from bpy.app.translations import pgettext_iface, pgettext_rpt, pgettext_tip

from ...core.base.messages import Message

CONTEXT = "Möbius Flow"  # of all but tooltips, which Blender looks up without a context
ANY = "*"  # what Blender calls the context of entries that have none

Table = dict[tuple[str, str], str]
_ENTRY = re.compile(r'(?:msgctxt (".*")\n)?msgid (".*"(?:\n".*")*)\nmsgstr (".*"(?:\n".*")*)')


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
    """Read the ``.po`` files of a folder, named by Blender's codes of languages: ``de`` serves for de_AT, too.

    A file that cannot be read leaves its language in English, and a warning in the log.
    """
    found = {}
    for path in sorted(folder.glob("*.po")):
        try:
            found[path.stem] = read_po(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            logging.getLogger(__name__).warning("%s is not used: %s", path, error)
    return found


def read_po(text: str) -> Table:
    """Read a PO file into what Blender takes: translations by context and original.

    Entries are separated by blank lines. The header is left out, and so are entries that are empty, fuzzy or obsolete.

    Raises
    ------
    ValueError
        If an entry is malformed, or there twice; the message quotes it.

    Examples
    --------
    >>> read_po('msgctxt "Möbius Flow"\\nmsgid "Links"\\nmsgstr "Verschlingungen"')
    {('Möbius Flow', 'Links'): 'Verschlingungen'}
    """
    table: Table = {}
    for entry in re.split(r"\n\s*\n", text):
        lines = [line for line in map(str.strip, entry.split("\n")) if line and not line.startswith("#")]
        found = _ENTRY.fullmatch("\n".join(lines))
        if lines and found is None:
            raise ValueError(f"not an entry of a PO file without plurals:\n{entry}")
        # PO quotes as JSON does
        quoted = found.groups("") if found is not None else ("", "", "")
        context, original, translation = ("".join(map(json.loads, each.splitlines())) for each in quoted)
        if (key := (context or ANY, original)) in table:
            raise ValueError(f"there twice:\n{entry}")
        if original and translation and not re.search("^#,.*fuzzy", entry, re.MULTILINE):
            table[key] = translation
    return table
