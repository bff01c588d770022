"""One relaxation of a group of curve objects: consumes iterates, then writes the animation.

A plain class: a blocking operator runs it to its end, a modal one hands it the iterates of a worker (`live.run`).
What it knows lives here and never in the file.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from ..core import Curve, Iterate, MobiusFlowError, RelaxOptions, Status, relax
from ..core.collision import is_free
from ..core.curve import Mesh
from ..core.types import FloatArray
from . import bevel
from .group import Group
from .key_options import KeyOptions, Output
from .motion import Keys, Motion, Proof
from .placement import Frame
from .words import named

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
    names
        The objects' names.
    iterate
        The last iterate.
    keys
        Number of keys written; 1 without animation.
    last_frame
        Scene frame of the last key.
    certified
        Whether every motion shown was proved free of contact, of each curve with itself and of all with each other.
    radius
        Radius of the tube if it was fitted, in the first object's units.
    modified
        Whether modifiers change what is shown: proofs are about the curves themselves.
    """

    names: tuple[str, ...]
    iterate: Iterate
    keys: int
    last_frame: float
    certified: bool
    radius: float | None
    modified: bool

    @property
    def sentence(self) -> str:
        """The same in words."""
        # nothing but the curves that were relaxed is looked at
        whom = "with itself" if len(self.names) == 1 else "with themselves and each other"
        whom += ", before modifiers" if self.modified else ""
        proof = f"proved free of contact {whom}" if self.certified else "NOT proved free of contact everywhere"
        animation = f"{self.keys} keys up to frame {self.last_frame:g}, " if self.keys > 1 else ""
        return f"{named(self.names)} {self.iterate.message.rstrip('.')}; {animation}{proof}"

    @property
    def clean(self) -> bool:
        """Whether nothing needs the user's attention."""
        return self.certified and self.iterate.status is not Status.STALLED


@dataclass(frozen=True, eq=False)
class Prepared:
    """What is to be written: the keys, and the radius of the tube at each if it is fitted; shape (keys,).

    Radii are in the common space of `Link`.
    """

    keys: Keys
    radii: FloatArray | None


class Session:
    """A relaxation of curve objects as one link.

    Parameters
    ----------
    group
        The objects.
    options, key_options
        The requested options.
    relaxation, proof
        Yield the iterates, and prove motions free of contact.

    Raises
    ------
    MobiusFlowError
        If the curves cannot be relaxed, or there is no room for their keys; the message says why.
    """

    def __init__(
        self,
        group: Group,
        options: RelaxOptions,
        key_options: KeyOptions,
        relaxation: Relaxation = relax,
        proof: Proof = is_free,
    ) -> None:
        key_options.check_room(options.max_iterations)
        self.group = group
        self._key_options = key_options
        self._proof = proof
        self._motion = Motion(group.link)
        self._iterates = relaxation(group.curve, options)
        self.state = State.RUNNING

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
        fits = self._key_options.fit_bevel and self.group.fits_bevel
        return Prepared(keys, self._radii(keys) if fits else None)

    def _radii(self, keys: Keys) -> FloatArray:
        """Radii of the tube at the keys, in the common space; without shape keys the last one only."""
        shown = keys.keys if self._key_options.output is Output.SHAPE_KEYS else keys.keys[-1:]
        mesh, common = self._mesh, self.group.link.to_common
        return np.array([bevel.fitting_radius(Curve(common(mesh, key.points), mesh)) for key in shown])

    @property
    def _mesh(self) -> Mesh:
        return self._motion.start.curve.mesh

    def write(self) -> Report:
        """Write what was collected so far to the objects, which are touched here for the first time.

        Whatever goes wrong, everything is put back as it was.

        Raises
        ------
        MobiusFlowError
            If an object is gone.
        """
        prepared = self.prepare()
        if reason := self.group.lost():
            self.state = State.LOST
            raise MobiusFlowError(f"{reason} during the relaxation; nothing was written")
        try:
            for _ in self.writing(prepared):
                pass
        except BaseException:
            self.group.restore()
            raise
        return self.report(prepared)

    def writing(self, prepared: Prepared) -> Iterator[None]:
        """Write in short pieces, so that a window can be drawn in between; all objects must be there."""
        self.make_polygons()
        yield from self.group.writing(self._mesh, prepared.keys, self._key_options, prepared.radii)

    def make_polygons(self) -> None:
        """Give the splines the points of the refined curves, if they do not have them yet."""
        self.group.make_polygons(self._motion.start.curve)

    def show(self, frame: Frame) -> None:
        """Move the points of all objects, as `take` returned them."""
        self.group.show(self._mesh, frame)

    def report(self, prepared: Prepared) -> Report:
        """What was done, once it is written."""
        keys, radii = prepared.keys, prepared.radii
        last_frame = float(self._key_options.scene_frames(keys)[-1])
        radius = None if radii is None else float(radii[-1])
        group, last = self.group, self._motion.last
        return Report(group.names, last, len(keys.keys), last_frame, keys.certified, radius, group.modified)
