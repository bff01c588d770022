"""The grammar of knot names."""

from collections.abc import Callable

import numpy as np
import pytest
from knot_type import knot_invariants
from mobius_flow.core import Curve
from mobius_flow.core.errors import CurveError, MobiusFlowError
from mobius_flow.core.knots import (
    ARCS,
    HARD_UNKNOTS,
    KNOTS,
    UnknownKnotError,
    braid_word,
    knot,
    knot_names,
    lissajous_knot,
    rope,
    smooth_knot,
    spiral,
)

SAME = {
    "3_1": ["trefoil", " Trefoil  Knot ", "TREFOIL", "3_1", "braid(1,1,1)", "braid( 1, 1,+1 )", "mm3_1"],
    "4_1": ["figure-eight", "figure eight", "figure_eight", "Figure-Eight Knot", "braid(1,-2,1,-2)"],
    "L2a1": ["hopf", "Hopf link", "l2a1"],
    "L6a4": ["borromean", "Borromean rings"],
    "T(2,5)": ["torus(2,5)", "t( 2 , 5 )", "Torus(2,5)"],
    "0_1": ["unknot", "circle", "braid()", "0_1#0_1"],
    "m3_1": ["mtrefoil", "m trefoil", "braid(-1,-1,-1)"],
    "3_1#m3_1": ["square", "square knot", "trefoil # m3_1"],
}


@pytest.mark.parametrize(("name", "other"), [(name, other) for name, others in SAME.items() for other in others])
def test_other_spellings(name: str, other: str) -> None:
    assert np.array_equal(knot(name, 90).vertices, knot(other, 90).vertices)


@pytest.mark.parametrize(
    ("name", "genus", "tau"),
    [("T(2,5)", 2, 2), ("T(-2,5)", 2, -2), ("T(5,-3)", 4, -4), ("mT(3,4)", 3, -3), ("T(2,3)#5_1", 3, 3)],
)
def test_handedness(name: str, genus: int, tau: int) -> None:
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
        ("T(2,x)", "'x' in 'T(2,x)' is not a whole number"),
        (f"T(2,{'9' * 5000})", "up to 18 digits"),
        ("T[2,3]", "known are"),
        ("x" * 5000, "known are"),
    ],
)
def test_unknown_names_list_close_and_known_ones(name: str, hint: str) -> None:
    with pytest.raises(UnknownKnotError) as caught:
        knot(name)
    assert hint in str(caught.value)
    assert isinstance(caught.value, MobiusFlowError)
    assert len(str(caught.value)) < 350


@pytest.mark.parametrize(
    "name", ["T(0,3)", "T(2,99999)", "T(1000000,1000001)", "braid(0)", "braid(1,9999999)", "0_1#T(0,1)", "mT(200,300)"]
)
def test_numbers_that_are_not_allowed(name: str) -> None:
    with pytest.raises(CurveError, match=r"^(T\(\S+\) |letter|the braid has .* strands)"):
        knot(name)


def test_listed_names_are_names() -> None:
    names = knot_names()
    assert {"3_1", "L5a1", "figure-eight", "haken"} < set(names)
    no_words = {*HARD_UNKNOTS, *ARCS, "0_1", "unknot", "circle"}
    assert all(name in no_words or braid_word(name) for name in names)


@pytest.mark.parametrize("name", ["3_1", "10_123", "T(3,7)", "whitehead"])
@pytest.mark.parametrize("vertices", [-5, 0, 2, 3])
def test_too_few_vertices(name: str, vertices: int) -> None:
    with pytest.raises(CurveError, match="too few"):
        knot(name, vertices)


MAKERS = {
    "braid": lambda n: knot("3_1", n),
    "torus": lambda n: knot("T(2,3)", n),
    "diagram": lambda n: knot("goeritz", n),
    "smooth": lambda n: smooth_knot("3_1", n),
    "lissajous": lambda n: lissajous_knot((3, 2, 7), vertices=n),
    "spiral": lambda n: spiral(2.0, n),
    "rope": lambda n: rope(2.0, 0.1, n),
}


@pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS)
@pytest.mark.parametrize("vertices", [300.5, 300.0, "300"])
def test_vertices_are_counted_in_whole_numbers(make: Callable[[object], Curve], vertices: object) -> None:
    with pytest.raises(MobiusFlowError, match=f"^vertices is {vertices!r}; give a whole number"):
        make(vertices)
    assert len(make(np.int64(300))) == 300


@pytest.mark.parametrize("vertices", [90, 101, 1000])
def test_the_number_of_vertices_is_the_one_asked_for(vertices: int) -> None:
    for name in ("3_1", "T(3,3)", "whitehead", "0_1"):
        assert len(knot(name, vertices)) == vertices


def test_coarse_polygons_are_the_right_knot_or_refused() -> None:
    for name in ("3_1", "6_2", "10_124", "T(3,4)"):
        expected = knot_invariants(knot(name).vertices)
        accepted = 0
        for vertices in range(5, 60, 3):
            try:
                curve = knot(name, vertices)
            except CurveError:
                continue
            accepted += 1
            assert knot_invariants(curve.vertices) == expected
        assert accepted >= 2


def test_words_are_plain_tuples() -> None:
    assert braid_word("granny") == KNOTS["3_1"] + (2, 2, 2)
    assert braid_word("m4_1") == (-1, 2, -1, 2)


def test_too_many_vertices() -> None:
    for name, vertices in (("3_1", 10**9), ("braid(" + ",".join(["1,499"] * 9000) + ")", None)):
        with pytest.raises(CurveError, match="too many"):
            knot(name, vertices)


def test_mirror_images_of_mirror_images() -> None:
    assert braid_word("mm3_1") == braid_word("3_1") == braid_word("m m 3_1")
    assert braid_word("mmm3_1") == braid_word("m3_1")
    with pytest.raises(UnknownKnotError, match="no knot is called"):
        knot(5000 * "m")
    assert braid_word(5001 * "m" + "3_1") == braid_word("m3_1")
