"""What a finished relaxation of curve objects did, and the sentence that says so."""

from collections import Counter
from dataclasses import dataclass
from typing import Any

from ...core import Outcome
from ...core.base import Message
from ...core.driver.words import named
from ...core.keys.motion import Kind


@dataclass(frozen=True)
class Report:
    """What a finished session did."""

    names: tuple[str, ...]  # the objects' names
    outcome: Outcome  # how the relaxation ended
    keys: int  # number of keys of the relaxed curves; 1 without animation
    kinds: Counter[Kind]  # how many new ones there are of each kind
    continues: bool  # whether the first of them is the last of those that were there
    replaced: int  # number of keys that were there before, and are not any more
    last_frame: float  # scene frame of the last key, or the last one on the way back
    scene_range: tuple[int, int] | None  # first and last frame of the animation with its rests, if there is one
    # whether every motion shown was proved free of contact, of each curve with itself, of all with each other, and
    # with what they avoid
    certified: bool
    radius: float | None  # radius of the tube in the world if it was fitted
    modified: bool  # whether modifiers change what is shown: proofs are about the curves themselves
    avoided: tuple[str, ...]  # names of the objects that were avoided

    @property
    def sentence(self) -> Message:
        # only the relaxed curves, and what they avoid, are examined
        alone = Message("proved free of contact with itself")
        proof = alone if len(self.names) == 1 else Message("proved free of contact with themselves and each other")
        if self.avoided:
            proof = Message("{proof}, and with {avoided}", proof=proof, avoided=named(self.avoided))
        if self.modified:
            proof = Message("{proof}, before modifiers", proof=proof)
        if not self.certified:
            proof = Message("NOT proved free of contact everywhere")
        facts: dict[str, Any] = {"names": named(self.names), "outcome": self.outcome.message, "proof": proof}
        if self.keys == 1:
            return Message("{names} {outcome}; {proof}", **facts)
        count = self.keys - self.continues
        if self.continues:
            said = Message("1 new key") if count == 1 else Message("{count} new keys", count=count)
        else:
            said = Message("{count} keys", count=count)
            if self.replaced:
                said = Message("{keys} in place of {count}", keys=said, count=self.replaced)
        if self.kinds[Kind.STEP] < count:
            mixed = "{keys} ({steps} iterates, {moves} strand moves, {meshes} changes of mesh, {added} in between)"
            names = ("steps", "moves", "meshes", "added")
            said = Message(mixed, keys=said, **{name: self.kinds[kind] for name, kind in zip(names, Kind, strict=True)})
        facts |= {"keys": said, "frame": self.last_frame}
        return Message("{names} {outcome}; {keys} up to frame {frame:g}, {proof}", **facts)
