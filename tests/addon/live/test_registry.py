"""What else is done while a run goes on is counted, though Blender forgets it before it tells of an undo."""

from types import SimpleNamespace

import pytest

pytest.importorskip("bpy")

from mobius_flow.addon.live import registry


@pytest.fixture
def done(monkeypatch):
    """The operations that Blender lists, by their addresses."""
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


def test_drags_have_one_step_that_is_made_anew(done, monkeypatch):
    monkeypatch.setattr(registry.bpy.ops.ed, "undo_push", lambda message: None, raising=False)
    hidden = []
    group = SimpleNamespace(hide=lambda: hidden.append(True), resume=lambda: hidden.append(False))
    run, past = SimpleNamespace(drags=0, endures=True, group=group), registry.ActionCount()
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


def test_what_is_done_anew_cannot_be_done_again(done):
    past = registry.ActionCount()
    past.begin()
    done.append(8)
    past.look()
    done.clear()
    past.undo()
    past.look()
    assert (past.others, past.undone) == (0, 1)
    done.append(9)
    past.look()
    assert (past.others, past.undone) == (1, 0)
