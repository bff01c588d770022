"""Knot Floer homology decides where polynomials do not, and only where it is installed."""

import sys

import pytest
from mobius_flow.core.diagrams import diagram_of
from mobius_flow.core.knots import HARD_UNKNOTS, KNOTS, braid_word
from mobius_flow.core.knots.braids import braid_diagram, connected_sum
from mobius_flow.core.knots.floer import floer, of_least_genus
from mobius_flow.core.knots.knot_type import GENUS, type_of_diagram

GENERA = {"3_1": 1, "4_1": 1, "5_1": 2, "7_4": 1, "8_19": 3, "10_132": 2}


@pytest.mark.parametrize("name", GENERA)
def test_genera_of_the_table(name):
    pytest.importorskip("knot_floer_homology")
    assert floer(braid_diagram(KNOTS[name])).genus == GENERA[name]


def test_unknots_are_proved_without_being_simplified(monkeypatch):
    pytest.importorskip("knot_floer_homology")
    diagram = diagram_of(HARD_UNKNOTS["ochiai-1"])
    found = type_of_diagram(diagram)
    assert (found.names, found.proved, found.evidence) == (("0_1",), True, (GENUS,))
    monkeypatch.setitem(sys.modules, "knot_floer_homology", None)
    floer.__globals__["_computed"].cache_clear()
    assert floer(diagram) is None
    assert type_of_diagram(diagram).evidence != (GENUS,)
    floer.__globals__["_computed"].cache_clear()


def test_only_three_knots_are_fibered_of_genus_one():
    pytest.importorskip("knot_floer_homology")
    found = {
        name
        for name, word in KNOTS.items()
        if name[0] != "L" and name != "0_1" and of_least_genus(floer(braid_diagram(word)))
    }
    assert found == {"3_1", "4_1"}
    long = braid_diagram((*braid_word("3_1"), *[letter for k in range(5) for letter in (2, -2)]))
    assert type_of_diagram(long).names in (("3_1",), ())
    assert floer(braid_diagram(connected_sum(KNOTS["3_1"], KNOTS["3_1"]))).genus == 2
