"""How much of a motion is free of contact, and what ends it."""

from dataclasses import dataclass
from enum import Enum

from ..messages import EDGE, EDGES, Message


class Limit(Enum):
    """What ends a free motion."""

    NONE = "the whole motion is free of contact"
    CONTACT = "edges, or an edge and an obstacle, meet, or come too near to each other to be told apart"
    TOUCHING_START = "edges, or an edge and an obstacle, touch, or cannot be told apart, at the start"
    NOT_FINITE = "a vertex is not finite"
    UNTESTED = "in more than three dimensions, where nothing is knotted, contact is not tested"


@dataclass(frozen=True)
class Contact:
    """What is in the way of a motion."""

    edges: tuple[int, ...]  # the two edges that meet, or the one that meets an obstacle
    obstacle: str | None = None  # what sentences call it; None if edges meet

    @property
    def message(self) -> Message:
        """The two, as sentences call them."""
        first, *second = (edge + 1 for edge in self.edges)
        if self.obstacle is None:
            return Message(EDGES, first=first, second=second[0])
        return Message("{edge} and {obstacle}", edge=Message(EDGE, number=first), obstacle=self.obstacle)


@dataclass(frozen=True)
class FreeMotion:
    """How much of a motion is proved free of contact.

    Attributes
    ----------
    time
        No two non-neighbour edges, and no edge and obstacle, meet at any time t in [0, time], unless time is 0; 1 if
        the whole motion is free. If two meet, this is at most 2 % before the contact.
    """

    time: float
    contact: Contact | None = None  # what limits it, None if nothing does
    limit: Limit = Limit.NONE  # the reason

    @property
    def pair(self) -> tuple[int, int] | None:
        """The two edges that limit it; None if it is not limited, or by an obstacle."""
        if self.contact is None or self.contact.obstacle is not None:
            return None
        i, j = self.contact.edges
        return i, j

    @property
    def proved(self) -> bool:
        """Whether the whole motion is proved free of contact."""
        return self.limit is Limit.NONE
