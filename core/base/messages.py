"""Messages are data: English sentences that keep their template and facts, for other words and other languages."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

# parts of curves, numbered from 1, and what is around them: facts of other messages, for which Blender has other words
COMPONENT, OBSTACLE = "component {number}", "obstacle {name}"
EDGE, VERTEX, VERTEX_COUNT = "edge {number}", "vertex {number}", "{count} vertices"
OF_GOAL = "{goal}: {reason}"  # what a curve is to become has parts of its own


class Message(str):
    """An English sentence or label, filled in, that knows its template and its facts: translators see templates.

    It is used as any string is, and handed on by exceptions: ``str(MobiusFlowError(message))`` is the message.
    Operations on strings give plain ones, which nobody can translate; facts may be messages.  The template is a format
    string with named fields; a message without facts marks one for translators.

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
        return self._filled(translate(self.template), self._with_messages(lambda fact: fact.said(translate)))

    def reworded(self, word: Callable[["Message"], "Message"]) -> "Message":
        """The same with other words for it and for the messages among its facts."""
        return word(type(self)(self.template, **self._with_messages(lambda fact: fact.reworded(word))))

    def _with_messages(self, change: Callable[["Message"], str]) -> dict[str, Any]:
        return {name: change(fact) if isinstance(fact, Message) else fact for name, fact in self.facts.items()}

    @classmethod
    def _filled(cls, template: str, facts: Mapping[str, Any]) -> str:
        return template.format(**facts) if facts else template  # braces in names are no fields


class Sentence(Message):
    """A message with a capital at its start, in any language."""

    @classmethod
    def _filled(cls, template: str, facts: Mapping[str, Any]) -> str:
        text = super()._filled(template, facts)
        return text[:1].upper() + text[1:]


def joined(parts: Sequence[str], between: str) -> Message:
    """Messages one after the other."""
    facts = {f"part_{k}": part for k, part in enumerate(parts)}
    return Message(between.join(f"{{{name}}}" for name in facts), **facts)
