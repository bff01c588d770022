"""Colours: what screens are sent and light are each other's inverse, and components can be told apart."""

from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.addon.engine.colours import PALETTE, flatly_lit, linear, on_screen
from mobius_flow.addon.engine.contrast import contrast

_MENU = (0.1, 0.1, 0.1)  # of the dark theme; on light ones the rims of thumbnails set them off


def test_screen_values_and_light_are_inverse():
    values = np.linspace(0.0, 1.0, 257)
    np.testing.assert_allclose(on_screen(linear(values)), values, atol=1e-6)
    assert on_screen(np.array([0.0, 0.2140, 1.0])) == pytest.approx([0.0, 0.5, 1.0], abs=1e-4)


def test_components_stand_out_from_dark_menus():
    for color in on_screen(flatly_lit(np.array(PALETTE))):
        assert contrast(color, _MENU) > 3


def test_neighbouring_components_differ():
    for one, other in pairwise((*PALETTE, PALETTE[0])):
        assert np.abs(on_screen(np.array(one)) - on_screen(np.array(other))).max() > 0.2
