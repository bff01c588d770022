"""Keys are proved in a thread that ends when nobody wants them, and written a little at a time."""

import threading
from types import SimpleNamespace

import pytest
from mobius_flow.addon.live.run import KeyWriter
from mobius_flow.core import MobiusFlowError
from processes import PATIENCE


def started(session, proof):
    """A writer whose thread is at its end."""
    writer = KeyWriter(session, proof)
    writer.start()
    writer._thread.join(PATIENCE)
    return writer


def test_keys_are_written_a_piece_at_a_time(monkeypatch):
    monkeypatch.setattr(KeyWriter, "slice", 0.0)
    written = []

    def bake(prepared):
        for k in range(3):
            yield written.append((prepared, k))
        yield f"{prepared} is done"

    session = SimpleNamespace(prepare=lambda proof: proof("mesh", "start", "end"), bake=bake)
    writer = started(session, lambda *motion: " ".join(motion))
    for k in range(3):
        assert writer.advance() is None
        assert written == [("mesh start end", piece) for piece in range(k + 1)]
    assert writer.advance() == "mesh start end is done"


def test_an_abandoned_thread_ends_at_its_next_proof():
    gate, proved, went_on = threading.Event(), [], []

    def prepare(proof):
        gate.wait(PATIENCE)
        proof(None, None, None)
        went_on.append(True)

    writer = KeyWriter(SimpleNamespace(prepare=prepare), lambda *_: proved.append(True))
    writer.start()
    writer.abandon()
    gate.set()
    writer._thread.join(PATIENCE)
    assert not writer._thread.is_alive()
    assert not proved
    assert not went_on


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_thread_that_fails_is_an_error():
    writer = started(SimpleNamespace(prepare=lambda proof: proof(1)), lambda *_: True)
    with pytest.raises(MobiusFlowError, match="could not be prepared"):
        writer.advance()
