"""How a relaxation becomes an animation."""

from dataclasses import dataclass, field
from enum import Enum

from ...core import OptionError
from ...core.messages import Message
from .size import Measure
from .timing import Timing


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
    timing
        Which frames it takes.
    max_keys
        Wanted number of keys, see `Motion.keys`.
    fit_bevel
        Draw curves whose tubes were fitted before as the thickest tubes that do not touch, at every key.
    any_bevel
        Do so with every curve that is drawn as a line or a plain round tube, also where its depth is the artist's own.
    keep_size
        What stays as it is at the first key; where it is not the length, which the flow keeps, keys are scaled.
    """

    output: Output = Output.SHAPE_KEYS
    timing: Timing = field(default_factory=Timing)
    max_keys: int | None = None
    fit_bevel: bool = False
    any_bevel: bool = False
    keep_size: Measure = Measure.LENGTH

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
        if self.keep_size is not Measure.LENGTH:
            sentence = "Only the length can be kept where something is pinned or avoided; set Keep to Length"
            raise OptionError(Message(sentence))
