"""What drawn knots are called."""

import pytest
from mobius_flow.core.knots import Drawing, knot, torus_knot
from mobius_flow.core.knots.recognition import names_alike


@pytest.mark.parametrize("name", ["3_1", "4_1", "6_2", "6_3", "7_7"])
def test_drawn_alternating_knots_are_recognised(name: str) -> None:
    curve = knot(name)
    drawing = Drawing.of(curve.with_vertices(curve.vertices[:, :2]))
    assert names_alike(drawing.lifted(), len(drawing.crossings)) == [name]


def test_a_changed_crossing_gives_the_unknot() -> None:
    curve = torus_knot(2, 3)
    assert names_alike(Drawing.of(curve.with_vertices(curve.vertices[:, :2])).lifted([2]), 3) == ["0_1"]


def test_knots_with_one_polynomial_are_all_named_and_only_those_with_few_crossings() -> None:
    assert names_alike(knot("6_1"), 8) == ["6_1"]
    assert names_alike(knot("6_1"), 9) == ["6_1", "9_46"]


def test_links_have_no_name() -> None:
    assert names_alike(knot("hopf"), 2) == []
