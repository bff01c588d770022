"""Relax on a curve with keys asks: Escape changes nothing, Continue goes on from the end, Start Again begins anew."""

from collections.abc import Generator

import numpy as np
from case import Steps, picture, until
from hands import button, click, entry, found, key
from scene import endless, is_, obj, points, reaches, ready, run


def case() -> Steps:
    yield from ready()
    endless()
    before = points()
    yield from button("curve.mobius_flow_relax")
    yield from kept()
    first = keys()

    yield from asked("again-1-asked")
    yield from key("ESC")
    assert run() is None
    assert np.array_equal(keys()[-1], first[-1])

    where = yield from asked("again-2-asked")
    yield from entry("curve.mobius_flow_continue", *where)
    yield from kept()
    assert len(keys()) > len(first)
    for now, then in zip(keys(), first, strict=False):
        assert np.array_equal(now, then), "new keys follow the old ones"
    yield from picture("again-3-continued", differs_from="again-2-asked")

    where = yield from asked("again-4-asked")
    yield from entry("again=True", *where)
    yield from kept()
    assert np.array_equal(keys()[0], before[:, :3]), "it begins with the curve as it was"
    yield from picture("again-5-anew", differs_from="again-3-continued")


def asked(name: str) -> Generator[None, None, tuple[int, range]]:
    """Press Relax, and have a picture of the question; where its answers are."""
    x, y = yield from found("curve.mobius_flow_relax")
    yield from click(x, y)
    yield from picture(name)
    assert run() is None, "nothing begins before the answer"
    return x, range(y + 60, y - 100, -6)


def kept() -> Steps:
    """A moment of relaxation, and its keys."""
    yield from until(lambda: run() is not None, "a run")
    yield from reaches(3)
    run().keep()
    yield from is_("done")
    yield from until(lambda: obj().data.shape_keys is not None, "the keys")


def keys() -> list[np.ndarray]:
    """Shapes of the keys, bit for bit."""
    blocks = obj().data.shape_keys.key_blocks
    return [np.array([p.co[:] for p in block.data], dtype=np.float32) for block in blocks]
