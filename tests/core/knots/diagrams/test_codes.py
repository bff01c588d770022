"""Codes of diagrams as people write them."""

import random
from itertools import product

import pytest
from mobius_flow.core import CurveError
from mobius_flow.core.knots import KNOTS
from mobius_flow.core.knots.braids import braid_diagram
from mobius_flow.core.knots.diagrams import Diagram, diagram_of, jones
from mobius_flow.core.knots.diagrams.codes import MAX_CROSSINGS, diagram_from_code, gauss_text, is_code
from mobius_flow.core.knots.diagrams.realization import realized
from spherogram import Link

TREFOILS = [
    "PD[X[1,5,2,4],X[3,1,4,6],X[5,3,6,2]]",
    "PD: 1 5 2 4; 3 1 4 6; 5 3 6 2",
    "PD = {{0,4,1,3},{2,0,3,5},{4,2,5,1}}",
    "DT: [4 6 2]",
    "DT:cacbca",
    "DT code: {-4,-6,-2}",
    "[[1,5,2,4],[3,1,4,6],[5,3,6,2]]",
    "[(0, 4, 1, 3), (2, 0, 3, 5), (4, 2, 5, 1)]",
    " [4, 6, 2]",
    "DT[cacbca]",
    "DT:[(4,6,2)]",
    "[1, -2, 3, -1, 2, -3]",
    "Gauss: 1 -2 3 -1 2 -3",
    "GaussCode[-1, 2, -3, 1, -2, 3]",
    "Gauss: O1+U2+O3+U1+O2+U3+",
    "gauss code: o7+u2+o3+u7+o2+u3+",
]
SCRAPS = ["", "1", "-", "[", "]", ",", "X", "O1+", "é", " 2"]
HOPFS = [
    "PD[X[1,3,2,4],X[3,1,4,2]]",
    "Gauss: [[1,-2],[2,-1]]",
    "Gauss: 1 -2 / 2 -1",
    "Gauss: [1 -2 | 2 -1]",
    "Gauss: 1 -2\n2 -1",
    "Gauss: O1+U2+ / U1+O2+",
    "Gauss: [O0+, U7+] / [U0+, O7+]",
    "Gauss: {{O1+,U2+},{U1+,O2+}}",
    "DT: [(4),(2)]",
    "[(4),(2)]",
    "[[1,-2],[2,-1]]",
    "{{1,3,2,4},{3,1,4,2}}",
    "DT: bbaaba",
]
HOPF = ((0, True), (1, False)), ((0, False), (1, True))


SPELLINGS = {
    **{code: (1, {2: 1, 6: 1, 8: -1}) for code in TREFOILS},
    **{code: (2, {1: -1, 5: -1}) for code in HOPFS},
    **{code: (1, {0: 1}) for code in ("PD[]", "DT: []", "Gauss: []", "Gauss: 1 -1", "PD[X[2,1,1,2]]", "DT: 2")},
}


@pytest.mark.parametrize("code", SPELLINGS)
def test_spellings_of_the_trefoil_the_hopf_link_and_unknots(code):
    assert is_code(code)
    diagram = diagram_from_code(code)
    assert (len(diagram.passes), jones(diagram)) == SPELLINGS[code]


def test_gauss_codes_come_back_with_their_circles_and_find_them_without_signs():
    for parts, signs in (((),), ()), (((), ()), ()), ((*HOPF, ()), (1, 1)), (((), *HOPF), (1, 1)), (HOPF, (-1, -1)):
        diagram = Diagram(parts, signs)
        assert diagram_from_code(gauss_text(diagram)) == diagram
    hopf = diagram_from_code("Gauss: 1 -2 / 2 -1")
    for code in ("[1 -2] / [2 -1] / []", "[] / [1 -2] / [2 -1]"):
        whole = diagram_from_code(f"Gauss: {code}")
        assert sorted(piece.crossings for piece in whole.pieces()) == [0, 2]
        assert whole.signs == hopf.signs


@pytest.mark.parametrize("name", ["K3a1", "K11n34", "K12n242", "L8n1", "L10a100"])
def test_codes_that_spherogram_and_snappy_write(name):
    link = Link(name)
    theirs = jones(diagram_of(link.PD_code()))
    parts, flips = link.DT_code(flips=True)
    for code in (link.PD_code(), link.DT_code(DT_alpha=True, flips=True), f"DT: {parts}, {flips}"):
        assert jones(diagram_from_code(str(code))) == theirs
    mirrored = {-power: c for power, c in theirs.items()}
    for code in (parts, link.DT_code(DT_alpha=True), f"DT:{parts}"):
        assert jones(diagram_from_code(str(code))) in (theirs, mirrored)


@pytest.mark.parametrize("code", ["[(4,6,8,2)]", "[(4,8,10,2,6)]", "[(6,8),(2,4)]", "[(4,8,-12,2,-14,-16,-6,-10)]"])
def test_dt_codes_are_read_as_spherogram_does(code):
    theirs = diagram_of(Link(f"DT: {code}").PD_code())
    assert jones(diagram_from_code(f"DT: {code}")) == jones(theirs)


@pytest.mark.parametrize("name", [name for name in KNOTS if name != "0_1"][::7])
def test_codes_of_braids_come_back(name):
    diagram = braid_diagram(KNOTS[name])
    assert jones(diagram_of(diagram.planar_code)) == jones(diagram)


def test_codes_without_signs_are_realized_where_any_signs_are_planar():
    random.seed(3)
    found = 0
    for _ in range(400):
        count = random.randint(1, 5)
        word = [(c, over) for c in range(count) for over in (False, True)]
        random.shuffle(word)
        cut = random.choice([0, 0, random.randint(1, 2 * count - 1)])
        passes = tuple(filter(None, (tuple(word[:cut]), tuple(word[cut:]))))
        planar = [s for s in product((1, -1), repeat=count) if Diagram(passes, s).is_planar]
        try:
            signs = realized(passes).signs
        except CurveError as error:
            refusal = str(error)
        else:
            assert signs in planar
            found += 1
            continue
        assert ("has no planar diagram" in refusal) == (not planar) or "falls apart" in refusal
    assert found > 50


@pytest.mark.parametrize(
    ("code", "said"),
    [
        ("PD[X[1,5,2,4],X[3,1,4,6],X[5,3,6]]", "crossing 3 of the planar diagram code has 3 edges"),
        ("PD[X[1,5,2,4],X[3,1,4,6],X[5,3,6,7]]", "every edge must be there twice"),
        ("PD[X[1,1,1,1]]", "4 times"),
        ("PD[X[1,4,2,5],X[3,6,4,1],X[2,5,6,3]]", "cannot be drawn in the plane"),
        ("PD[X[1,5,2,4]", "character 3 of the code: this bracket has no closing one"),
        ("PD[X[1,5,2,4]]]", "character 15 of the code: a closing bracket too many"),
        ("PD: foo", "character 5 of the code: 'foo' is neither"),
        ("PD: 1.5 2 3 4", "character 6 of the code: '.' is neither"),
        ("PD [[1,[2,3]],[3]]", "brackets of the code"),
        ("[" * 5000 + "]" * 5000, "nested more than 8 deep"),
        ("PD:\n1 2 3 4\n1111111111 2 3 4", "character 13 of the code: '1111111111' is neither"),
        ("DT: [4 6 3]", "each of 2, 4, … 6 once"),
        ("DT: zz", "letters of a DT code"),
        ("DT: cacbca.0012", "character 5 of the code: 'cacbca' is neither"),
        ("DT: cacbca.01", "3 crossings and 2 flips"),
        ("DT: [(4, 6, 8, 2), (1, 0, 0, 0)]", "with these flips has no planar diagram"),
        ("[4, 6, 3]", "its number 3 is 3"),
        ("[4, 6, 0]", "its number 3 is 0"),
        ("[1, 1, 1]", "write braids as {1,1,1}"),
        ("[[1,5,2,4],[3,1,4,6],[5,3,6,2]", "character 1 of the code: this bracket has no closing one"),
        ("[[1,5,2,4],[3,1,4,6],[5,3,6,x]]", "character 29 of the code: 'x' is neither"),
        ("DT: [4 6 2 10 12 8]", "composite"),
        ("Gauss: 1 2 1 2", "once above"),
        ("Gauss: 1 -2 -1 2", "has no planar diagram"),
        ("Gauss: [[1,-1],[2,-2]]", "falls apart"),
        ("Gauss: O1+U1-", "both signs"),
        ("Gauss: O1+O2+U1+U2+", "has no planar diagram"),
        ("Gauss: O1+Q2+", "character 11 of the code: 'Q' is neither"),
        ("Gauss: O1+U2+ 3", "3 is not a term of a signed Gauss code"),
        ("Gauss: 1 -2 / 2 -1 /", "write [] for a circle"),
        ("PD:", "the code is empty; write such as PD[X["),
        ("DT: ", "the code is empty; write such as DT: [4 6 2]"),
        ("DT: [" + " ".join(str(2 * k) for k in range(1, MAX_CROSSINGS + 2)) + "]", "at most 1000"),
        ("PD: " + "1 2 3 4 " * 1_000_000, "at most 100000"),
        ("4 6 2", "begin it with PD:, DT: or Gauss:"),
    ],
)
def test_bad_codes_are_one_sentence(code, said):
    with pytest.raises(CurveError) as caught:
        diagram_from_code(code)
    assert said in str(caught.value)
    assert len(str(caught.value)) < 250
    assert "\n" not in str(caught.value)


def test_mangled_codes_are_diagrams_or_one_sentence():
    random.seed(5)
    codes = TREFOILS + HOPFS
    for _ in range(1500):
        letters = list(random.choice(codes))
        for _ in range(random.randint(1, 4)):
            place = random.randrange(len(letters))
            letters[place : place + random.randint(0, 2)] = random.choice(SCRAPS)
        try:
            diagram = diagram_from_code("".join(letters))
        except CurveError:
            continue
        assert diagram.is_planar
