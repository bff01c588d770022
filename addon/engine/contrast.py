"""Colours that can be read, whatever the theme."""

from collections.abc import Sequence

import numpy as np

from .colours import linear

Colour = Sequence[float]  # red, green and blue from 0 to 1, as on the screen; more is not looked at

_ENOUGH = 3.0  # contrast of lines, after WCAG 2.1


def luminance(colour: Colour) -> float:
    """Relative luminance, from 0 for black to 1 for white (WCAG 2.1)."""
    return float(linear(np.asarray(colour[:3], dtype=np.float64)) @ [0.2126, 0.7152, 0.0722])


def contrast(one: Colour, other: Colour) -> float:
    """Contrast of two colours, from 1 to 21 (WCAG 2.1)."""
    dark, light = sorted([luminance(one), luminance(other)])
    return (light + 0.05) / (dark + 0.05)


def legible(wanted: Colour, ground: Colour) -> Colour:
    """The wanted colour, or black or white if it cannot be told from the ground."""
    return max((wanted, (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), key=lambda each: min(contrast(each, ground), _ENOUGH))
