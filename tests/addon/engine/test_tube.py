"""How thick a tube may be."""

from mobius_flow.addon.engine.tube import free_radius, thickest_radius
from shapes import regular_polygon


def test_where_there_is_room_the_tube_is_as_thick_as_looks_right():
    circle = regular_polygon(100)
    thickest = thickest_radius(circle)
    assert free_radius(circle, thickest) == thickest
