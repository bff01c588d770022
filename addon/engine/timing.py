"""When the keys of an animation are shown: their frames, for any way in which time may pass.

Chords between keys are proved whatever their times: a key's frame says when it is passed, not where the curve goes.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...core import OptionError
from ...core.messages import Message
from ...core.types import FloatArray

LAST_FRAME = 1_048_574  # of any scene; up to it, 32-bit numbers tell a sixteenth of a frame apart
FRAMES_PER_ITERATE = (0.1, 10_000.0)
_BY_ITERATE = Message("Start Frame, Frames/Iterate or Max Iterations")  # what the last frame depends on
_BY_LENGTH = Message("Start Frame or Length")
_EVENNESS = 0.85  # share of distance in an even motion; the rest leaves the last, small steps some frames too


class Pace(Enum):
    """What passes evenly from frame to frame; the values name it for people."""

    EVEN = "Even Motion"
    DISTANCE = "By Distance"
    FLOW_TIME = "By Flow Time"
    ITERATE = "By Iterate"


@dataclass(frozen=True, eq=False)
class Course:
    """How far a relaxation has come at each of several frames; ascending arrays of shape (frames,).

    Attributes
    ----------
    iterates
        Number of iterates passed.
    distance
        Length of the way travelled, in the root mean square over the vertices.
    flow_time
        Sum of the step sizes.
    """

    iterates: FloatArray
    distance: FloatArray
    flow_time: FloatArray

    def share(self, pace: Pace) -> FloatArray:
        """Share of the time passed at each frame, from 0 to 1."""
        return _SHARES[pace](self)


def _share(passed: FloatArray, otherwise: FloatArray) -> FloatArray:
    """From 0 to 1 as something passes, or as something else does if that stands still."""
    for each in (passed, otherwise):
        if np.ptp(each) > 0:
            return np.asarray((each - each[0]) / np.ptp(each))
    return np.zeros(len(passed))


def _of_iterates(course: Course) -> FloatArray:
    return _share(course.iterates, course.iterates)


def _of_distance(course: Course) -> FloatArray:
    return _share(course.distance, course.iterates)


def _of_flow_time(course: Course) -> FloatArray:
    return _share(course.flow_time, course.iterates)


def _of_both(course: Course) -> FloatArray:
    return _EVENNESS * _of_distance(course) + (1 - _EVENNESS) * _of_iterates(course)


_SHARES: dict[Pace, Callable[[Course], FloatArray]] = {
    Pace.EVEN: _of_both,
    Pace.DISTANCE: _of_distance,
    Pace.FLOW_TIME: _of_flow_time,
    Pace.ITERATE: _of_iterates,
}


@dataclass(frozen=True, kw_only=True)
class Timing:
    """Which frames an animation takes.

    Parameters
    ----------
    pace
        What passes evenly from frame to frame.
    start_frame
        Frame at which the animation begins.
    length
        Number of frames, those at rest among them; with `Pace.ITERATE` it follows from the number of iterates.
    frames_per_iterate
        Frames from one iterate to the next, for `Pace.ITERATE`.
    hold_start, hold_end
        Frames at rest before and after the motion.

    Raises
    ------
    OptionError
        If a value is outside its range.
    """

    pace: Pace = Pace.EVEN
    start_frame: float = 1.0
    length: int = 250
    frames_per_iterate: float = 1.0
    hold_start: int = 0
    hold_end: int = 0

    def __post_init__(self) -> None:
        if not abs(self.start_frame) <= LAST_FRAME:  # not a number is refused too
            raise OptionError(
                Message(
                    "Start Frame is {frame:.12g}; it must be from {first} to {last}",
                    frame=self.start_frame,
                    first=-LAST_FRAME,
                    last=LAST_FRAME,
                )
            )
        low, high = FRAMES_PER_ITERATE
        if not low <= self.frames_per_iterate <= high:
            raise OptionError(
                Message(
                    "Frames/Iterate is {value:g}; it must be from {low:g} to {high:g}",
                    value=self.frames_per_iterate,
                    low=low,
                    high=high,
                )
            )
        if min(self.hold_start, self.hold_end) < 0:
            raise OptionError(Message("Hold at Start and Hold at End must be 0 frames or more"))
        if self.pace is not Pace.ITERATE and self.length < 2 + self.hold_start + self.hold_end:
            raise OptionError(
                Message(
                    "Length is {length} frames, which leaves none to move in; "
                    "it must be at least {least}, or the holds shorter",
                    length=self.length,
                    least=2 + self.hold_start + self.hold_end,
                )
            )

    def check_room(self, iterations: int) -> None:
        """Raise an OptionError if so many iterations would take frames beyond the last one that a scene may have."""
        _, end = self._motion(iterations)
        last = end + self.hold_end
        if last > LAST_FRAME:
            raise OptionError(
                Message(
                    "The animation would go on to frame {frame:.0f}, but Blender's last is {last}; "
                    "give a smaller {what}",
                    frame=last,
                    last=LAST_FRAME,
                    what=_BY_ITERATE if self.pace is Pace.ITERATE else _BY_LENGTH,
                )
            )

    def frames(self, course: Course) -> FloatArray:
        """Frame of each key as Blender stores it, a 32-bit number, each later than the one before; (keys,)."""
        begin, end = self._motion(course.iterates[-1])
        return _apart(begin + (end - begin) * course.share(self.pace))

    def scene_range(self, frames: FloatArray) -> tuple[int, int]:
        """First and last frame of an animation with its rests, as whole frames."""
        return int(np.floor(frames[0] - self.hold_start)), int(np.ceil(frames[-1] + self.hold_end))

    def _motion(self, iterations: float) -> tuple[float, float]:
        """Where the motion begins and ends."""
        begin = self.start_frame + self.hold_start
        if self.pace is Pace.ITERATE:
            return begin, begin + self.frames_per_iterate * iterations
        return begin, self.start_frame + self.length - 1 - self.hold_end


def _apart(frames: FloatArray) -> FloatArray:
    """Ascending frames as different 32-bit numbers; where they crowd at the end, the last one stays where it is."""
    stored = frames.astype(np.float32)
    last = stored[-1]
    for k in range(1, len(stored)):
        stored[k] = max(stored[k], np.nextafter(stored[k - 1], np.float32(np.inf)))
    stored[-1] = last if len(stored) > 1 and stored[0] < last else stored[-1]
    for k in range(len(stored) - 1, 0, -1):
        stored[k - 1] = min(stored[k - 1], np.nextafter(stored[k], np.float32(-np.inf)))
    return stored.astype(np.float64)
