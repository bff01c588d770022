"""What the worker does: the driver's iterates, with proofs for the motions that Blender's own numbers make of them."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from ...core import Iterate, MobiusFlowError, relax
from ...core.collision import is_free
from ..exchange import Placement
from ..motion import Frame
from . import wire


def messages(job: wire.Message) -> Iterator[wire.Message]:
    """Yield the iterates of a job as messages, or one message with the reason why it cannot be done."""
    curve, options, placement = wire.unpack_job(job)
    last: Frame | None = None
    try:
        for iterate in relax(curve, options):
            frames = _frames(iterate, placement)
            yield wire.pack_iterate(iterate, _proved(iterate, [*([] if last is None else [last]), *frames]))
            last = frames[-1]
    except MobiusFlowError as error:
        yield {"error": str(error)}, []


def _frames(iterate: Iterate, placement: Placement) -> list[Frame]:
    """The ends of the legs as Blender will store them, as in `Motion.add`."""
    return [placement.to_local(v).astype(np.float32) for v in iterate.path or (iterate.curve.vertices,)]


def _proved(iterate: Iterate, frames: list[Frame]) -> list[str]:
    """Names of the motions from frame to frame that are free of contact."""
    mesh = iterate.curve.mesh
    return [
        wire.digest(a, b)
        for a, b in pairwise(frames)
        if a.shape == b.shape and is_free(mesh, a.astype(np.float64), b.astype(np.float64))
    ]
