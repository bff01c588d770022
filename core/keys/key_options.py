"""How a relaxation becomes an animation: what is keyed, in which size, and at which frames.

Chords between keys are proved whatever their times: a key's frame says when it is passed, not where the curve goes.
"""

from dataclasses import dataclass, field, replace
from enum import Enum
from typing import ClassVar, NamedTuple

import numpy as np

from ..base import FloatArray, Message, OptionError
from .placement import Measure

LAST_FRAME = 1_048_574  # of any scene; up to here, 32-bit numbers resolve a sixteenth of a frame
FRAMES_PER_ITERATE = (0.1, 10_000.0)
_SLOWEST = 1000  # frames for a distance as long as the curve is wide: slower motion looks like rest
_APART = 1 / 64  # frames from one key to the next, at least: Blender takes keys nearer than 1/100 for one


class Pace(Enum):
    """What advances evenly from frame to frame; the values are its names for people."""

    EVEN = "Even Motion"
    DISTANCE = "By Distance"
    FLOW_TIME = "By Flow Time"
    ITERATE = "By Iterate"


class Course(NamedTuple):
    """How far a relaxation has come at each of several frames; ascending arrays of shape (frames,)."""

    iterates: FloatArray  # number of iterates passed
    distance: FloatArray  # distance travelled by the fastest vertex, in sizes of the curve
    flow_time: FloatArray  # sum of the step sizes
    fall: FloatArray  # of the logarithm of the energy above where it ends and a bit, see `Recording`
    moved: FloatArray  # the part of the distance that was travelled in strand moves

    def at(self, iterates: FloatArray) -> "Course":
        """The same at other frames, by the number of iterates passed."""
        return Course(*(np.interp(iterates, self.iterates, column) for column in self))

    def then(self, other: "Course") -> "Course":
        """This course and another one, whose first frame is the last of this one."""
        pairs = zip(self, other, strict=True)
        return Course(*(np.append(one, one[-1] + more[1:] - more[0]) for one, more in pairs))

    def share(self, pace: Pace) -> FloatArray:
        """Share of the time passed at each frame, from 0 to 1."""
        if pace is Pace.EVEN:
            # set off and come to rest gently, each in so much of the time, from and to a tenth of the speed
            time, ramp = np.linspace(0.0, 1.0, 1001), 0.12
            passed = _passed(time, np.clip(np.minimum(time, 1.0 - time) / ramp, 0.1, 1.0))
            return np.asarray(np.interp(self.evenly, passed / passed[-1], time))
        if pace is Pace.FLOW_TIME:
            # strand moves are no flow, but are seen for as long as they would be by distance
            part = self.moved[-1] / max(self.distance[-1], 1e-300)
            return np.asarray((1.0 - part) * self._share(self.flow_time) + part * self._share(self.moved))
        return self._share(self.distance if pace is Pace.DISTANCE else self.iterates)

    @property
    def evenly(self) -> FloatArray:
        """Share of an even motion passed at each frame, were it not to set off and come to rest gently."""
        # a way has less weight where the energy hardly falls any more: drift
        above = np.expm1(np.minimum(self.fall[-1] - self.fall, 50.0))  # bits of energy above the end
        near, drift = 0.03, 0.1  # which bits are few, and what a way is worth along which there are none
        worth = (above + drift * near) / (above + near)
        # the fall counts so that drift takes few frames, the iterates so that the last, small steps get some
        parts = _passed(self.distance, worth), self.fall, _passed(self.iterates, worth)
        share = np.average([self._share(part) for part in parts], axis=0, weights=[0.6, 0.35, 0.05])
        # then nothing is more than twice as fast as half of the film, or much slower than a fifth of that
        time, way = np.diff(share), np.diff(self._share(self.distance))
        for _ in range(4 if len(time) else 0):
            speed = way / np.maximum(time, 1e-12)
            order = np.argsort(speed)
            median = float(np.interp(0.5 * time.sum(), np.cumsum(time[order]), speed[order]))
            if median > 0.0:
                time = np.clip(time, way / (2.0 * median), way / (0.2 * median) + 0.2 / len(time))
        return self._share(np.concatenate([[0.0], np.cumsum(time)]))

    def _share(self, passed: FloatArray) -> FloatArray:
        """A running total scaled to go from 0 to 1, or the number of iterates if the total does not change."""
        for each in (passed, self.iterates):
            if np.ptp(each) > 0:
                return np.asarray((each - each[0]) / np.ptp(each))
        return np.zeros(len(passed))


def _passed(along: FloatArray, speed: FloatArray) -> FloatArray:
    """The integral of a speed from the first to each place."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(along))])


@dataclass(frozen=True, kw_only=True)
class Timing:
    """Which frames an animation takes.

    Raises OptionError if a value is outside its range.
    """

    pace: Pace = Pace.EVEN  # what advances evenly from frame to frame
    start_frame: float = 1.0  # frame at which the animation begins
    # number of frames, including those at rest; with `Pace.ITERATE` it follows from the number of iterates
    length: int = 250
    frames_per_iterate: float = 1.0  # frames from one iterate to the next, for `Pace.ITERATE`
    hold_start: int = 0  # frames at rest before and after the motion
    hold_end: int = 0
    loop: bool = False  # whether it goes back to where it began, in as many frames: `length` is that of both ways

    def __post_init__(self) -> None:
        if not abs(self.start_frame) <= LAST_FRAME:  # not a number is refused too
            sentence = "Start Frame is {frame:.12g}; it must be from {first} to {last}"
            raise OptionError(Message(sentence, frame=self.start_frame, first=-LAST_FRAME, last=LAST_FRAME))
        low, high = FRAMES_PER_ITERATE
        if not low <= self.frames_per_iterate <= high:
            sentence = "Frames/Iterate is {value:g}; it must be from {low:g} to {high:g}"
            raise OptionError(Message(sentence, value=self.frames_per_iterate, low=low, high=high))
        if min(self.hold_start, self.hold_end) < 0:
            raise OptionError(Message("Hold at Start and Hold at End must be 0 frames or more"))
        least = (1 + self.loop) * (1 + self.hold_start + self.hold_end) + (not self.loop)
        if self.pace is not Pace.ITERATE and self.length < least:
            sentence = (
                "Length is {length} frames, which leaves none to move in; it must be at least {least}, or the holds "
                "shorter"
            )
            raise OptionError(Message(sentence, length=self.length, least=least))

    def check_keys(self, count: int) -> None:
        """Raise an OptionError if there are no times apart for so many keys."""
        begin, end = self._motion(0)
        if self.pace is not Pace.ITERATE and (end - begin) < _APART * (count - 1):
            sentence = "{length} frames are too few for {count} keys; give a larger Length"
            raise OptionError(Message(sentence, length=self.length, count=count))

    def check_room(self, iterations: int) -> None:
        """Raise an OptionError if so many iterations would take frames beyond the last one that a scene may have."""
        _, last = self.scene_range(np.array(self._motion(iterations)))
        if last > LAST_FRAME:
            sentence = (
                "The animation would go on to frame {frame:.0f}, but Blender's last is {last}; give a smaller {what}"
            )
            by_iterate = Message("Start Frame, Frames/Iterate or Max Iterations")
            what = by_iterate if self.pace is Pace.ITERATE else Message("Start Frame or Length")
            raise OptionError(Message(sentence, frame=last, last=LAST_FRAME, what=what))

    def shortened(self, way: float) -> "Timing":
        """The same for a way of so many sizes of the curve, which may not be worth the whole length."""
        least = 2 + self.hold_start + self.hold_end + int(np.ceil(_SLOWEST * way))
        return self if self.pace is Pace.ITERATE else replace(self, length=min(self.length, least))

    def frames(self, course: Course) -> FloatArray:
        """Frame of each key as Blender stores it, a 32-bit number, each later than the one before; (keys,)."""
        moments = self.moments(course)
        number = np.arange(len(moments))
        bit = float(np.spacing(np.float32(np.abs(moments).max())))
        stored = np.round(moments / bit)  # whole numbers of bits
        least = max(1, int(min(_APART / bit, (stored[-1] - stored[0]) / max(len(moments) - 1, 1))))
        later = np.maximum.accumulate(stored - least * number) + least * number
        # where they crowd at the end, the last one stays if there is room
        last = max(stored[-1], stored[0] + least * number[-1])
        return np.asarray(bit * np.minimum(later, last - least * number[::-1]))

    @property
    def most_keys(self) -> float:
        """The number of keys for which there are times apart from each other, and for as many more in between."""
        begin, end = self._motion(0)
        return np.inf if self.pace is Pace.ITERATE else 2 + (end - begin) // (2 * _APART)

    def moments(self, course: Course) -> FloatArray:
        """The same as real numbers, which ascend, some of them perhaps equal; (keys,)."""
        begin, end = self._motion(course.iterates[-1])
        return np.asarray(begin + (end - begin) * course.share(self.pace))

    def scene_range(self, frames: FloatArray) -> tuple[int, int]:
        """First and last frame of an animation with its rests, as whole frames."""
        way = frames[-1] + self.hold_end - (first := frames[0] - self.hold_start)
        return int(np.floor(first)), int(np.ceil(first + (2 * way - 1 if self.loop else way)))

    def way_back(self, frames: FloatArray) -> FloatArray:
        """Frames at which keys are passed again, from the last one on; the last is left out if nothing rests there."""
        back = 2 * (frames[-1] + self.hold_end) - frames[::-1]
        return back[back > frames[-1]] if self.loop else frames[:0]

    def _motion(self, iterations: float) -> tuple[float, float]:
        begin = self.start_frame + self.hold_start
        if self.pace is Pace.ITERATE:
            return begin, begin + self.frames_per_iterate * iterations
        return begin, self.start_frame + (self.length / 2 if self.loop else self.length - 1) - self.hold_end


class Output(Enum):
    """What is left on the object in the end; the values are labels."""

    SHAPE_KEYS = "Shape Keys"
    RESULT = "Result Only"


@dataclass(frozen=True, kw_only=True)
class KeyOptions:
    """How a relaxation becomes an animation."""

    output: Output = Output.SHAPE_KEYS  # what is left on the object
    timing: Timing = field(default_factory=Timing)  # which frames it takes
    max_keys: int | None = None  # wanted number of keys, see `Recording.keys`
    # draw curves whose tubes were fitted before as the thickest tubes that do not touch, at every key
    fit_bevel: bool = False
    # do so with every curve that is drawn as a line or a plain round tube, also where its depth is the artist's own
    any_bevel: bool = False
    constant_radius: bool = False  # draw such tubes as thick at all keys as at the one where they are thinnest
    # what is kept as at the first key; where it is not the length, which the flow keeps, keys are scaled; None: the
    # radius, or the length where something is pinned or avoided, or grows
    keep_size: Measure | None = None

    @property
    def animated(self) -> bool:
        """Whether keys are written, and not the result alone."""
        return self.output is not Output.RESULT

    def check_room(self, iterations: int) -> None:
        """Raise an OptionError if so many iterations would be keyed to beyond the last frame of a scene."""
        if self.animated:
            self.timing.check_room(iterations)

    def check_place(self) -> None:
        """Raise an OptionError if keys are scaled: that moves pins, and proofs beside others hold at one size only."""
        if self.keep_size not in (None, Measure.LENGTH):
            sentence = (
                "Only the length can be kept where something is pinned or avoided; give keep_size='LENGTH', or none"
            )
            raise OptionError(Message(sentence))


@dataclass(frozen=True)
class Playing:
    """How a relaxation is played in a scene or a film."""

    MOVING: ClassVar = (72, 720)  # frames in motion, at least and at most
    RESTS: ClassVar = (6, 12)  # frames at rest before the motion and after it

    look: str | None = None  # one of `pictures.looks`; None: the default one, and films drawn plainly
    loop: bool = False  # there and back
    constant_radius: bool = False  # the tube is as thick at all keys as at the one where it is thinnest
    timing: Timing = field(default_factory=Timing)  # that of the keys

    def timed(self, way: float) -> "Playing":
        """Let a curve go a way, in its sizes, evenly, no faster than can be followed, and rest before and after."""
        (low, high), (before, after) = self.MOVING, self.RESTS
        moving = round(min(max(20 * way, low), high))  # as far as the curve is wide in 20 frames
        length = (before + moving + after) * (1 + self.loop) + (not self.loop)
        return replace(self, timing=Timing(length=length, hold_start=before, hold_end=after, loop=self.loop))
