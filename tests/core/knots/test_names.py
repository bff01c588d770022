"""The grammar of knot names."""

import sys

import numpy as np
import pytest
from knot_type import knot_invariants
from mobius_flow.core.base.errors import CurveError, MobiusFlowError
from mobius_flow.core.knots import UnknownKnotError, braid_word, knot, knot_type, lissajous_knot, smooth_knot
from mobius_flow.core.knots.braids import braid_diagram
from mobius_flow.core.knots.diagrams import diagram_of, jones
from spherogram import Link

BRAIDS = ["{1,1,1}", "{1, 1, 1}", "BR[2, {1, 1, 1}]", "BR[{1,1,1}]", "br(2,(1,1,1))", "m{-1,-1,-1}"]
SAME = {
    "3_1": ["trefoil", " Trefoil  Knot ", "TREFOIL", "3_1", "braid(1,1,1)", "braid( 1, 1,+1 )", "mm3_1", *BRAIDS],
    "4_1": ["figure-eight", "figure eight", "figure_eight", "Figure-Eight Knot", "braid(1,-2,1,-2)"],
    "L2a1": ["hopf", "Hopf link", "l2a1"],
    "L6a4": ["borromean", "Borromean rings"],
    "T(2,5)": ["torus(2,5)", "t( 2 , 5 )", "Torus(2,5)"],
    "0_1": ["unknot", "circle", "braid()", "0_1#0_1", "{}", "BR[1, {}]"],
    "m3_1": ["mtrefoil", "m trefoil", "braid(-1,-1,-1)"],
    "3_1#m3_1": ["square", "square knot", "trefoil # m3_1", "{1,1,1}#BR[2,{-1,-1,-1}]"],
}


@pytest.mark.parametrize(("name", "other"), [(name, other) for name, others in SAME.items() for other in others])
def test_other_spellings(name, other):
    assert np.array_equal(knot(name, 90).vertices, knot(other, 90).vertices)


@pytest.mark.parametrize(
    ("name", "genus", "tau"),
    [("T(2,5)", 2, 2), ("T(-2,5)", 2, -2), ("T(5,-3)", 4, -4), ("mT(3,4)", 3, -3), ("T(2,3)#5_1", 3, 3)],
)
def test_handedness(name, genus, tau):
    found = knot_invariants(knot(name).vertices)
    assert (found.genus, found.tau) == (genus, tau)


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("trefol", "did you mean trefoil"),
        ("3_2", "did you mean 3_1"),
        ("borromaen", "borromean"),
        ("11_1", "10_165"),
        ("", "known are"),
        ("m", "known are"),
        ("#", "known are"),
        ("T(2)", "T(p,q)"),
        ("T(1,2,3)", "two numbers"),
        ("T(3,5", "no closing bracket"),
        ("3_1#braid(1,2", "no closing bracket"),
        ("braid(1,,2)", "'' in 'braid(1,,2)' is not a whole number"),
        ("braid(1;2)", "'1;2' in 'braid(1;2)' is not a whole number"),
        ("braid(1,-2,x)", "'x' in 'braid(1,-2,x)' is not a whole number"),
        ("{1,-2,x}", "'x' in '{1,-2,x}' is not a whole number"),
        ("BR[2,{1,x}]", "'x' in 'BR[2,{1,x}]' is not a whole number"),
        ("{1,1", "'{1,1' has no closing bracket"),
        ("{-1, 3, -2, 1, -3, 2}", "may be a braid or a Gauss code"),
        ("3_1#BR[3,{1,1}]", "strands without letters"),
        ("T(2,x)", "'x' in 'T(2,x)' is not a whole number"),
        (f"T(2,{'9' * 5000})", "up to 18 digits"),
        ("T[2,3]", "known are"),
        ("x" * 5000, "known are"),
    ],
)
def test_unknown_names_list_close_and_known_ones(name, hint):
    with pytest.raises(UnknownKnotError) as caught:
        knot(name)
    assert hint in str(caught.value)
    assert isinstance(caught.value, MobiusFlowError)
    assert len(str(caught.value)) < 350


@pytest.mark.parametrize("name", ["K11n34", "11n_34", "k11n34", "12a_0003", "L8n1", "L10a100"])
def test_names_of_larger_tables_are_spherograms(name):
    theirs = Link({"11n_34": "K11n34", "k11n34": "K11n34", "12a_0003": "K12a3"}.get(name, name))
    assert jones(braid_diagram(braid_word(name))) == jones(diagram_of(theirs.PD_code()))


NOT_MADE = {
    "T(0,3)": r"^T\(0,3\) ",
    "T(2,99999)": r"^T\(2,99999\) ",
    "T(1000000,1000001)": r"^T\(1000000,1000001\) ",
    "0_1#T(0,1)": r"^T\(0,1\) ",
    "mT(200,300)": r"^T\(200,300\) ",
    "braid(0)": "^letter",
    "braid(1,9999999)": "^the braid has .* strands",
    "BR[2,{1,2}]": "the braid has 2 strands, but its letters need 3",
    "braid(" + ",".join(["1,499"] * 9000) + ")": "too many",
    "plat(1,0)": "letter 2",
    "plat(1": "no closing bracket",
    "plat(a)": "whole number",
    "plat(" + ",".join("12" * 600) + ")": "at most 1000",
    "K11n999": "no knot or link is called",
    "L99a1": "no knot or link is called",
    "m11a_0": "no knot is called",
    5000 * "m": "no knot is called",
}


@pytest.mark.parametrize("name", NOT_MADE, ids=lambda name: name[:20])
def test_what_is_not_made(name):
    with pytest.raises(MobiusFlowError, match=NOT_MADE[name]):
        knot(name)


def test_larger_tables_are_an_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "spherogram", None)
    with pytest.raises(MobiusFlowError, match=r'K11n34 is in larger .* pip install spherogram \(the extra "knots"\)'):
        knot("11n_34")


# Conway's C(a, b, c, …): twists by turns of the middle strands and of those on a side, crossings alternating
CONWAY = {"3_1": (3,), "4_1": (2, 1, 1), "5_2": (3, 1, 1), "6_2": (3, 1, 2), "7_7": (2, 1, 1, 1, 2), "L4a1": (4,)}
PLATS = {
    name: ([letter for k, count in enumerate(twists) for letter in [(2, -1)[k % 2]] * count], {name, f"m{name}"})
    for name, twists in CONWAY.items()
}
PLATS |= {
    "no letter": ([], {"0_1"}),
    "a loop": ([1, 1], {"0_1"}),
    "circles": ([3, -3], {"0_1 ⊔ 0_1"}),
    "L2a1": ([2, 2], {"L2a1"}),
    "L5a1": ([2, -1, 2, -1, 2], {"L5a1"}),
    "a chain": ([2, 2, 4, 4], {"L2a1#L2a1"}),
}


@pytest.mark.parametrize("name", PLATS)
def test_rational_knots_and_others_are_plats(name):
    word, names = PLATS[name]
    found = knot_type(knot(f"plat({','.join(map(str, word))})"))
    assert found.proved
    assert set(found.names) <= names
    assert name not in CONWAY or found.diagram.crossings == sum(CONWAY[name])


MAKERS = {
    "braid": lambda n: knot("whitehead", n),
    "torus": lambda n: knot("T(3,3)", n),
    "diagram": lambda n: knot("goeritz", n),
    "smooth": lambda n: smooth_knot("3_1", n),
    "lissajous": lambda n: lissajous_knot((3, 2, 7), vertices=n),
}


@pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS)
def test_vertices_are_as_many_as_asked_for_and_counted_in_whole_numbers(make):
    for vertices in (300.5, 300.0, "300"):
        with pytest.raises(MobiusFlowError, match=f"^vertices is {vertices!r}; give a whole number"):
            make(vertices)
    for vertices in (np.int64(300), 301, 1000):
        assert len(make(vertices)) == vertices
    for vertices, said in ((-5, "too few"), (0, "too few"), (3, "too few"), (10**9, "too many")):
        with pytest.raises(CurveError, match=said):
            make(vertices)


@pytest.mark.parametrize("make", [knot, smooth_knot])
@pytest.mark.parametrize("name", ["3_1", "6_2", "10_124"])
def test_coarse_polygons_are_the_right_knot_or_refused(make, name):
    expected, accepted = knot_invariants(make(name).vertices), 0
    for vertices in range(4, 60, 5):
        try:
            curve = make(name, vertices)
        except CurveError:
            continue
        accepted += 1
        assert knot_invariants(curve.vertices) == expected
    assert 2 <= accepted < 19
