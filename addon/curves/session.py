"""One relaxation of a group of curve objects: consumes iterates, then writes the animation.

A plain class: a blocking operator runs it, a modal one hands it the iterates of a worker (`live.run`).
What it knows lives here and never in the file.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import bpy
import numpy as np

from ...core import Curve, Hand, Iterate, Obstacle, Outcome, RelaxOptions, Status, Task, WithOutcome
from ...core.collision import is_free
from ...core.errors import CurveError, MobiusFlowError, OptionError
from ...core.messages import Message, Sentence
from ...core.types import FloatArray
from ..engine.key_options import KeyOptions, Output
from ..engine.motion import Key, Keys, Motion, Proof
from ..engine.obstacles import in_common_space
from ..engine.placement import Frame
from ..engine.size import Measure
from ..engine.words import named
from ..engine.worker import begun
from . import bake, bevel
from .blends import Goals
from .exchange import stretch
from .group import Group
from .pins import FREE, Held
from .surroundings import NOTHING, Surroundings


@dataclass(frozen=True)
class Report:
    """What a finished session did."""

    names: tuple[str, ...]  # the objects' names
    outcome: Outcome  # how the relaxation ended
    keys: int  # number of keys of the relaxed curves; 1 without animation
    continues: bool  # whether the first of them is the last of those that were there
    last_frame: float  # scene frame of the last key
    scene_range: tuple[int, int] | None  # first and last frame of the animation with its rests, if there is one
    # whether every motion shown was proved free of contact, of each curve with itself, of all with each other, and
    # with what they avoid
    certified: bool
    radius: float | None  # radius of the tube in the world if it was fitted
    modified: bool  # whether modifiers change what is shown: proofs are about the curves themselves
    avoided: tuple[str, ...]  # names of the objects that were avoided

    @property
    def sentence(self) -> Message:
        facts: dict[str, Any] = {"names": named(self.names), "outcome": self.outcome.message, "proof": self._proof}
        if self.keys == 1:
            return Message("{names} {outcome}; {proof}", **facts)
        facts |= {"count": self.keys - self.continues, "frame": self.last_frame}
        if self.continues and facts["count"] == 1:
            return Message("{names} {outcome}; 1 new key up to frame {frame:g}, {proof}", **facts)
        if self.continues:
            return Message("{names} {outcome}; {count} new keys up to frame {frame:g}, {proof}", **facts)
        return Message("{names} {outcome}; {count} keys up to frame {frame:g}, {proof}", **facts)

    @property
    def _proof(self) -> Message:
        if not self.certified:
            return Message("NOT proved free of contact everywhere")
        # only the relaxed curves, and what they avoid, are examined
        alone = Message("proved free of contact with itself")
        whom = alone if len(self.names) == 1 else Message("proved free of contact with themselves and each other")
        whom = Message("{proof}, and with {avoided}", proof=whom, avoided=named(self.avoided)) if self.avoided else whom
        return Message("{proof}, before modifiers", proof=whom) if self.modified else whom

    @property
    def clean(self) -> bool:
        """Whether nothing needs the user's attention."""
        return self.certified and self.outcome.status is not Status.STALLED


@dataclass(frozen=True, eq=False)
class Prepared:
    """What is to be written; (keys,) each."""

    keys: Keys
    frames: FloatArray
    radii: FloatArray | None  # of the tube, in the common space of `Link`, if it is fitted


class Session:
    """A relaxation of curve objects as one link; ``objects`` and ``continues`` as for `Group`.

    ``goals``: curve objects that it is to become, one after the other; by default it is relaxed alone.
    ``outcome``: how the relaxation ended, once it has.  Raises MobiusFlowError if the curves cannot be relaxed, or
    there is no room for their keys.
    """

    def __init__(
        self,
        objects: Sequence[bpy.types.Object],
        options: RelaxOptions,
        key_options: KeyOptions,
        continues: bool = False,
        surroundings: Surroundings = NOTHING,
        held: Held = FREE,
        goals: Sequence["bpy.types.Object"] = (),
    ) -> None:
        key_options.check_room(options.max_iterations)
        self.surroundings = surroundings
        self._key_options = key_options
        self.group = Group(objects, continues)
        try:
            self.goals = Goals(goals, self.group.curve)
            self.task, self.options = self._task(held, options.balance), options
            if continues:  # the keys that are there have as many points as the curves have now
                self.options = replace(options, vertices=len(self.group.curve), mesh="fixed", untangle="never")
        except BaseException:
            self.group.discard()
            raise
        self.motion = Motion(self.group.link, self.group.stored if continues else None, self._measure)
        self._last: Iterate | None = None
        self._repinned = False  # whether a hand has left pins
        self.outcome: Outcome | None = None

    def _task(self, held: Held, balance: bool) -> Task:
        """The curves with what is pinned and avoided; raises MobiusFlowError if they do not go together."""
        pins = tuple(sorted({*held.points, *self.group.pins}))
        curve, obstacles = self.group.curve, self.surroundings.obstacles
        task = Task(curve=curve, obstacles=obstacles, pins=pins, pin_tangents=held.tangents and bool(pins))
        if task.pins or task.obstacles:
            self._key_options.check_place()
        if obstacles and balance:
            raise OptionError(Message("Balance does not go with what is avoided; leave it out, or avoid nothing"))
        return task

    def run(self, drag: Callable[[Hand, Iterate], object] | None = None) -> Report:
        """Do the whole job; raises MobiusFlowError if the curves cannot be relaxed, or an object is gone.

        ``drag`` gets a hand, and the iterates in the world, between which it may tell the hand what to do.
        """
        try:
            prepared = self._relaxed(drag)
            if reason := self.lost():
                raise MobiusFlowError(Message("{reason} during the relaxation; nothing was written", reason=reason))
            for _ in self.writing(prepared):
                pass
        except BaseException:
            self.group.discard()
            raise
        return self.report(prepared)

    def _relaxed(self, drag: Callable[[Hand, Iterate], object] | None) -> Prepared:
        hand = Hand()
        try:
            run = WithOutcome(begun(self.task, self.options, self.goals.curves, hand))
            for iterate in run:
                self.take(iterate)
                if drag is not None:
                    drag(hand, iterate)
        except CurveError as error:
            raise self.reworded(error) from error
        assert run.outcome is not None, "the loop is through"
        self.end(run.outcome)
        return self.prepare(partial(is_free, obstacles=self._avoided))

    @cached_property
    def _avoided(self) -> tuple[Obstacle, ...]:
        return in_common_space(self.task.obstacles, self.group.link)

    def lost(self) -> Message | None:
        """Say what was done to one of the objects, or to what they avoid, that makes it impossible to go on."""
        return self.group.lost(alone=not self.task.obstacles) or self.surroundings.lost()

    def reworded(self, error: CurveError) -> CurveError:
        """The core's error in Blender's words; those about options use the names that options have."""
        if isinstance(error, OptionError):
            return error
        return CurveError(Sentence("{reason}", reason=self.group.reworded(str(error))), error.place)

    def end(self, outcome: Outcome) -> None:
        self.outcome = replace(outcome, clauses=tuple(map(self.group.reworded, outcome.clauses)))

    @property
    def _measure(self) -> Measure:
        """The measure of size that stays constant."""
        if self.goals.curves:  # which have sizes of their own
            return Measure.LENGTH
        stays = self.task.pins or self.task.obstacles or self.options.grow != 1.0
        return self._key_options.keep_size or (Measure.LENGTH if stays else Measure.RADIUS)

    def take(self, iterate: Iterate) -> None:
        """Record an iterate as it is shown, in the size that is to be kept."""
        before, self._last = self._last, iterate
        if before is not None and before.curve.mesh == iterate.curve.mesh:
            self._repinned |= before.pins != iterate.pins
        self.motion.add(iterate)
        self.goals.note(iterate)

    def show(self, there: Key | None = None) -> None:
        """Show a shape, by default the last iterate with the pins that a hand left, its tube as thick as at a key."""
        frame, fits = self.motion.frame if there is None else there.points, self.group.fits(self._key_options)
        self.group.show(self.motion.start, frame, self._key_options, self._radius(frame) if fits else None)
        if there is None:
            self._mark_pins()

    def at(self, frame: float) -> Key:
        """The shape that a scene frame would have if this were the end."""
        return self.motion.at(frame, self._key_options.timing)

    def _mark_pins(self) -> None:
        """Mark the points where the last iterate, which may have fewer vertices, has pins."""
        if self._repinned and (last := self.motion.last) is not None:
            link, curve = self.group.link, last.curve
            shown = link.to_common(self.motion.start.mesh, self.motion.frame)
            pins = link.to_common(curve.mesh, link.to_stored(curve.mesh, curve.vertices))[list(last.pins)]
            self.group.mark_pins([int(np.linalg.norm(shown - pin, axis=1).argmin()) for pin in pins])

    def prepare(self, proof: Proof) -> Prepared:
        """Choose and prove the keys; this touches nothing of Blender's and may be done in any thread."""
        motion = self.motion
        timing = self._key_options.timing.shortened(motion.way) if self.group.continues else self._key_options.timing
        animated, limit = self._key_options.animated, self._key_options.max_keys
        keys = motion.keys(proof, limit, timing.pace) if animated else motion.result(proof)
        radii = self._radii(keys) if self.group.fits(self._key_options) else None
        return Prepared(keys, timing.frames(motion.course(keys)), radii)

    def _radii(self, keys: Keys) -> FloatArray:
        """Radii of the tube at the keys, in the common space; without shape keys the last one only."""
        # an animation that goes on may have shape keys whatever is asked for, see `Member.writing`
        shape_keys = self._key_options.output is Output.SHAPE_KEYS or self.group.continues
        shown = keys.keys if shape_keys else keys.keys[-1:]
        radii = np.array([self._radius(key.points) for key in shown])
        return np.full_like(radii, radii.min()) if self._key_options.constant_radius else radii

    def _radius(self, frame: Frame) -> float:
        """Radius of the tube, as thick as free of contact allows, in the common space."""
        mesh = self.motion.start.mesh
        return bevel.fitting_radius(Curve(self.group.link.to_common(mesh, frame), mesh), self._avoided)

    def reopen(self) -> None:
        """Go on after `Group.discard`; raises MobiusFlowError if the curves are not what they were at the start."""
        changed = Message("{names} changed since the relaxation ended; relax anew", names=self.group.title)
        objects = self.group.objects
        if len(objects) < len(self.group.names) or self.surroundings.lost():
            raise MobiusFlowError(changed)
        group = Group(objects, self.group.continues)
        if not group.equals(self.group):
            group.discard()
            raise MobiusFlowError(changed)
        self.group = group

    def writing(self, prepared: Prepared) -> Iterator[None]:
        """Write in short pieces, so that a window can be drawn in between; all objects must be there."""
        self.group.make_polygons(self.motion.start)
        self._mark_pins()
        yield from self.group.writing(
            self.motion.start.mesh, prepared.keys, prepared.frames, self._key_options, prepared.radii
        )
        self.goals.paint(self.group.objects, prepared.keys, prepared.frames, self._key_options.timing)

    def report(self, prepared: Prepared) -> Report:
        assert self.outcome is not None, "what is written has ended"
        keys, frames, group = prepared.keys, prepared.frames, self.group
        return Report(
            names=group.names,
            outcome=self.outcome,
            keys=len(keys.keys),
            continues=group.continues,
            last_frame=float(frames[-1]),
            scene_range=bake.scene_range(group.objects),
            certified=keys.certified,
            radius=None if prepared.radii is None else float(prepared.radii[-1]) * stretch(group.objects[0]),
            modified=group.modified,
            avoided=self.surroundings.names,
        )
