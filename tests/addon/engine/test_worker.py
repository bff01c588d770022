"""What Blender and its worker tell each other arrives as it was, to the last bit."""

import pickle
import queue
import signal
import subprocess
import sys

import pytest
from mobius_flow.addon.engine.worker import messages
from mobius_flow.core import CurveError, OptionError, RelaxOptions
from mobius_flow.core.base.arguments import declared
from mobius_flow.core.base.errors import Place
from mobius_flow.core.base.messages import Message
from mobius_flow.core.collision import Contact
from mobius_flow.core.driver.outcome import stalled
from mobius_flow.core.driver.words import in_blenders_words, spline_names
from option_values import unlike_default
from processes import PATIENCE

GIVEN = {each.name: unlike_default(each) for each in declared(RelaxOptions) if not each.repeated}


def sent(value):
    return pickle.loads(pickle.dumps(value))


def done(*given):
    """What the worker says about a job; all of it is fit to be sent."""
    inbox = queue.SimpleQueue()
    inbox.put(sent(given))
    return [sent(said) for said in messages(inbox)]


def test_options_and_words_arrive_as_they_were():
    options = RelaxOptions(**GIVEN | {"mesh": "auto"})  # others make their own edge_lengths
    assert sent(options) == options
    edges = Contact((2, 7)).message
    outcome = stalled(Message("{contact} are so close", contact=edges), Place((1,), (0.0, 1.0)))
    outcome = outcome.adding("{x:.2g}", x=0.5)
    assert sent(outcome) == outcome
    names = spline_names(["Ring"], [1])
    assert in_blenders_words(sent(outcome).message, names) == "stalled: segment 3 and segment 8 are so close; 0.5"
    for error in (CurveError(edges, outcome.place), OptionError(edges)):
        assert type(sent(error)) is type(error)
        assert in_blenders_words(str(sent(error)), names) == "segment 3 and segment 8"
        assert getattr(sent(error), "place", None) == getattr(error, "place", None)


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="there is no such signal")
def test_a_worker_that_is_gone_does_not_end_blender() -> None:
    """Some builds of Blender leave SIGPIPE as it is, unlike Python by itself."""
    program = """
import queue, signal, subprocess, sys, threading
from mobius_flow.addon.engine.worker import _send
signal.signal(signal.SIGPIPE, signal.SIG_DFL)
gone = subprocess.Popen([sys.executable, "-c", ""], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
gone.wait()
inbox = queue.SimpleQueue()
for packet in (b"x" * 100_000, None):
    inbox.put(packet)
thread = threading.Thread(target=_send, args=(gone, inbox))
thread.start()
thread.join()
print("still there")
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert (done.returncode, done.stdout) == (0, "still there\n"), done.stderr
