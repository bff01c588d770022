"""One relaxation of a group of curve objects: consumes iterates, then writes the animation.

A plain class: a blocking operator runs it, a modal one hands it the iterates of a worker (`live.run`).
What it knows lives here and never in the file.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import bpy
import numpy as np

from ...core import Curve, Hand, Iterate, Obstacle, Outcome, RelaxOptions, Status, Task, WithOutcome
from ...core.base.errors import CurveError, MobiusFlowError, OptionError
from ...core.base.messages import Message, Sentence
from ...core.base.types import FloatArray
from ...core.collision import is_free
from ...core.driver.words import named
from ...core.keys.key_options import Course, KeyOptions, Output
from ...core.keys.motion import Key, Keys, Kind, Proof, Recording
from ...core.keys.placement import Frame, Measure
from ...core.keys.tube import eased
from ..engine.worker import begun, in_common_space
from . import bake, bevel
from .goals import Goals
from .group import CurveGroup
from .pins import FREE, Held
from .splines import stretch
from .surroundings import NOTHING, Surroundings


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

    @property
    def clean(self) -> bool:
        """Whether nothing needs the user's attention."""
        return self.certified and self.outcome.status is not Status.STALLED


@dataclass(frozen=True, eq=False)
class Prepared:
    """What is to be written; (keys,) each."""

    keys: Keys
    frames: FloatArray
    course: Course
    radii: FloatArray | None  # of the tube, in the common space of `Link`, if it is fitted


class Session:
    """A relaxation of curve objects as one link; ``objects`` and ``continues`` as for `CurveGroup`.

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
        self.group = CurveGroup(objects, continues)
        try:
            self.goals = Goals(goals, self.group.curve)
            pins, obstacles = tuple(sorted({*held.points, *self.group.pins})), surroundings.obstacles
            tangents = held.tangents and bool(pins)
            self.task = Task(curve=self.group.curve, obstacles=obstacles, pins=pins, pin_tangents=tangents)
            if self.task.pins or obstacles:
                key_options.check_place()
            if obstacles and options.balance:
                raise OptionError(Message("Balance does not go with what is avoided; leave it out, or avoid nothing"))
            self.options = options
            if continues:  # the keys that are there have as many points as the curves have now
                self.options = replace(options, vertices=len(self.group.curve), mesh="fixed", untangle="never")
        except BaseException:
            self.group.discard()
            raise
        first = self.group.stored if continues else None
        # what of the size stays constant, or changes evenly between goals
        stays = self.task.pins or obstacles or self.options.grow != 1.0
        # a taper may leave no radii at points, which make up for the size
        stays = stays or any(o.data.taper_object and o.data.taper_radius_mode == "OVERRIDE" for o in objects)
        measure = key_options.keep_size or (Measure.LENGTH if stays else Measure.RADIUS)
        self.motion = Recording(self.group.link, first, measure, self.group.size, not self._shape_keys)
        self._last: Iterate | None = None
        self._repinned = False  # whether a hand has left pins
        self.outcome: Outcome | None = None

    def run(self, drag: Callable[[Hand, Iterate], object] | None = None) -> Report:
        """Do the whole job; raises MobiusFlowError if the curves cannot be relaxed, or an object is gone.

        ``drag`` gets a hand, and the iterates in the world, between which it may tell the hand what to do.
        """
        try:
            hand = Hand()
            try:
                relaxation = WithOutcome(begun(self.task, self.options, self.goals.curves, hand))
                for iterate in relaxation:
                    self.take(iterate)
                    if drag is not None:
                        drag(hand, iterate)
            except CurveError as error:
                raise self.reworded(error) from error
            assert relaxation.outcome is not None, "the loop is through"
            self.end(relaxation.outcome)
            prepared = self.prepare(partial(is_free, obstacles=self._avoided))
            if reason := self.lost():
                raise MobiusFlowError(Message("{reason} during the relaxation; nothing was written", reason=reason))
            *_, report = self.bake(prepared)
        except BaseException:
            self.group.discard()
            raise
        assert report is not None, "it comes last"
        return report

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
    def _shape_keys(self) -> bool:
        """Whether shape keys are written; an animation that goes on may have them whatever is asked for."""
        return self._key_options.output is Output.SHAPE_KEYS or self.group.continues

    def take(self, iterate: Iterate) -> None:
        """Record an iterate."""
        before, self._last = self._last, iterate
        if before is not None and before.curve.mesh == iterate.curve.mesh:
            self._repinned |= before.pins != iterate.pins
        self.motion.add(iterate)
        self.goals.note(iterate)
        if self.goals.curves:
            self.motion.natural = sorted({0, *self.goals.iterates, iterate.index})

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
            seen = self.motion.size.of(curve.vertices)
            pins = link.to_common(curve.mesh, link.to_stored(curve.mesh, seen))[list(last.pins)]
            self.group.mark_pins([int(np.linalg.norm(shown - pin, axis=1).argmin()) for pin in pins])

    def prepare(self, proof: Proof) -> Prepared:
        """Choose and prove the keys; this touches nothing of Blender's and may be done in any thread."""
        motion = self.motion
        timing = self._key_options.timing.shortened(motion.way) if self.group.continues else self._key_options.timing
        animated, limit = self._key_options.animated, self._key_options.max_keys
        keys = motion.keys(proof, limit, timing) if animated else motion.result(proof)
        course = motion.course(keys)
        frames = timing.frames(course)
        radii = None
        if self.group.fits(self._key_options):
            shown = slice(None) if self._shape_keys else slice(-1, None)  # without shape keys the last one only
            factors = np.array([key.size.factor for key in keys.keys[shown]])
            fitting = factors * [self._radius(key.points) for key in keys.keys[shown]]
            radii = eased(fitting, frames[shown], keys.moves[shown])
            radii = (radii.min() if self._key_options.constant_radius else radii) / factors
        return Prepared(keys, frames, course, radii)

    def _radius(self, frame: Frame) -> float:
        """Radius of the tube, as thick as free of contact allows, in the common space."""
        mesh = self.motion.start.mesh
        return bevel.fitting_radius(Curve(self.group.link.to_common(mesh, frame), mesh), self._avoided)

    def reopen(self) -> None:
        """Go on after `CurveGroup.discard`; raises MobiusFlowError if the curves are not as they were at first."""
        changed = Message("{names} changed since the relaxation ended; relax anew", names=self.group.title)
        objects = self.group.objects
        if len(objects) < len(self.group.names) or self.surroundings.lost():
            raise MobiusFlowError(changed)
        group = CurveGroup(objects, self.group.continues)
        if not group.equals(self.group):
            group.discard()
            raise MobiusFlowError(changed)
        self.group = group

    def bake(self, prepared: Prepared) -> Iterator[Report | None]:
        """Write in short pieces, so that a window can be drawn in between, and report at last; no object may be gone.

        What is written becomes final with the last piece: until then `CurveGroup.discard` takes all of it back.
        """
        assert self.outcome is not None, "what is written has ended"
        keys, frames, radii = prepared.keys, prepared.frames, prepared.radii
        group, options = self.group, self._key_options
        group.make_polygons(self.motion.start)
        self._mark_pins()
        yield from group.writing(self.motion.start.mesh, keys, frames, options, radii)
        self.goals.paint(group.objects, keys, frames, options.timing)
        group.keep(keys, frames, options, prepared.course)
        self.goals.hide(group.objects)
        played = bake.scene_range(group.objects)
        shown = keys.keys[-1].size.factor * stretch(group.objects[0])
        yield Report(
            names=group.names,
            outcome=self.outcome,
            keys=len(keys.keys),
            kinds=replace(keys, keys=keys.keys[group.continues :]).kinds,
            continues=group.continues,
            replaced=group.replaced,
            last_frame=float(played[1] if played and options.timing.loop else frames[-1]),
            scene_range=played,
            certified=keys.certified,
            radius=None if radii is None else float(radii[-1]) * shown,
            modified=group.modified,
            avoided=self.surroundings.names,
        )
