"""Sentences and labels that can still be said in another language after they were made."""

from collections.abc import Callable
from typing import Any


class Phrase(str):
    """An English sentence or label, filled in, that knows its template: translators see templates.

    It is used as any string is, and handed on by exceptions: ``str(MobiusFlowError(phrase))`` is the phrase. Operations
    on strings give plain ones, which nobody can translate; a phrase in a phrase is one of its values.

    Parameters
    ----------
    template
        A format string with named fields.
    values
        What the fields stand for.

    Examples
    --------
    >>> closed = Phrase("{name} is {state}", name="'A'", state=Phrase("closed"))
    >>> closed
    "'A' is closed"
    >>> closed.said({"{name} is {state}": "{name} ist {state}", "closed": "geschlossen"}.__getitem__)
    "'A' ist geschlossen"
    """

    template: str
    values: dict[str, Any]

    def __new__(cls, template: str, **values: Any) -> "Phrase":
        """Fill a template in."""
        phrase = super().__new__(cls, _filled(template, values))
        phrase.template, phrase.values = template, values
        return phrase

    def __str__(self) -> str:
        return self  # what exceptions ask for

    def said(self, translate: Callable[[str], str]) -> str:
        """Say it in a language, given by what its templates are there."""
        values = {name: said(value, translate) for name, value in self.values.items()}
        return _filled(translate(self.template), values)


def _filled(template: str, values: dict[str, Any]) -> str:
    return template.format(**values) if values else template  # braces in names are no fields


def said(value: Any, translate: Callable[[str], str]) -> Any:
    """Say a value in a language if it is a phrase; anything else, such as a name or a number, stays what it is."""
    return value.said(translate) if isinstance(value, Phrase) else value
