"""What the worker does: the driver's iterates, with proofs for the motions that Blender's own numbers make of them."""

from collections.abc import Iterator
from itertools import pairwise

from ...core import Iterate, MobiusFlowError, Obstacle, WithOutcome, relax
from ...core.collision import is_free
from . import wire
from .motion import frames_of
from .obstacles import in_common_space
from .placement import Frame, Link


def messages(job: wire.Packet) -> Iterator[wire.Packet]:
    """Yield the iterates of a job as messages, or one message with the reason why it cannot be done."""
    task, options, link = wire.unpack_job(job)
    obstacles = in_common_space(task.obstacles, link)
    last: Frame | None = None
    try:
        run = WithOutcome(relax(task, options))
        for iterate in run:
            frames = frames_of(link, iterate)
            proved = _proved(iterate, link, [*([] if last is None else [last]), *frames], obstacles)
            yield wire.pack_iterate(iterate, proved)
            last = frames[-1]
        assert run.outcome is not None, "the loop is through"
        yield wire.pack_outcome(run.outcome)
    except MobiusFlowError as error:
        yield wire.pack_error(error)


def _proved(iterate: Iterate, link: Link, frames: list[Frame], obstacles: tuple[Obstacle, ...]) -> list[str]:
    """Names of the motions from frame to frame that are free of contact, in the common space."""
    mesh = iterate.curve.mesh
    if any(len(frame) != mesh.size for frame in frames):
        return []
    common = [link.to_common(mesh, frame) for frame in frames]
    return [wire.digest(a, b) for a, b in pairwise(common) if is_free(mesh, a, b, obstacles)]
