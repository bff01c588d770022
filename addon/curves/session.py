"""One relaxation of curve objects as one link: consumes iterates, shows them, then writes the animation.

A plain class: a blocking operator runs it, a modal one hands it the iterates of a worker (`live.run`).
What it knows lives here and never in the file.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property

import bpy
import numpy as np
from scipy.spatial import cKDTree

from ...core import Curve, Hand, Iterate, Mesh, Obstacle, Outcome, RelaxOptions, Task, WithOutcome
from ...core.base import CurveError, FloatArray, Message, MobiusFlowError, OptionError
from ...core.collision import is_rope
from ...core.driver.prepare import rope_radius
from ...core.driver.words import in_blenders_words
from ...core.keys.figure import contact_forces
from ...core.keys.key_options import Course, KeyOptions
from ...core.keys.motion import Recording
from ...core.keys.placement import Measure
from ...core.keys.recording import Key, Keys, Proof
from ...core.keys.tube import eased, rope_radii
from ...core.ropes import SeparateOptions, Tightened, TightenOptions
from ..engine.worker import begun
from . import bake, bevel, doors, pins
from .goals import Goals
from .group import Group
from .report import Report
from .sizes import placement
from .splines import coordinates
from .surroundings import Surroundings

# what is to be written: the keys, and for each of them its scene frame, how far the relaxation has come there, and the
# radius of the tube, in the common space of `Link`, if it is fitted
Prepared = tuple[Keys, FloatArray, Course, FloatArray | None]


class Session(Group):
    """A relaxation of curve objects as one link, in the world; a single object is one, too.

    `requirements` accept the objects, and their transforms are evaluated. They show stand-ins until all is written, or
    until `discard`. Where the run ``continues``, baked curves are relaxed on from the ends of their animations, and
    keys are added to theirs. ``pinned``: points that are pinned besides the marked ones, counted from 0 through all
    splines of all objects; ``pin_tangents``: whether the neighbours of pinned points in the refined curve are, too.
    ``goals``: curve objects that the link is to become, one after the other; by default it is relaxed alone.
    ``ropes``: how it is separated, or pulled tight, instead.

    ``curve``: all splines as polygons in world space; ``link``: where their vertices are stored; ``outcome``: how the
    relaxation ended, once it has.  Raises MobiusFlowError if the curves cannot be relaxed, or there is no room for
    their keys.
    """

    def __init__(
        self,
        objects: Sequence[bpy.types.Object],
        options: RelaxOptions,
        key_options: KeyOptions,
        continues: bool,
        surroundings: Surroundings,
        pinned: Sequence[int],
        pin_tangents: bool,
        goals: Sequence[bpy.types.Object],
        ropes: SeparateOptions | TightenOptions | None,
    ) -> None:
        key_options.check_room(options.max_iterations)
        self.surroundings, self._key_options, self._continues = surroundings, key_options, continues
        self.outcome: Outcome | None = None
        self._too_thick = False  # whether a bevel of the artist's meets itself at the start
        self._repinned = False  # whether a hand has left pins
        with self.all_or_nothing():
            self.begin(objects, self._key_options, self._continues)
            self.goals = Goals(goals, self.curve)
            held = tuple(sorted({*pinned, *pins.pinned_vertices(objects, self.curve.mesh)}))
            obstacles, tangents = surroundings.obstacles, pin_tangents and bool(held)
            self.task = Task(curve=self.curve, obstacles=obstacles, pins=held, pin_tangents=tangents)
            if held or obstacles:
                key_options.check_place()
            if obstacles and options.balance:
                raise OptionError(Message("Balance does not go with what is avoided; leave it out, or avoid nothing"))
            # a bevel of the artist's is the rope, unless it meets itself from the start, or is to be fitted
            own = () if continues or goals or ropes or key_options.any_bevel else bevel.own_radii(objects)
            if own and options.resolved.radius == "keep":
                with suppress(CurveError):
                    wanted = replace(options, radius=own)
                    rope_radius(self.task.refined(options.vertices), wanted)
                    options = wanted
                self._too_thick = options.radius == "keep"
            self.options, self.job, first, size = options, ropes or options, None, None
            if continues:  # the keys that are there have as many points as the curves have now
                self.options = self.job = replace(options, vertices=len(self.curve), mesh="fixed", untangle="never")
                first = np.concatenate([coordinates(spline) for obj in objects for spline in obj.data.splines])
                size = self.members[0].size
        # what of the size stays constant, or changes evenly between goals
        stays = held or obstacles or self.options.grow != 1.0
        animated = key_options.animated
        stays = stays or not (isinstance(self.options.radius, str) or animated)  # points alone are scaled
        # a taper may leave no radii at points, which make up for the size
        stays = stays or any(o.data.taper_object and o.data.taper_radius_mode == "OVERRIDE" for o in objects)
        measure = key_options.keep_size or (Measure.LENGTH if stays else Measure.RADIUS)
        self.motion = Recording(self.link, first, measure, size, not animated)

    def reopen(self) -> None:
        """Go on after `discard`; raises MobiusFlowError if the curves are not as they were at first."""
        changed = Message("{names} changed since the relaxation ended; relax anew", names=self.title)
        curve, link = self.curve, self.link
        objects = [obj for member in self.members if (obj := member.found()) is not None]
        if len(objects) < len(self.members) or self.surroundings.lost():
            raise MobiusFlowError(changed)
        try:
            with self.all_or_nothing():
                self.begin(objects, self._key_options, self._continues)
                placed = zip(link.placements, self.link.placements, strict=False)
                same = link.counts == self.link.counts and all(a.equals(b) for a, b in placed)
                if not (same and self.curve.mesh == curve.mesh and np.array_equal(self.curve.vertices, curve.vertices)):
                    raise MobiusFlowError(changed)
        finally:
            self.curve, self.link = curve, link

    def run(self, drag: Callable[[Hand, Iterate], object] | None = None) -> Report:
        """Do the whole job; raises MobiusFlowError if the curves cannot be relaxed, or an object is gone.

        ``drag`` gets a hand, and the iterates in the world, between which it may tell the hand what to do.
        """
        with self.all_or_nothing():
            hand = Hand()
            try:
                relaxation = WithOutcome(begun(self.task, self.job, self.goals.curves, hand))
                for iterate in relaxation:
                    self.take(iterate)
                    if drag is not None:
                        drag(hand, iterate)
            except CurveError as error:
                raise self.reworded(error) from error
            assert relaxation.outcome is not None, "the loop is through"
            self.end(relaxation.outcome)
            prepared = self.prepare(self.proved)
            if reason := self.lost():
                raise MobiusFlowError(Message("{reason} during the relaxation; nothing was written", reason=reason))
            return self.bake(prepared)

    def lost(self) -> Message | None:
        """Say what was done to one of the objects, or to what they avoid, that makes it impossible to go on.

        What is proved of a single object that avoids nothing holds wherever it goes.
        """
        reason = next((reason for member in self.members if (reason := member.lost())), None)
        for member in self.members if len(self.members) > 1 or self.task.obstacles else ():
            if reason is None and not placement(member.object).equals(member.placement):
                reason = Message("'{name}' was moved against the others", name=member.name)
        return reason or self.surroundings.lost()

    # -- its motion --------------------------------------------------------------------------------------------------

    def take(self, iterate: Iterate) -> None:
        """Record an iterate."""
        before = self.motion.last
        if before is not None and before.curve.mesh == iterate.curve.mesh:
            self._repinned |= before.pins != iterate.pins
        self.motion.add(iterate)
        self.goals.note(iterate)
        if self.goals.curves:
            self.motion.natural = sorted({0, *self.goals.iterates, iterate.index})

    def end(self, outcome: Outcome) -> None:
        if self._too_thick:
            outcome = outcome.adding("the bevel is too thick to be kept apart from itself")
        words = [in_blenders_words(each, self._spline_names) for each in outcome.clauses]
        self.outcome = replace(outcome, clauses=tuple(words))

    def at(self, frame: float) -> Key:
        """The shape that a scene frame would have if this were the end."""
        return self.motion.at(frame, self._key_options.timing)

    def show(self, there: Key | None = None) -> None:
        """Show a shape, by default the last iterate with the pins that a hand left, its tube as thick as at a key."""
        key = self.motion.shown if there is None else there
        self.move(self.motion.start, key.points, self._radii(Keys((key,), 0))[0] if self._fits else None)
        if there is None:
            self._repin()

    def _repin(self) -> None:
        """Let the points where the last iterate, which may have fewer vertices, has pins be the pinned ones."""
        if not self._repinned or (last := self.motion.last) is None:
            return
        shown = self.link.to_common(self.motion.start.mesh, self.motion.shown.points)
        seen = self.link.to_stored(last.curve.mesh, self.motion.size.of(last.curve.vertices))
        places = self.link.to_common(last.curve.mesh, seen)[list(last.pins)]
        pins.pin_only(self.objects, [int(np.linalg.norm(shown - place, axis=1).argmin()) for place in places])

    # -- its keys ----------------------------------------------------------------------------------------------------

    @property
    def _fits(self) -> bool:
        """Whether any of the objects is drawn as a tube that is to be fitted."""
        return any(member.fits(self._key_options) for member in self.members)

    def _radii(self, keys: Keys) -> FloatArray:
        """Radii of the tube as shown at keys, in the common space: of the rope, or as thick as fits; (keys,)."""
        mesh = self.motion.start.mesh
        if (rope := rope_radii(mesh, keys)) is not None:
            return rope[:, 0]
        curves = (Curve(self.link.to_common(mesh, key.points), mesh) for key in keys.keys)
        fitting = [bevel.fitting_radius(each, self._avoided) for each in curves]
        return np.array([key.size.factor for key in keys.keys]) * fitting

    @cached_property
    def _avoided(self) -> tuple[Obstacle, ...]:
        """What is avoided, in the common space."""
        return tuple(Obstacle(self.link.from_world(o.vertices), o.faces, o.name) for o in self.task.obstacles)

    def proved(self, mesh: Mesh, start: FloatArray, end: FloatArray, radius: FloatArray | None = None) -> bool:
        """Whether a motion in the common space is free of contact, or of a rope; as `core.collision.is_rope`."""
        return is_rope(mesh, start, end, radius, self._avoided)

    def prepare(self, proof: Proof) -> Prepared:
        """Choose and prove the keys; this touches nothing of Blender's and may be done in any thread."""
        motion, options = self.motion, self._key_options
        timing = options.timing.shortened(motion.way) if self._continues else options.timing
        keys = motion.keys(proof, options.max_keys, timing) if options.animated else motion.result(proof)
        course = motion.course(keys)
        frames = timing.frames(course)
        radii = None
        if self._fits:
            radii = eased(self._radii(keys), frames, keys.moves)
            radii = radii.min() if options.constant_radius else radii
            radii = radii / [key.size.factor for key in keys.keys]
        return keys, frames, course, radii

    def _press(self, outcome: Tightened) -> None:
        """Note where ropes press on each other in the end; a strut belongs to the object that its first edge is on."""
        last, mesh = self.motion.last, self.motion.start.mesh
        assert last is not None, "it has ended"
        curve, points = last.curve, self.motion.size.undone(self.link.to_world(mesh, self.motion.shown.points))
        forces = contact_forces(curve, outcome.struts, min(last.radius or (0.0,)))[
            cKDTree(curve.vertices).query(points)[1]
        ]
        struts, middles = np.array(outcome.struts).reshape(-1, 3), curve.vertices[curve.mesh.tails]
        edges, middles = struts[:, :2].astype(np.intp), middles + 0.5 * curve.edge_vectors
        owner = np.searchsorted(np.cumsum(self.link.counts), curve.mesh.edge_component[edges[:, 0]], side="right")
        for k, (obj, place, vertices) in enumerate(
            zip(self.objects, self.link.placements, self.link.slices(mesh), strict=True)
        ):
            own = owner == k
            ends = [place.to_local(middles[each]) for each in edges[own].T]
            bake.press(obj.data, forces[vertices], np.column_stack([*ends, struts[own, 2]]))

    def bake(self, prepared: Prepared) -> Report:
        """Write what was prepared, which takes half a second for 2,000 keys of 2,000 points.

        No object may be gone. Where something fails, `discard` takes back what was written.
        """
        assert self.outcome is not None, "what is written has ended"
        keys, frames, course, radii = prepared
        options, mesh, objects = self._key_options, self.motion.start.mesh, self.objects
        self.make_polygons(self.motion.start)
        self._repin()
        for member, vertices, scale in zip(self.members, self.link.slices(mesh), self.link.scales, strict=True):
            own = None if radii is None else radii / scale
            member.write(keys.part(vertices), frames, options, own)
        self.goals.paint(objects, keys, frames, options.timing)
        rope = rope_radii(mesh, keys)
        seen = 0.0 if rope is None else float(rope[-1, 0]) / keys.keys[-1].size.factor
        for member, scale in zip(self.members, self.link.scales, strict=True):
            member.keep(keys, frames, options, course, seen / scale)
        if isinstance(self.outcome, Tightened):
            self._press(self.outcome)
        self.goals.hide(objects)
        played = bake.scene_range(objects)
        shown = keys.keys[-1].size.factor * placement(objects[0]).stretch
        after = [each for obj in objects for each in obj.modifiers]
        after += [each for obj in objects if (copy := doors.copy_of(obj)) for each in copy.modifiers[1:]]
        return Report(
            names=self.names,
            outcome=self.outcome,
            keys=len(keys.keys),
            kinds=replace(keys, keys=keys.keys[self._continues :]).kinds,
            continues=self._continues,
            replaced=max(member.replaced for member in self.members),
            last_frame=float(played[1] if played and options.timing.loop else frames[-1]),
            scene_range=played,
            certified=keys.certified,
            radius=None if radii is None else float(radii[-1]) * shown,
            modified=any(each.show_viewport or each.show_render for each in after),
            avoided=self.surroundings.names,
        )
