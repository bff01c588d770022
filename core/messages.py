"""Messages are data: English sentences that keep their template and facts, for other words and other languages."""

from collections.abc import Callable, Mapping
from typing import Any


class Message(str):
    """An English sentence or label, filled in, that knows its template and its facts: translators see templates.

    It is used as any string is, and handed on by exceptions: ``str(MobiusFlowError(message))`` is the message.
    Operations on strings give plain ones, which nobody can translate; facts may be messages.

    Parameters
    ----------
    template
        A format string with named fields.
    facts
        What the fields stand for.

    Examples
    --------
    >>> closed = Message("{name} is {state}", name="'A'", state=Message("closed"))
    >>> closed
    "'A' is closed"
    >>> closed.said({"{name} is {state}": "{name} ist {state}", "closed": "geschlossen"}.__getitem__)
    "'A' ist geschlossen"
    """

    template: str
    facts: Mapping[str, Any]

    def __new__(cls, template: str, **facts: Any) -> "Message":
        """Fill a template in."""
        message = super().__new__(cls, cls._filled(template, facts))
        message.template, message.facts = template, facts
        return message

    def __str__(self) -> str:
        return self  # what exceptions ask for

    def said(self, translate: Callable[[str], str]) -> str:
        """The same in a language, given by what its templates are there."""
        facts = {name: fact.said(translate) if isinstance(fact, Message) else fact for name, fact in self.facts.items()}
        return self._filled(translate(self.template), facts)

    @classmethod
    def _filled(cls, template: str, facts: Mapping[str, Any]) -> str:
        return template.format(**facts) if facts else template  # braces in names are no fields
