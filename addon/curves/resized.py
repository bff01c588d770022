"""The keys of baked curve objects scaled, so that their size stays while they move."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core import MobiusFlowError
from ...core.messages import Message
from ..engine.size import Measure, Size
from . import pins
from .baked_keys import BakedKeys

if TYPE_CHECKING:
    import bpy


def keep_size(objects: Sequence["bpy.types.Object"], measure: Measure, reference: int) -> BakedKeys:
    """Scale all keys about their barycenters to the size of one of them, and the tubes drawn around them alike.

    Why that makes no contact is told in `engine.size`; what the rounded keys are is to be proved once more.

    Raises
    ------
    MobiusFlowError
        If the objects were not baked together, or points of them are pinned.
    """
    if any(pins.count(obj.data) for obj in objects):
        raise MobiusFlowError(Message("Scaling would move pinned points; unpin them first"))
    keys = BakedKeys(objects)
    curves = keys.curves
    size = Size.of(measure, curves[reference])
    keys.rewrite([size.given_to(curve) for curve in curves], np.array([size.factor(curve) for curve in curves]))
    return keys
