"""Docstrings as they are written, |u| and u_ and all: to reStructuredText these are markup."""

import re

from docutils import nodes
from sphinx.application import Sphinx

_CODE = re.compile(r"(``.*?``|`.*?`|:\w+:`.*?`)")
_ARRAY = re.compile(r"~?numpy\.ndarray\[.+?dtype\[[^]]*\]\]")
_LIKE_ARRAY = re.compile(
    r"~?numpy\._typing\._array_like\.ArrayLike"  # of NumPy 2.5; before, what it stands for
    r"|(?:[~\w.]*Buffer \| )?[~\w.]*_SupportsArray\[.*?_NestedSequence\[(?:bool|complex)\b[^]]*\]"
)
_MARKUP = re.compile(r"\||\*|(?<=\w)_(?!\w)")


def escape(_app: Sphinx, _what: str, _name: str, _object: object, _options: object, lines: list[str]) -> None:
    """Escape what is not code and not an example."""
    for number, line in enumerate(lines):
        if not line.lstrip().startswith((">>>", "...")):
            parts = _CODE.split(line)
            parts[::2] = (_MARKUP.sub(r"\\\g<0>", part) for part in parts[::2])
            lines[number] = "".join(parts)


def shorten(*event: object) -> tuple[str | None, ...]:
    """Let arrays be arrays in signatures: shapes are in the docstrings, and numbers are doubles."""
    named = (text and _ARRAY.sub("~numpy.ndarray", str(text)) for text in event[-2:])
    return tuple(text and _LIKE_ARRAY.sub("~numpy.typing.ArrayLike", text) for text in named)


def set_dashes(_app: Sphinx, document: nodes.document) -> None:
    """Put a dash where Sphinx puts hyphens, between a parameter and what it is."""
    for text in list(document.findall(nodes.Text)):
        if text in (" -- ", " - "):
            text.parent.replace(text, nodes.Text(" – "))


def setup(app: Sphinx) -> dict[str, bool]:
    """Come before napoleon, whose own markup must stay."""
    app.connect("autodoc-process-docstring", escape, priority=100)
    app.connect("autodoc-process-signature", shorten)
    app.connect("doctree-read", set_dashes)
    return {"parallel_read_safe": True}
