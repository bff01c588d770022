"""The parts of a run: when it redraws, how its keys are written, and what else is done while it goes on."""

from types import SimpleNamespace

import pytest

pytest.importorskip("bpy")

from mobius_flow.addon.live import registry
from mobius_flow.addon.live.refresh import Refresh
from mobius_flow.addon.live.run import LiveRun, RunState
from mobius_flow.core import MobiusFlowError


@pytest.mark.parametrize("drawing", [1e-6, 0.001, 0.1, 2.0])
def test_drawing_gets_a_third_of_the_time_at_most(drawing):
    """Where it takes no time but the wait for the next event, the curves are shown 15 times a second."""
    now, drew, index = 0.0, 0, 0
    refresh = Refresh(clock=lambda: now)
    while now < 60.0:
        refresh.drawn()
        index += 1
        if refresh.due(index):
            refresh.shown()
            now, drew = now + drawing, drew + 1  # a window draws what is shown before it sends the next event
        now += 1 / 60
    assert 0 < drew * drawing <= now / 3 + drawing
    assert drawing > 1e-6 or drew > 60 * 14


def test_what_is_shown_at_once():
    """The first iterate, one in so many, and after a pause the very next one."""
    assert Refresh().due(0)
    refresh = Refresh(3)
    assert [index for index in range(10) if refresh.due(index)] == [0, 3, 6, 9]
    assert [index for index in range(10) if refresh.ends_batch(index)] == [0, 3, 6, 9]
    assert not any(Refresh().ends_batch(index) for index in range(10))
    refresh = Refresh(clock=lambda: -1.0)
    refresh.waited = True
    assert refresh.ends_batch(7)
    assert refresh.due(7)
    refresh.shown()
    assert not refresh.ends_batch(8)


def test_proofs_for_keys_end_with_the_run():
    run = SimpleNamespace(state=RunState.FINISHING, session=SimpleNamespace(proved=max))
    assert LiveRun._proved(run, 1, 2) == 2
    run.state = RunState.CANCELLED
    with pytest.raises(MobiusFlowError, match="over"):
        LiveRun._proved(run, 1, 2)


@pytest.fixture
def done(monkeypatch):
    """The operations that Blender lists, by their addresses: it forgets them before it tells of an undo."""
    listed = [7]
    monkeypatch.setattr(registry, "_last_operation", lambda: listed[-1] if listed else 0)
    return listed


def test_undo_is_about_what_was_done_since(done):
    past = registry.ActionCount()
    past.begin()
    past.look()
    assert (past.others, past.undone) == (0, 0)
    for address in (8, 9):
        done.append(address)
        past.look()
        past.look()
    assert past.others == 2
    for left in (1, 0):
        done.pop()
        past.undo()
        past.look()
        assert (past.others, past.undone) == (left, 2 - left)
    done.append(8)
    past.undo(-1)
    past.look()
    assert (past.others, past.undone) == (1, 1)
    done.append(9)  # what is done anew cannot be done again
    past.look()
    assert (past.others, past.undone) == (2, 0)
    done.clear()
    past.undo()
    past.look()
    assert (past.others, past.undone) == (1, 1)


def test_drags_have_one_step_that_is_made_anew(done, monkeypatch):
    monkeypatch.setattr(registry.bpy.ops.ed, "undo_push", lambda message: None, raising=False)
    hidden = []
    session = SimpleNamespace(hide=lambda: hidden.append(True), resume=lambda: hidden.append(False))
    run, past = SimpleNamespace(drags=0, endures=True, session=session), registry.ActionCount()
    past.begin()
    past.push(run)
    assert past.others == 0, "nothing was dragged"
    run.drags = 2
    past.push(run)
    past.push(run)
    assert (past.others, hidden) == (1, [True, False])
    done.append(8)
    past.look()
    done.pop()
    assert not past.undo(), "something else came after it"
    assert past.undo()
    run.drags = 1
    past.push(run)
    assert (past.others, past.undone) == (1, 0)
    run.drags = 0
    assert past.undo()
    assert not past.undo(-1), "drags are not done again"
    past.push(run)
    assert past.others == 1
