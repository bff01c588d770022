"""The HOMFLY polynomial: KnotInfo's values, what it specialises to, and what does not change it."""

import numpy as np
import pytest
from mobius_flow.core.knots import KNOTS
from mobius_flow.core.knots.braids import braid_diagram, mirror
from mobius_flow.core.knots.diagrams import Diagram, jones, simplified, views
from mobius_flow.core.knots.diagrams.homfly import homfly, homfly_text
from mobius_flow.core.knots.names import knot, named_diagram

# from KnotInfo and LinkInfo (C. Livingston, A. H. Moore), of the braid words there
PUBLISHED = {
    "0_1": "1",
    "3_1": "(2v² − v⁴) + v² z²",
    "4_1": "(v⁻² − 1 + v²) − z²",
    "8_19": "(5v⁶ − 5v⁸ + v¹⁰) + (10v⁶ − 5v⁸) z² + (6v⁶ − v⁸) z⁴ + v⁶ z⁶",
    "10_132": "(−2v⁻⁶ + 3v⁻⁴) + (−v⁻⁶ + 4v⁻⁴) z² + v⁻⁴ z⁴",
    "L2a1": "(v − v³) z⁻¹ + v z",
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_values(name):
    assert homfly_text(homfly(braid_diagram(KNOTS[name]))) == PUBLISHED[name]


@pytest.mark.parametrize("name", ["6_2", "8_20", "9_42", "L5a1", "L6n1", "L7a7"])
def test_it_becomes_the_jones_polynomial(name):
    """At v = t, z = √t − 1/√t, here at a number for t."""
    diagram, t = braid_diagram(KNOTS[name]), 1.7
    found = sum(c * t**v * (t**0.5 - t**-0.5) ** z for (v, z), c in homfly(diagram).items())
    assert found == pytest.approx(sum(c * t ** (power / 2) for power, c in jones(diagram).items()))


def test_mirror_images_and_views_and_parts():
    word = KNOTS["9_42"]
    right, left = homfly(braid_diagram(word)), homfly(braid_diagram(mirror(word)))
    assert left == {(-v, z): c * (-1) ** z for (v, z), c in right.items()}
    assert all(homfly(view) == right for view in views(knot("9_42"), 3) if view.crossings <= 24)
    assert homfly(Diagram(((), ()), ())) == {(-1, -1): 1, (1, -1): -1}
    both = homfly(named_diagram("3_1#4_1"))
    assert sum(both.values()) == sum(homfly(named_diagram("3_1")).values()) * sum(homfly(named_diagram("4_1")).values())


def test_large_diagrams_are_left_alone():
    assert homfly(braid_diagram((1, 2) * 13)) is None


def test_random_braids_keep_it_while_they_are_simplified():
    rng = np.random.default_rng(5)
    for _ in range(10):
        letters = rng.integers(1, 4, size=12) * rng.choice([-1, 1], size=12)
        diagram = braid_diagram((*letters.tolist(), 1, -1, 3, 2, -3, 3, -2, -3))
        assert homfly(diagram) == homfly(simplified(diagram))
