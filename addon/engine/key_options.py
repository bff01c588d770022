"""How a relaxation becomes an animation."""

from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...core import OptionError
from ...core.types import FloatArray
from .motion import Keys

LAST_FRAME = 1_048_574  # of any scene; up to it, 32-bit numbers tell a sixteenth of a frame apart
FRAMES_PER_ITERATE = (0.1, 10_000.0)


class Output(Enum):
    """What is left on the object in the end; the values are labels."""

    SHAPE_KEYS = "Shape Keys"
    FCURVES = "F-Curves"
    RESULT = "Result Only"


@dataclass(frozen=True, kw_only=True)
class KeyOptions:
    """How a relaxation becomes an animation.

    Parameters
    ----------
    output
        What is left on the object.
    start_frame
        Scene frame of the start.
    frames_per_iterate
        Scene frames from one iterate to the next.
    max_keys
        Wanted number of keys, see `Motion.keys`.
    fit_bevel
        Draw the curve as the thickest tube that does not touch itself, at every key.

    Raises
    ------
    OptionError
        If a value is outside its range.
    """

    output: Output = Output.SHAPE_KEYS
    start_frame: float = 1.0
    frames_per_iterate: float = 1.0
    max_keys: int | None = None
    fit_bevel: bool = False

    def __post_init__(self) -> None:
        if not abs(self.start_frame) <= LAST_FRAME:  # not a number is refused too
            raise OptionError(f"Start Frame is {self.start_frame:g}; it must be from {-LAST_FRAME} to {LAST_FRAME}")
        low, high = FRAMES_PER_ITERATE
        if not low <= self.frames_per_iterate <= high:
            raise OptionError(f"Frames/Iterate is {self.frames_per_iterate:g}; it must be from {low:g} to {high:g}")

    def check_room(self, iterations: int) -> None:
        """Raise an OptionError if so many iterations would be keyed to beyond the last frame of a scene."""
        end = self.start_frame + self.frames_per_iterate * iterations
        if self.output is not Output.RESULT and end > LAST_FRAME:
            raise OptionError(
                f"The keys would go on to frame {end:.0f}, but Blender's last is {LAST_FRAME}; "
                "give a smaller Start Frame, fewer Frames/Iterate or fewer Max Iterations"
            )

    def scene_frames(self, keys: Keys) -> FloatArray:
        """Scene frame of each key as Blender stores it, a 32-bit number, each later than the one before; (keys,)."""
        times = np.array([key.time for key in keys.keys])
        frames = (self.start_frame + self.frames_per_iterate * times).astype(np.float32)
        for k in range(1, len(frames)):
            frames[k] = max(frames[k], np.nextafter(frames[k - 1], np.float32(np.inf)))
        return frames.astype(np.float64)
