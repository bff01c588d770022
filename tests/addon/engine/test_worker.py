"""What Blender and its worker tell each other arrives as it was, to the last bit, and the worker's proofs are right."""

import pickle
import queue
import signal
import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.addon.engine.worker import Worker, digest, in_common_space, messages
from mobius_flow.core import Curve, CurveError, Iterate, Obstacle, OptionError, Outcome, RelaxOptions, Task
from mobius_flow.core.base.arguments import declared
from mobius_flow.core.base.errors import Place
from mobius_flow.core.base.messages import Message
from mobius_flow.core.collision import Contact, is_free
from mobius_flow.core.driver.outcome import stalled
from mobius_flow.core.driver.words import in_blenders_words, spline_names
from mobius_flow.core.keys.placement import Link, Placement
from mobius_flow.core.keys.recording import frames_of
from option_values import unlike_default
from processes import PATIENCE
from shapes import hopf_link

HERE = Placement(np.eye(3), np.zeros(3))
THERE = Placement(np.array([[2.0, 1.0, 0.0], [0.0, -1.0, 0.5], [0.0, 0.0, 3.0]]), np.array([5.0, 6.0, 7.0]))
GIVEN = {each.name: unlike_default(each) for each in declared(RelaxOptions) if not each.repeated}


def job(avoid, placement=HERE):
    """A ring through a circle, stretched so that it would leave it, stored in an object's coordinates."""
    ring = hopf_link(24).vertices[24:] * [1.0, 1.0, 4.0]
    link = Link((placement,), (1,))
    stored = link.to_stored(Curve.from_components([ring]).mesh, ring).astype(np.float32)
    curve = Curve.from_components([placement.to_world(stored.astype(float))])
    return Task(curve=curve, obstacles=avoid), RelaxOptions(max_iterations=20, vertices=60, mesh="fixed"), link


def circle():
    points, k = hopf_link(24).vertices[:24], np.arange(24)
    return Obstacle(points, np.stack([k, (k + 1) % 24], axis=1), "Circle")


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


def test_a_process_has_the_same_iterates():
    """Blender's worker, with a goal, which is reached in the same bits."""
    task, options, link = job((), THERE)
    goals = {"Goal": task.curve.with_vertices(task.curve.vertices[::-1] + 1.0)}
    *expected, (last, _), outcome = done(task, options, link, False, goals)
    worker, found = Worker(task, options, link, goals=goals), []
    try:
        assert worker.process is not None
        while not found or isinstance(found[-1], Iterate):
            found.append(worker._queue.get(timeout=PATIENCE))
            found[-1] = found[-1] if isinstance(found[-1], Outcome) else found[-1][0]
    finally:
        worker.close()
    assert found[-1] == outcome
    for one, (other, _) in zip(found[:-1], [*expected, (last, ())], strict=True):
        np.testing.assert_array_equal(one.curve.vertices, other.curve.vertices)
        assert (one.index, one.energy, len(one.path)) == (other.index, other.energy, len(other.path))
    np.testing.assert_array_equal(np.sort(last.curve.vertices, axis=0), np.sort(goals["Goal"].vertices, axis=0))


def test_the_common_space_is_that_of_the_first_object():
    (mapped,) = in_common_space([circle()], Link((THERE, HERE), (1, 1)))
    np.testing.assert_allclose(THERE.to_world(mapped.vertices), circle().vertices, atol=1e-14)
    assert mapped.name == "Circle"
    (same,) = in_common_space([circle()], Link((HERE, THERE), (1, 1)))
    np.testing.assert_array_equal(same.vertices, circle().vertices)


@pytest.mark.parametrize("placement", [HERE, THERE], ids=["plain", "placed"])
def test_motions_are_proved_beside_obstacles(placement):
    """What it proves is free of the obstacle in Blender's own numbers; without it the curve would have crossed."""
    task, options, link = job((circle(),), placement)
    beside = in_common_space(task.obstacles, link)

    def free(obstacles):
        *said, outcome = done(Task(curve=task.curve, obstacles=obstacles), options, link, False, {})
        assert isinstance(outcome, Outcome)
        mesh = said[0][0].curve.mesh
        common = [link.to_common(mesh, frame) for iterate, _ in said for frame in frames_of(link, iterate)]
        motions = list(pairwise(common))
        assert {digest(a, b) for a, b in motions} == {name for _, names in said for name in names}
        return all(is_free(mesh, a, b, beside) for a, b in motions)

    assert free(task.obstacles)
    assert not free(())


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
