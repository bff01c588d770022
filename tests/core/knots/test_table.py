"""Every knot of the table has the type its name says, checked from the coordinates and from the word."""

from collections import defaultdict

import pytest
from braid_words import burau_alexander
from families import family
from jones import jones
from knot_diagrams import pairwise_linking, simplified
from knot_type import UNKNOT, knot_invariants
from known_knots import KNOWN
from mobius_flow.core.knots import KNOTS, knot, smooth_knot
from mobius_flow.core.knots.braids import braid_diagram
from mobius_flow.core.knots.diagrams import diagram_of, normalized_bracket
from mobius_flow.core.knots.diagrams import jones as quick_jones
from mobius_flow.core.knots.names import ROLFSEN
from spherogram import Link

# Pairs with the same knot Floer homology and the same Jones polynomial; everything else is told apart.
TWINS = [{"8_8", "10_129"}, {"8_16", "10_156"}, {"10_25", "10_56"}, {"10_40", "10_103"}]

LINKS = [name for name in KNOTS if name[0] == "L"]
KNOTTED = {"L7a2", "L7a3", "L7n1", "L7n2"}  # links with a trefoil among their components


def test_the_table_has_all_prime_knots_to_ten_crossings():
    counts = defaultdict(int)
    for name in KNOTS:
        if name[0] != "L":
            counts[int(name.split("_")[0])] += 1
    # The numbers of prime knots, OEIS A002863, and the unknot.
    assert counts == {0: 1, 3: 1, 4: 1, 5: 2, 6: 3, 7: 7, 8: 21, 9: 49, 10: 165}
    assert set(KNOTS) - set(LINKS) == set(KNOWN)


@pytest.mark.parametrize("name", family(KNOWN))
def test_knot_type_of_the_polygon(name):
    for curve in (knot(name), smooth_knot(name)):
        found = knot_invariants(curve.vertices)
        assert (found.genus, found.fibered, found.tau, found.alexander) == KNOWN[name][:4]
        assert jones(simplified(curve.components)) == KNOWN[name].jones


@pytest.mark.slow
def test_polynomials_of_words_and_polygons_tell_all_but_four_pairs_apart():
    groups = defaultdict(set)
    for name in KNOWN:
        known, word = KNOWN[name], KNOTS[name]
        assert burau_alexander(word, max(map(abs, word), default=0) + 1) == known.alexander
        either = min(sorted(known.jones.items()), sorted((-k, c) for k, c in known.jones.items()))
        groups[known.genus, known.fibered, abs(known.tau), known.alexander, tuple(either)].add(name)
    assert [group for group in groups.values() if len(group) > 1] == TWINS


@pytest.mark.parametrize("name", LINKS)
def test_links(name):
    ours, theirs = braid_diagram(KNOTS[name]), diagram_of(Link(name).PD_code())
    for link in (knot(name), smooth_knot(name)):
        assert tuple(pairwise_linking(link.components).values()) == ours.linking_numbers
        assert jones(simplified(link.components)) == quick_jones(ours)
        assert sum(knot_invariants(part) != UNKNOT for part in link.components) == (name in KNOTTED)
    assert normalized_bracket(ours, ours.own_writhe) == normalized_bracket(theirs, theirs.own_writhe)
    assert sorted(map(abs, ours.linking_numbers)) == sorted(map(abs, theirs.linking_numbers))
    assert len(ours.passes) == len(theirs.passes)


def test_rolfsens_names_count_crossings_and_components():
    counts = defaultdict(int)
    for rolfsen, name in ROLFSEN.items():
        crossings, components = rolfsen.split("_")[0].split("^")
        assert name[1] == crossings
        assert len(braid_diagram(KNOTS[name]).passes) == int(components)
        counts[rolfsen.split("_")[0]] += 1
    assert counts == {"2^2": 1, "4^2": 1, "5^2": 1, "6^2": 3, "6^3": 3, "7^2": 8, "7^3": 1}
    assert set(ROLFSEN.values()) == set(LINKS)
    # Determinants of two-bridge links from Conway's notation: 33, 222 and 412, 3112, 232.
    for rolfsen, determinant in (("6^2_2", 10), ("6^2_3", 12), ("7^2_1", 14), ("7^2_2", 18), ("7^2_3", 16)):
        assert sum(map(abs, quick_jones(braid_diagram(KNOTS[ROLFSEN[rolfsen]])).values())) == determinant  # alternating
