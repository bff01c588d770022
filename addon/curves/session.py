"""One relaxation of a group of curve objects: consumes iterates, then writes the animation.

A plain class: a blocking operator runs it, a modal one hands it the iterates of a worker (`live.run`).
What it knows lives here and never in the file.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...core import Curve, Iterate, MobiusFlowError, Outcome, RelaxOptions, Status, relax
from ...core.collision import is_free
from ...core.curve import Mesh
from ...core.types import FloatArray
from ..engine.key_options import KeyOptions, Output
from ..engine.motion import Keys, Motion, Proof
from ..engine.placement import Frame
from ..engine.words import named
from . import bevel
from .group import Group


@dataclass(frozen=True)
class Report:
    """What a finished session did.

    Attributes
    ----------
    names
        The objects' names.
    outcome
        How the relaxation ended.
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
    outcome: Outcome
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
        return f"{named(self.names)} {self.outcome.message.rstrip('.')}; {animation}{proof}"

    @property
    def clean(self) -> bool:
        """Whether nothing needs the user's attention."""
        return self.certified and self.outcome.status is not Status.STALLED


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

    Attributes
    ----------
    outcome
        How the relaxation ended, once it has.

    Raises
    ------
    MobiusFlowError
        If the curves cannot be relaxed, or there is no room for their keys; the message says why.
    """

    def __init__(self, group: Group, options: RelaxOptions, key_options: KeyOptions) -> None:
        key_options.check_room(options.max_iterations)
        self.group = group
        self._options, self._key_options = options, key_options
        self._motion = Motion(group.link)
        self.outcome: Outcome | None = None

    def run(self) -> Report:
        """Do the whole job. Objects are touched at its end only, and put back if that fails.

        Raises
        ------
        MobiusFlowError
            If the curves cannot be relaxed, or an object is gone.
        """
        relaxation = relax(self.group.curve, self._options)
        while self.outcome is None:
            try:
                self.take(next(relaxation))
            except StopIteration as end:
                self.outcome = end.value
        prepared = self.prepare(is_free)
        if reason := self.group.lost():
            raise MobiusFlowError(f"{reason} during the relaxation; nothing was written")
        try:
            for _ in self.writing(prepared):
                pass
        except BaseException:
            self.group.restore()
            raise
        return self.report(prepared)

    def take(self, iterate: Iterate) -> Frame:
        """Take in an iterate, and return its vertices as Blender will store them."""
        return self._motion.add(iterate)

    def prepare(self, proof: Proof) -> Prepared:
        """Choose and prove the keys; this touches nothing of Blender's and may be done in any thread."""
        animated = self._key_options.output is not Output.RESULT
        keys = self._motion.keys(proof, self._key_options.max_keys) if animated else self._motion.result(proof)
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

    def writing(self, prepared: Prepared) -> Iterator[None]:
        """Write in short pieces, so that a window can be drawn in between; all objects must be there."""
        self.group.make_polygons(self._motion.start.curve)
        yield from self.group.writing(self._mesh, prepared.keys, self._key_options, prepared.radii)

    def report(self, prepared: Prepared) -> Report:
        """What was done, once it is written."""
        keys, radii = prepared.keys, prepared.radii
        last_frame = float(self._key_options.scene_frames(keys)[-1])
        radius = None if radii is None else float(radii[-1])
        assert self.outcome is not None, "what is written has ended"
        group = self.group
        return Report(group.names, self.outcome, len(keys.keys), last_frame, keys.certified, radius, group.modified)
