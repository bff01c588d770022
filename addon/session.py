"""One relaxation of one curve object: consumes iterates, then writes the animation.

A plain class: a blocking operator runs it to its end, a modal one calls `Session.step` from a timer. What it
knows lives here and never in the file.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from ..core import Curve, Iterate, MobiusFlowError, RelaxOptions, Status, relax
from ..core.collision import is_free
from . import keyframes
from .exchange import Placement, insert_points, read_curve
from .keyframes import KeyOptions, Output
from .motion import Motion, Proof

if TYPE_CHECKING:
    import bpy

Relaxation = Callable[[Curve, RelaxOptions], Iterator[Iterate]]


class State(Enum):
    """Where a session stands."""

    RUNNING = "running"
    DONE = "done"
    LOST = "lost"


@dataclass(frozen=True)
class Report:
    """What a finished session did.

    Attributes
    ----------
    name
        The object's name.
    iterate
        The last iterate.
    keys
        Number of keys written; 1 without animation.
    last_frame
        Scene frame of the last key.
    certified
        Whether every motion shown was proved free of contact.
    """

    name: str
    iterate: Iterate
    keys: int
    last_frame: float
    certified: bool

    @property
    def sentence(self) -> str:
        """The same for people."""
        proof = "proved free of contact" if self.certified else "NOT proved free of contact everywhere"
        animation = f"{self.keys} keys up to frame {self.last_frame:g}, " if self.keys > 1 else ""
        return f"'{self.name}' {self.iterate.message.rstrip('.')}; {animation}{proof}"

    @property
    def clean(self) -> bool:
        """Whether nothing needs the user's attention."""
        return self.certified and self.iterate.status is not Status.STALLED


class Session:
    """A relaxation of a curve object.

    Parameters
    ----------
    obj
        A curve object that `checks.refusal` has nothing against, its transforms evaluated.
    options, key_options
        What is asked for.
    relaxation, proof
        Yield the iterates, and prove motions free of contact.

    Raises
    ------
    MobiusFlowError
        If the curve cannot be relaxed; the message says why.
    """

    def __init__(
        self,
        obj: "bpy.types.Object",
        options: RelaxOptions,
        key_options: KeyOptions,
        relaxation: Relaxation = relax,
        proof: Proof = is_free,
    ) -> None:
        self._uid = obj.session_uid
        self._key_options = key_options
        self._proof = proof
        self._curve = read_curve(obj)
        self._motion = Motion(Placement.of(obj).to_local)
        self._iterates = relaxation(self._curve, options)
        self.state = State.RUNNING

    @property
    def object(self) -> "bpy.types.Object | None":
        """The object, found again whatever its name is now; None if it is gone."""
        import bpy

        return next((obj for obj in bpy.data.objects if obj.session_uid == self._uid), None)

    def step(self) -> bool:
        """Take in the next iterate; return whether more may come."""
        if self.state is State.RUNNING:
            iterate = next(self._iterates)
            self._motion.add(iterate)
            if iterate.status is not Status.RUNNING:
                self.state = State.DONE
        return self.state is State.RUNNING

    def run(self) -> Report:
        """Step to the end and write."""
        while self.step():
            pass
        return self.write()

    def write(self) -> Report:
        """Write what was collected so far to the object, which is touched here for the first time.

        Raises
        ------
        MobiusFlowError
            If the object is gone.
        """
        animated = self._key_options.output is not Output.RESULT
        keys = (
            self._motion.keys(self._proof, self._key_options.max_keys) if animated else self._motion.result(self._proof)
        )
        obj = self.object
        if obj is None:
            self.state = State.LOST
            raise MobiusFlowError("The curve object was deleted while it was being relaxed; nothing was written")
        insert_points(obj.data, self._curve, self._motion.start.curve)
        keyframes.write(obj, keys, self._key_options)
        last_frame = float(self._key_options.scene_frames(keys)[-1])
        return Report(obj.name, self._motion.last, len(keys.keys), last_frame, keys.certified)
