"""Names of objects in sentences, and Blender's words for parts of curves and for how runs end."""

from collections.abc import Sequence

from ...core.driver.outcome import AT_REST, RAISED
from ...core.messages import COMPONENT, EDGE, OBSTACLE, OF_GOAL, VERTEX, VERTEX_COUNT, Message

_MAX_NAMES = 3
_SPLINE = "spline {number} of {name}"
_WORDS = {
    AT_REST: Message("converged"),
    EDGE: Message("segment {number}"),
    OBSTACLE: Message("'{name}'"),
    RAISED: Message("with more points the energy turned out higher: {rises}"),
    VERTEX: Message("point {number}"),
    VERTEX_COUNT: Message("{count} points"),
}


def named(names: Sequence[str]) -> str:
    """Join names, such as 'A', 'B' and 'C'; of many the first, and how many more there are."""
    if len(names) > _MAX_NAMES + 1:
        first, count = ", ".join(map(_quoted, names[:_MAX_NAMES])), len(names) - _MAX_NAMES
        return Message("{names} and {count} more", names=first, count=count)
    *others, last = map(_quoted, names)
    return Message("{names} and {last}", names=", ".join(others), last=last) if others else last


def _quoted(name: str) -> str:
    return f"'{name}'"


def spline_names(objects: Sequence[str], counts: Sequence[int]) -> list[Message]:
    """Names of all splines of some objects, given how many each object has."""
    return [
        Message(_SPLINE, number=k, name=_quoted(name))
        for name, count in zip(objects, counts, strict=True)
        for k in range(1, count + 1)
    ]


def in_blenders_words(message: str, splines: Sequence[Message]) -> str:
    """A message of the core in the words of somebody who sees objects; ``splines`` names the components in turn."""

    def word(said: Message) -> Message:
        if said.template == COMPONENT:
            number: int = said.facts["number"]
            return splines[number - 1] if goal is None else Message(_SPLINE, number=number, name=goal)
        return Message(_WORDS[said.template], **said.facts) if said.template in _WORDS else said

    if not isinstance(message, Message):
        return message
    goal = message.facts["goal"] if message.template == OF_GOAL else None
    return (message if goal is None else message.facts["reason"]).reworded(word)


def time_left(seconds: float) -> Message:
    """Say how long something will still take, to one digit."""
    if seconds < 100.0:
        return Message("about {count:.0f} s left", count=float(f"{seconds:.0e}"))
    return Message("about {count:.0f} min left", count=float(f"{seconds / 60:.0e}"))
