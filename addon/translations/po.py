"""Translations as text: the PO format of GNU gettext without plurals, as Blender's own translation tools write it."""

import json
import re

ANY = "*"  # what Blender calls the context of entries that have none
_FIELDS = ("msgctxt", "msgid", "msgstr")

Table = dict[tuple[str, str], str]


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
        fields = _fields(entry)
        key = fields.get("msgctxt", ANY), fields.get("msgid", "")
        if key in table:
            raise ValueError(f"there twice:\n{entry}")
        if key[1] and fields["msgstr"] and not re.search("^#,.*fuzzy", entry, re.MULTILINE):
            table[key] = fields["msgstr"]
    return table


def _fields(entry: str) -> dict[str, str]:
    """The strings of an entry by their keywords; PO quotes as JSON does."""
    fields: dict[str, str] = {}
    field = ""
    for line in map(str.strip, entry.split("\n")):
        if line and not line.startswith("#"):
            keyword = line.partition('"')[0]
            field = keyword.strip() or field
            if field not in _FIELDS or (keyword and field in fields):
                raise ValueError(f"not an entry of a PO file without plurals:\n{entry}")
            fields[field] = fields.get(field, "") + json.loads(line[len(keyword) :])
    if fields and not {"msgid", "msgstr"} <= fields.keys():
        raise ValueError(f"msgid or msgstr is missing:\n{entry}")
    return fields
