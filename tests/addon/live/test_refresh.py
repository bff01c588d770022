"""Drawing gets a third of the time at most, however long it takes; or every so many iterates are shown."""

import pytest

pytest.importorskip("bpy")

from mobius_flow.addon.live.run import Refresh


class Window:
    """A clock, and a window that takes a while to draw what is shown before it sends the next event."""

    def __init__(self, drawing, computing):
        self.now, self.drawing, self.computing, self.drew = 0.0, drawing, computing, 0.0

    def clock(self):
        return self.now

    def run(self, seconds):
        refresh, index = Refresh(clock=self.clock), 0
        while self.now < seconds:
            refresh.drawn()
            index += 1
            if refresh.due(index):
                refresh.shown()
                self.now += self.drawing
                self.drew += self.drawing
            self.now += self.computing


@pytest.mark.parametrize("drawing", [0.001, 0.1, 2.0])
def test_drawing_gets_a_third_of_the_time_at_most(drawing):
    window = Window(drawing, computing=1 / 60)
    window.run(60.0)
    assert 0 < window.drew <= window.now / 3 + drawing


def test_fast_drawing_is_smooth():
    """Where drawing takes no time but the wait for the next event, the curves are shown 15 times a second."""
    window = Window(1e-6, computing=1 / 60)
    window.run(60.0)
    assert window.drew / 1e-6 > 60 * 14


def test_the_first_iterate_is_shown_at_once():
    assert Refresh().due(0)


def test_every_so_many():
    refresh = Refresh(3)
    assert [index for index in range(10) if refresh.due(index)] == [0, 3, 6, 9]
    assert [index for index in range(10) if refresh.ends_batch(index)] == [0, 3, 6, 9]
    assert not any(Refresh().ends_batch(index) for index in range(10))


def test_after_a_pause_the_very_next_one():
    refresh = Refresh(clock=lambda: -1.0)
    refresh.wait()
    assert refresh.ends_batch(7)
    assert refresh.due(7)
    refresh.shown()
    assert not refresh.ends_batch(8)
