"""What else is done while a run goes on is counted, though Blender forgets it before it tells of an undo."""

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
    past = registry.History()
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


def test_what_is_done_anew_cannot_be_done_again(done):
    past = registry.History()
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
