"""Small pictures of knots: tubes in the colours of their components, whose crossings can be seen."""

from pathlib import Path
from runpy import run_path

import numpy as np
import pytest
from mobius_flow.addon.pictures import icons
from mobius_flow.core import Curve
from mobius_flow.core.keys.colours import PALETTE, linear
from mobius_flow.core.knots import KNOTS, smooth_knot
from shapes import regular_polygon

thumbnail = run_path(str(Path(__file__).parents[3] / "tools" / "knot_icons.py"))["thumbnail"]


def test_a_ring_is_a_ring():
    picture = thumbnail(regular_polygon(60), 96)
    assert picture.shape == (96, 96, 4)
    assert picture.min() >= 0
    assert picture.max() <= 1
    inside = picture[..., 3] > 0
    assert not inside[48, 48]
    assert not inside[:2].any()
    assert not inside[0, 0]
    assert inside[48].sum() == inside[:, 48].sum() > 8


def bars(upper):
    """Two flat bars that cross, one above the other."""
    found = [np.array([(-1, -0.02, 0), (1, -0.02, 0), (1, 0.02, 0), (-1, 0.02, 0)]) for _ in range(2)]
    found[1] = found[1][:, [1, 0, 2]]
    found[upper] = found[upper] + np.array([0, 0, 1.0])
    return Curve.from_components(found)


@pytest.mark.parametrize("upper", [0, 1])
def test_the_upper_strand_covers_the_lower(upper):
    color = thumbnail(bars(upper), 96)[48, 48, :3]
    assert np.argsort(color).tolist() == np.argsort(PALETTE[upper]).tolist()
    assert linear(color).max() > 0.5 * max(PALETTE[upper])


def test_the_rim_of_the_upper_strand_cuts_the_lower_one():
    """Seen on the lower strand, right beside the upper one, but not on the upper one beside the lower."""
    picture = thumbnail(bars(upper=1), 192)[..., :3].max(axis=2)
    assert picture[96, 90:103].max() > 0.3
    assert picture[96, 78:115].min() < 0.12
    assert picture[78:115, 96].min() > 0.3


@pytest.mark.parametrize("name", [*list(KNOTS)[::40], list(KNOTS)[-1]])
def test_the_sheet_has_the_pictures_of_the_table(name):
    """python tools/knot_icons.py draws it again."""
    assert abs(icons.cut(name) - thumbnail(smooth_knot(name), icons.SIDE)).max() < 0.03


def test_icons_are_made_when_they_are_asked_for():
    icons.forget()
    icons.icon("4_1")
    assert list(icons._made()) == ["4_1"]
    preview = icons._made()["4_1"]
    assert tuple(preview.icon_size) == (32, 32)
    pixels = np.array(preview.image_pixels_float[:]).reshape(96, 96, 4)
    assert 0.1 < (pixels[..., 3] > 0).mean() < 0.6
    icons.forget()
