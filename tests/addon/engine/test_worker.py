"""What Blender and its worker tell each other, in Blender's words, and what is said of curves at rest."""

import pickle
import queue
import re
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
from mobius_flow.addon.engine.rest import CIRCLE, target_of
from mobius_flow.addon.engine.worker import STOP, messages
from mobius_flow.core import (
    Curve,
    CurveError,
    Mesh,
    MoebiusEnergy,
    Obstacle,
    OptionError,
    Outcome,
    RelaxOptions,
    Status,
    Task,
    relax,
)
from mobius_flow.core.base.arguments import declared
from mobius_flow.core.base.errors import Place
from mobius_flow.core.base.messages import Message
from mobius_flow.core.collision import Contact
from mobius_flow.core.driver.outcome import converged, stalled
from mobius_flow.core.driver.words import in_blenders_words, spline_names
from mobius_flow.core.knots import knot, overhand
from mobius_flow.core.ropes import TightenOptions, tightening
from option_values import unlike_default
from processes import PATIENCE
from shapes import hopf_link, torus_trefoil
from tasks import wanted

GIVEN = {each.name: unlike_default(each) for each in declared(RelaxOptions) if not each.repeated}


def sent(value):
    return pickle.loads(pickle.dumps(value))


def done(*given):
    """What the worker says about a job; all of it is fit to be sent."""
    inbox = queue.Queue()
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


def test_a_stop_ends_a_step_and_gives_what_was_reached(monkeypatch):
    inbox = queue.Queue()

    def drawn(curve, *_):
        inbox.put(STOP)
        yield curve

    monkeypatch.setattr(sys.modules[tightening.__module__], "redrawn", drawn)
    inbox.put((Task(curve=knot("3_1", 60)), TightenOptions(vertices=100, starts=9), False, {}))
    *way, outcome = messages(inbox)
    assert outcome.status is Status.INTERRUPTED
    assert way[-1].energy < 34.0
    for given in (RelaxOptions(), TightenOptions()):
        inbox = queue.Queue()
        for said in ((Task(curve=knot("3_1", 60)), given, False, {}), ("pause", (True,)), STOP):
            inbox.put(said)
        *way, outcome = messages(inbox)
        assert outcome.status is Status.INTERRUPTED
        assert len(way) < 2


def test_a_stop_reaches_a_worker_that_waits():
    inbox = queue.Queue()
    inbox.put((Task(curve=knot("3_1", 60)), RelaxOptions(), False, {}))
    said = messages(inbox)
    next(said)
    inbox.put(("pause", (True,)))
    threading.Timer(0.2, inbox.put, [STOP]).start()
    assert next(said).status is Status.INTERRUPTED


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="there is no such signal")
def test_a_worker_that_is_gone_does_not_end_blender():
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


NAMES = spline_names(["Ring", "Knot"], [1, 2])
SQUARE = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]
ABOVE = [[x, y, z + 1.0] for x, y, z in SQUARE]
WALL = Obstacle([[-1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [0.0, 1.0, 1.0]], [[0, 1, 2]], "edge of component 1")
OTHER = [[1.0, 2.0, 0.0], [1.0, 1.0, 3.0], [1.0, 3.0, 3.0]]
# what is wrong, what is avoided, and how the message begins, if the names of parts matter
BAD = {
    "repeated": (
        [ABOVE, [*SQUARE, SQUARE[3]]],
        (),
        "point 4 of spline 1 of 'Knot' and point 5 of spline 1 of 'Knot' are the same",
    ),
    "doubled back": (
        [[*SQUARE, [0.0, -1.0, 0.0]]],
        (),
        "the curve doubles back at point 5 of spline 1 of 'Ring', (0, -1, 0)",
    ),
    "crossing": ([[SQUARE[0], SQUARE[2], SQUARE[1], SQUARE[3]]], (), ""),
    "crossing another": ([SQUARE, OTHER], (), "segment 3 of spline 1 of 'Ring' and segment 1 of spline 1 of 'Knot' t"),
    "too near": ([SQUARE, [[x, y, 1e-12] for x, y, _ in SQUARE]], (), ""),
    "too large": ([[[1e41 * x for x in point] for point in SQUARE]], (), ""),
    "too small": ([[[1e-41 * x for x in point] for point in SQUARE]], (), ""),
    "too many": ([torus_trefoil(200_001).vertices], (), ""),
    "avoided": ([SQUARE], (WALL,), "segment 4 of spline 1 of 'Ring' pierces 'edge of component 1' at (0, 1, 0)"),
}


@pytest.mark.parametrize(("components", "avoid", "begins"), BAD.values(), ids=BAD)
def test_what_the_core_refuses_is_told_in_other_terms(components, avoid, begins):
    with pytest.raises(CurveError) as error:
        relax(Task(curve=Curve.from_components(components), obstacles=avoid))
    said = in_blenders_words(str(error.value), NAMES)
    assert said.startswith(begins)
    assert not re.search(r"component|vert|edge", said.replace(WALL.name, "")), "what is avoided keeps its name"


def test_splines_are_counted_in_each_object():
    assert NAMES == ["spline 1 of 'Ring'", "spline 1 of 'Knot'", "spline 2 of 'Knot'"]


def test_clauses_are_kept_where_an_outcome_stalls():
    outcome = converged(1.25e-5, 1e-4).adding("a minimum").stalling("no way on: {error}", error="{x}")
    assert outcome == Outcome(Status.STALLED, ("stalled: no way on: {x}", "a minimum"))


POST = Obstacle([[0.0, 0.0, -9.0], [0.0, 0.0, 9.0]], [[0, 1]])
LINK = Curve.from_components([*hopf_link(24).components, overhand(60).vertices + 20], (True, True, False))
TARGETS = {
    "an unknot may become a circle": (knot("culprit"), {}, "circle = 4"),
    "so may another": (knot("goeritz"), {}, "circle = 4"),
    "and another": (knot("thistlethwaite"), {}, "circle = 4"),
    "a knot does not": (knot("3_1"), {}, None),
    "nor an achiral one": (knot("4_1"), {}, None),
    "nor one that is not alternating": (knot("8_19"), {}, None),
    "a link has a circle's energy for each component": (hopf_link(24), {}, "floor = 8"),
    "arcs add nothing": (LINK, {}, "floor = 8"),
    "an arc may become straight": (overhand(60), {}, "straight = 0"),
    "pins keep it from that": (overhand(60), {"pins": (0, 59)}, None),
    "and so do obstacles": (knot("culprit"), {"avoid": (POST,)}, None),
    "other energies have other minima": (knot("culprit"), {"energy": "edge"}, None),
}


@pytest.mark.parametrize(("curve", "settings", "label"), TARGETS.values(), ids=TARGETS)
def test_where_curves_lead(curve, settings, label):
    target = target_of(*wanted(curve, **settings))
    assert (target and target.label) == label
    assert target is None or target.energy == float(label.split()[-1])


def test_the_type_of_curves_with_very_many_vertices_is_left_open():
    assert target_of(torus_trefoil(60), RelaxOptions(), most=59).label == "circle = 4"
    assert target_of(torus_trefoil(59), RelaxOptions(), most=59) is None


@pytest.mark.parametrize("n", [50, 400])
def test_it_is_the_energy_of_the_circle_and_of_the_segment(n):
    angles = 2 * np.pi * np.arange(n) / n
    circle = Curve(np.column_stack([np.cos(angles), np.sin(angles), 0 * angles]))
    assert MoebiusEnergy().value(circle) == pytest.approx(CIRCLE, rel=10 / n**2)
    segment = Curve(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]]), Mesh((3,), (False,)))
    assert MoebiusEnergy().value(segment) == pytest.approx(0.0, abs=1e-12)
