"""Lines can be told from the ground that they are drawn on."""

import pytest
from mobius_flow.addon.engine.contrast import contrast, legible, luminance

BLACK, WHITE, ORANGE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (1.0, 0.63, 0.16)


def test_contrast_is_that_of_the_standard():
    assert luminance(WHITE) == pytest.approx(1)
    assert contrast(BLACK, WHITE) == contrast(WHITE, BLACK) == pytest.approx(21)
    assert contrast(ORANGE, ORANGE) == 1
    assert contrast((0.4667,) * 3, WHITE) == pytest.approx(4.48, abs=0.01)  # #777777, by which the bound 4.5 is missed


@pytest.mark.parametrize("ground", [(0.1,) * 3, (0.25,) * 4, (0.5,) * 3, (0.75,) * 4, (0.98,) * 3, ORANGE], ids=str)
@pytest.mark.parametrize("wanted", [ORANGE, BLACK, WHITE, (0.2, 0.4, 0.8)], ids=str)
def test_what_is_drawn_can_be_seen(wanted, ground):
    drawn = legible(wanted, ground)
    assert contrast(drawn, ground) >= 3
    assert drawn == wanted or contrast(wanted, ground) < 3
