"""One relaxation of one curve object: consumes iterates, then writes the animation.

A plain class: a blocking operator runs it to its end, a modal one hands it the iterates of a worker (`live.run`).
What it knows lives here and never in the file.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING

from ..core import Curve, Iterate, MobiusFlowError, RelaxOptions, Status, relax
from ..core.collision import is_free
from ..core.types import FloatArray
from . import bevel, keyframes
from .exchange import Placement, insert_points, read_curve
from .keyframes import KeyOptions, Output
from .motion import Frame, Keys, Motion, Proof

if TYPE_CHECKING:
    import bpy

Relaxation = Callable[[Curve, RelaxOptions], Iterator[Iterate]]


class State(Enum):
    """Where a session stands."""

    RUNNING = "running"
    PAUSED = "paused"
    FINISHING = "finishing"
    DONE = "done"
    CANCELLED = "cancelled"
    LOST = "lost"

    @property
    def over(self) -> bool:
        """Whether nothing happens any more."""
        return self in (State.DONE, State.CANCELLED, State.LOST)


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
    radius
        Radius of the tube if it was fitted, in the object's units.
    """

    name: str
    iterate: Iterate
    keys: int
    last_frame: float
    certified: bool
    radius: float | None

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


@dataclass(frozen=True, eq=False)
class Prepared:
    """What is to be written: the keys, and the radius of the tube at each if it is fitted; shape (keys,)."""

    keys: Keys
    radii: FloatArray | None


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
        self._fits_bevel = key_options.fit_bevel and bevel.can_fit(obj.data)
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
            self.take(next(self._iterates))
        return self.state is State.RUNNING

    def take(self, iterate: Iterate) -> Frame:
        """Take in an iterate, and return its vertices as Blender will store them."""
        if iterate.status is not Status.RUNNING:
            self.state = State.DONE
        return self._motion.add(iterate)

    def interrupt(self, reason: str) -> None:
        """Make the iterate reached so far the last one; the reason is a sentence without its end."""
        last = self._motion.last
        self.take(replace(last, status=Status.INTERRUPTED, message=reason, path=()))

    def run(self) -> Report:
        """Step to the end and write."""
        while self.step():
            pass
        return self.write()

    def prepare(self) -> Prepared:
        """Choose and prove the keys; this touches nothing of Blender's and may be done in any thread."""
        animated = self._key_options.output is not Output.RESULT
        keys = (
            self._motion.keys(self._proof, self._key_options.max_keys) if animated else self._motion.result(self._proof)
        )
        mesh = self._motion.start.curve.mesh
        return Prepared(keys, bevel.radii(mesh, keys, self._key_options.output) if self._fits_bevel else None)

    def write(self) -> Report:
        """Write what was collected so far to the object, which is touched here for the first time.

        Raises
        ------
        MobiusFlowError
            If the object is gone.
        """
        prepared = self.prepare()
        for _ in self.writing(prepared):
            pass
        return self.report(prepared)

    def writing(self, prepared: Prepared) -> Iterator[None]:
        """Write in short pieces, so that a window can be drawn in between; raises as `write` does."""
        obj = self.object
        if obj is None:
            self.state = State.LOST
            raise MobiusFlowError("The curve object was deleted while it was being relaxed; nothing was written")
        self.insert_points(obj.data)
        radii = prepared.radii
        if radii is not None:
            bevel.fit(obj.data, float(radii[-1]))
        yield from keyframes.writing(
            obj, prepared.keys, self._key_options, None if radii is None else radii / radii[-1]
        )

    def insert_points(self, data: "bpy.types.Curve") -> None:
        """Give the splines the points of the refined curve, if they do not have them yet."""
        insert_points(data, self._curve, self._motion.start.curve)

    def report(self, prepared: Prepared) -> Report:
        """What was done, once it is written."""
        obj, keys, radii = self.object, prepared.keys, prepared.radii
        last_frame = float(self._key_options.scene_frames(keys)[-1])
        radius = None if radii is None else float(radii[-1])
        name = obj.name if obj else ""
        return Report(name, self._motion.last, len(keys.keys), last_frame, keys.certified, radius)
