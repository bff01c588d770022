"""Which frames of a relaxation to key, so that the straight lines between the keys are proved too.

The relaxation certifies its own path in doubles. Blender keeps keys as 32-bit floats and moves points straight
from one key to the next: another path, which needs its own proof, in the numbers that Blender stores. Keys are the
iterates themselves; others come in between where a straight motion is not proved, or would be seen to turn sharply.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..base import FloatArray, MobiusFlowError
from ..curve import Curve, interpolated
from ..io.trajectory import Iterate
from .key_options import Course, Timing
from .markers import KEPT, corners
from .placement import Measure, Origin, Similarity
from .recording import Key, Keys, Kind, Proof, Shapes


class Recording(Shapes):
    """The shapes of a relaxation, from which keys are chosen."""

    def keys(self, free: Proof, limit: int | None = None, timing: Timing | None = None) -> Keys:
        """Choose the keys of an animation from the start to the last iterate.

        ``free``: proves a straight motion free of contact, or that of a rope; ``limit``: wanted number of keys, at
        least 2, spread over the iterates as over the frames of an even motion; None keys every iterate. More are added
        where the straight motion from one to the next cannot be proved, and, if every iterate is keyed, where
        ``timing`` leaves room: on interpolating curves through the iterates, where that can be proved. By default they
        are no more than half of all, but for short runs. A curve that was a rope is one from key to key, unless that
        cannot be proved: then all motions are free of contact, and keys have no radius.
        """
        places = [each.place for each in self._passed]
        most = len(places) if timing is None else timing.most_keys
        if len(places) > most:
            limit = int(most) if limit is None else min(limit, int(most))
        every = limit is None or limit >= len(places)
        if limit is not None and not every:  # as evenly spread over an even motion as can be
            evenly = self._course.evenly[places]
            chosen = np.interp(np.linspace(0, 1, max(limit, 2)), evenly, np.arange(len(evenly))).round().astype(int)
            number = np.arange(len(chosen))
            later = np.maximum.accumulate(chosen - number) + number
            places = [places[k] for k in np.minimum(later, len(evenly) - len(chosen) + number)]
        ends = [self._key(place) for place in places]
        between = [list[Key]() for _ in ends[1:]]
        if timing is not None and every and len(ends) > 1:  # keys on smooth curves, no nearer than a frame
            steps = sum(key.kind is Kind.STEP for key in ends)
            # with 120 keys a motion looks smooth
            room = max((max(120, 2 * steps) if limit is None else limit) - len(ends), 0)
            frames = timing.frames(self.course(Keys(tuple(ends), 0)))
            gaps, spacing = np.diff(frames), 1.0
            while (pieces := np.ceil(gaps / spacing - 1e-3)).sum() - len(gaps) > room:
                spacing *= 1.05
            for k in np.flatnonzero(pieces > 1).tolist():
                near = slice(max(k - 1, 0), k + 3)  # the slopes at both ends need one more key on either side
                shapes = np.stack([key.points for key in ends[near]]).astype(np.float64)
                shares = np.arange(1, int(pieces[k])) / pieces[k]
                # curves that overshoot in no coordinate
                points = PchipInterpolator(frames[near], shapes)(frames[k] + shares * gaps[k]).astype(np.float32)
                times = (ends[k].time + shares * (ends[k + 1].time - ends[k].time)).tolist()
                pairs = zip(times, points, strict=True)
                between[k] = [self._stored(Key(t, shape, size=self._size(t, shape))) for t, shape in pairs]
        start, ends = self._link.to_stored(self._mesh, self.start.vertices), list(map(self._stored, ends))
        for radius in dict.fromkeys((self._radius, 0.0)):
            proved = partial(self._proved, free, radius)
            unproved = int(not proved(ends[0], ends[0], start))  # rounding may push one through another
            keys = ends[:1]
            for a, b, added, end in zip(places, places[1:], between, ends[1:], strict=False):
                smooth = [*added, end]
                if all(proved(one, other) for one, other in pairwise([keys[-1], *smooth])):
                    keys += smooth
                    continue
                for key, is_free in self._way(a, b, proved):
                    keys.append(key)
                    unproved += not is_free
            if not unproved:
                break
        return Keys(tuple(key if radius else replace(key, radius=0.0) for key in keys), unproved)

    def _way(self, a: int, b: int, proved: Callable[[Key, Key], bool]) -> Iterator[tuple[Key, bool]]:
        """Yield the keys after shape ``a`` up to ``b``, each with whether the motion to it was proved.

        Where one straight motion is not, others lead over shapes in between, and along a single leg in shorter pieces.
        """

        def along(start: Key, end: Key, depth: int) -> list[Key]:
            """Keys along one leg, the motions to all of them proved; none if that fails."""
            if proved(start, end):
                return [end]
            if not depth:
                return []
            points = (0.5 * (start.points.astype(np.float64) + end.points.astype(np.float64))).astype(np.float32)
            time = 0.5 * (start.time + end.time)
            size, radius = (
                Similarity() if self._in_points else self._size(time, points),
                0.5 * (start.radius + end.radius),
            )
            middle = Key(time, points, size=size, radius=radius)
            first = along(start, middle, depth - 1)
            second = first and along(middle, end, depth - 1)
            return first + second if second else []

        start, end = self._stored(self._key(a)), self._stored(self._key(b))
        found = along(start, end, 5 if b - a == 1 else 0)  # pieces still apart in time for Blender
        if found or b - a == 1:
            yield from ((key, bool(found)) for key in found or [end])
            return
        # an iterate makes a better key than the inner end of a leg
        inside = [each.place for each in self._passed if a < each.place < b] or range(a + 1, b)
        middle = inside[len(inside) // 2]
        yield from self._way(a, middle, proved)
        yield from self._way(middle, b, proved)

    def result(self, free: Proof) -> Keys:
        """Return the last iterate alone; it counts as proved if the way there and its rounding were."""
        key, last = self._key(-1), self.last
        assert last is not None, "a relaxation yields at least its start"
        exact = self._link.to_stored(self._mesh, self._marked(last.curve.vertices, -1))
        exact, stored = self._shown(exact, key.size) if self._in_points else exact, self._stored(key)
        rounded = stored, stored, exact
        radius = self._radius if self._proved(free, self._radius, *rounded) else 0.0
        proved = last.certified and (radius > 0.0 or self._proved(free, 0.0, *rounded))
        return Keys((stored if radius else replace(stored, radius=0.0),), int(not proved))

    def course(self, keys: Keys) -> Course:
        """How far the relaxation has come at each of some keys.

        The distance is measured along everything recorded: thinning changes no key's frame.
        """
        return self._course.at(np.array([key.time for key in keys.keys]))

    def at(self, frame: float, timing: Timing) -> Key:
        """The shape that an animation of what was recorded so far has at a scene frame; nothing is proved of it."""
        place = np.interp(frame, timing.moments(self._course), np.arange(len(self._shapes)))
        ends, part = (int(place), min(int(place) + 1, len(self._shapes) - 1)), np.array([place % 1.0])
        around = [self._in_view(self._key(k)) for k in ends]
        (points,) = interpolated(np.stack([key.points for key in around]), part)
        ((time, radius),) = interpolated(np.array([(key.time, key.radius) for key in around]), part).tolist()
        return Key(time, points.astype(np.float32), radius=radius)

    def _proved(self, free: Proof, radius: float, start: Key, end: Key, exact: FloatArray | None = None) -> bool:
        """Whether the straight motion between keys as stored is free of contact, and that of a rope, if it is one.

        ``exact``: the points of the first one, unless they are as stored.
        """
        points = start.points if exact is None else exact, end.points
        a, b = (self._link.to_common(self._mesh, each) for each in points)
        if not free(self._mesh, a, b):
            return False
        if not radius:
            return True
        if self._in_points:  # between two sizes it is that of one size, at another pace
            b = b * (start.radius / end.radius)
            radius = start.radius / KEPT
        mesh, a, b = corners(self._mesh, a, b, radius)
        return free(mesh, a, b, np.full(len(mesh.closed), 0.5 * (1.0 + KEPT) * radius))


def check_dimension(curve: Curve) -> None:
    """Raise a MobiusFlowError if a curve is not in the plane or in space."""
    if curve.dimension > 3:
        raise MobiusFlowError(f"the curve has {curve.dimension} coordinates; Blender shows curves in 2 or 3 dimensions")


def recorded(iterates: Sequence[Iterate], measure: Measure = Measure.LENGTH) -> tuple[Recording, Origin]:
    """Collect the iterates of a run in the numbers that Blender will store; raises MobiusFlowError if it cannot.

    ``measure``: what stays constant, see `Recording`.
    """
    start = iterates[0].curve
    check_dimension(start)
    origin = Origin.of(start)
    motion = Recording(origin.link(start.mesh), measure=measure, in_points=True)
    for iterate in iterates:
        motion.add(iterate)
    return motion, origin
