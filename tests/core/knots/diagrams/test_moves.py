"""Moves keep the link, take crossings away, and find the factors of sums."""

from dataclasses import replace

import numpy as np
import pytest
from families import crossed
from hard_curves import hard_unknot
from mobius_flow.core.knots import braid_word, knot, scramble
from mobius_flow.core.knots.braids import braid_diagram
from mobius_flow.core.knots.diagrams import Diagram, factors, is_least, jones, shuffled_down, simplified, views
from mobius_flow.core.knots.diagrams.codes import diagram_from_code
from mobius_flow.core.knots.diagrams.diagram import ENDS, PIN
from mobius_flow.core.knots.diagrams.rerouting import reduced, shortened, shuffled

FACTORS = {"3_1#m5_2": [3, 5], "4_1#4_1#L2a1": [2, 4, 4], "8_19": [8]}
NAMES = ["0_1", "3_1", "m5_2", "8_19", "10_132", "L2a1", "L6a4", "L7n1", "3_1#m4_1"]


def messy(name, seed):
    return next(views(scramble(knot(name, 120), seed, moves=300), 1, seed=seed))


@pytest.mark.parametrize(("name", "seed"), crossed(NAMES, [1, 3]))
def test_every_move_keeps_type_linking_numbers_and_planarity(name, seed):
    diagram, wanted = messy(name, seed), jones(braid_diagram(braid_word(name)))
    rng = np.random.default_rng(seed)
    linking = diagram.linking_numbers
    diagram = reduced(diagram)
    for _ in range(40):
        if not diagram.crossings:
            break
        move = shortened(diagram) or shuffled(diagram, rng)
        moved = diagram if move is None else move.after
        assert moved.crossings <= diagram.crossings
        assert moved.is_planar
        assert moved.linking_numbers == linking
        diagram = moved
    assert jones(simplified(diagram)) == wanted


def test_reidemeisters_moves_undo_loops_and_bigons_but_no_clasps():
    assert reduced(Diagram((((0, True), (0, False), (1, False), (1, True)),), (1, -1))) == Diagram(((),), ())
    bigon = Diagram((((0, True), (1, True)), ((0, False), (1, False))), (1, -1))
    assert reduced(bigon) == Diagram(((), ()), ())
    hopf = braid_diagram((1, 1))
    assert reduced(hopf) == hopf
    # two nugatory crossings look like a bigon that goes round the sphere: a strand over another one twice, equal signs
    nugatory = diagram_from_code("Gauss: O1-O2-O4-U3-O5-U4-O3-U5-U2-U1-")
    assert jones(reduced(nugatory)) == jones(nugatory) == jones(braid_diagram((-1, -1, -1)))


def test_bigons_are_undone_whichever_way_their_strands_run():
    parallel = diagram_from_code("Gauss: O1+O2- / U1+U2-")
    assert reduced(parallel) == Diagram(((), ()), ())
    opposite = diagram_from_code("Gauss: O1+O2-U5-O4-U3-O5-U2-U1+U4-O3-")  # a trefoil, a strand of it under another
    assert reduced(opposite).crossings == 3
    assert jones(reduced(opposite)) == jones(braid_diagram((-1, -1, -1)))


def test_alternating_diagrams_have_the_least_number_of_crossings():
    assert is_least(braid_diagram((1, -2, 1, -2)))
    assert is_least(Diagram(((),), ()))
    assert not is_least(braid_diagram((1, 2, 1, 2, 1, 2, 1, 2)))
    trefoil = braid_diagram((1, 1, 1))
    held, cut = (replace(trefoil, passes=((place, *trefoil.passes[0]),)) for place in (PIN, ENDS))
    assert is_least(held)
    assert not is_least(cut)


def test_faces_tell_what_is_planar_and_pieces_what_no_crossing_joins():
    trefoil = braid_diagram((1, 1, 1))
    assert len(trefoil.faces) == 5
    assert trefoil.is_planar
    assert not Diagram(trefoil.passes, (1, 1, -1)).is_planar
    whole = braid_diagram((1, 1, 3, 3, 3))
    assert sorted((len(piece.passes), piece.crossings) for piece in whole.pieces()) == [(1, 3), (2, 2)]
    assert [piece.passes for piece in Diagram(((), ()), ()).pieces()] == [((),), ((),)]


@pytest.mark.parametrize("name", FACTORS)
def test_factors_are_found_and_hard_unknots_lose_all_crossings(name):
    (piece,) = simplified(messy(name, 3)).pieces()
    assert sorted(factor.crossings for factor in factors(piece)) == FACTORS[name]
    diagram = next(views(hard_unknot(80, len(name)), 1))
    assert diagram.crossings > 60
    assert shuffled_down(simplified(diagram), is_least).crossings == 0
