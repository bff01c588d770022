"""What stands in the way of a relaxation, in one sentence, and the button that takes it out of the way."""

from dataclasses import dataclass
from enum import Enum

from ...core.messages import Message


class Remedy(Enum):
    """What mends something that is refused; the values are operators of `buttons.mending`."""

    OBJECT_MODE = "curve.mobius_flow_object_mode"
    MAKE_LOCAL = "curve.mobius_flow_make_local"
    SINGLE_USER = "curve.mobius_flow_single_user"
    TO_CURVE = "curve.mobius_flow_to_curve"
    TO_POLY = "curve.mobius_flow_to_poly"
    MAKE_3D = "curve.mobius_flow_make_3d"
    COPY = "curve.mobius_flow_copy"


@dataclass(frozen=True)
class Refusal:
    """Why something cannot be done.

    Attributes
    ----------
    sentence
        The reason, and what helps.
    remedy
        What does so by itself, if anything can.
    """

    sentence: Message
    remedy: Remedy | None = None
