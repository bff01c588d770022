"""Groups and knot Floer homology decide where polynomials do not, and only where their programs are installed."""

import sys

import numpy as np
import pytest
from mobius_flow.core.knots import HARD_UNKNOTS, KNOTS, exterior, knot, knot_type
from mobius_flow.core.knots.braids import braid_diagram
from mobius_flow.core.knots.diagrams import diagram_of
from mobius_flow.core.knots.exterior import CENSUS, GENUS, GROUP, KnotGroup, floer, group
from mobius_flow.core.knots.knot_type import type_of_diagram

GENERA = {"3_1": 1, "4_1": 1, "5_1": 2, "7_4": 1, "8_19": 3, "10_132": 2}


@pytest.mark.parametrize("name", GENERA)
def test_genera_of_the_table(name):
    pytest.importorskip("knot_floer_homology")
    assert floer(braid_diagram(KNOTS[name])).genus == GENERA[name]


@pytest.fixture
def missing(monkeypatch):
    """Say that a program is not installed."""

    def forget():
        exterior.group.cache_clear()
        exterior.floer.cache_clear()

    def missing(name):
        monkeypatch.setitem(sys.modules, name, None)
        forget()

    forget()
    yield missing
    forget()


def test_unknots_are_proved_without_being_simplified(missing):
    pytest.importorskip("snappy")
    diagram = diagram_of(HARD_UNKNOTS["ochiai-1"])
    for program, evidence in (("snappy", GROUP), ("knot_floer_homology", GENUS)):
        found = type_of_diagram(diagram)
        assert (found.names, found.proved, found.evidence) == (("0_1",), True, (evidence,))
        missing(program)
    assert floer(diagram) is group(diagram) is None
    assert not {GENUS, GROUP} & set(type_of_diagram(diagram).evidence)


def _abelian(relator, generator):
    return relator.count(generator) - relator.count(generator.upper())


@pytest.mark.parametrize("name", ["3_1", "4_1", "10_123", "L2a1", "L6a4"])
def test_groups_are_presented(name):
    """What is commutative of a link's group has a generator for each component (Hurewicz and Alexander)."""
    sympy = pytest.importorskip("sympy")
    pytest.importorskip("snappy")
    diagram = braid_diagram(KNOTS[name])
    found = group(diagram)
    matrix = sympy.Matrix([[_abelian(each, a) for a in found.generators] for each in found.relators])
    assert len(found.generators) - matrix.rank() == len(diagram.passes)
    exterior.group.cache_clear()
    group(braid_diagram(KNOTS["9_32"]))
    assert group(diagram) == found  # whatever was asked before
    assert str(group(braid_diagram(KNOTS["3_1"]))) == "⟨a, b | aabbb⟩"
    for without in ((), (1, 1, 3, 3), (1,) * 151):  # too small, falls apart, too large
        assert group(braid_diagram(without)) is None
    assert group(diagram_of(HARD_UNKNOTS["ochiai-1"])) == KnotGroup(("a",), ())


@pytest.mark.parametrize(
    ("name", "others"),  # the last but one is its own mirror image; of the last not even the Jones polynomial tells
    [("K11a300", ()), ("K11n34", ()), ("K12n725", ()), ("K13a4000", ()), ("K13n5000", ()), ("K12a1229", ("mK12a1229",)),
     ("K12n571", ())],
)  # fmt: skip
def test_knots_beyond_ten_crossings_have_names_of_their_mirror_images_too(name, others):
    snappy = pytest.importorskip("snappy")
    link = snappy.Link(name)
    for each, expected in ((link, name), (link.mirror(), name if others else f"m{name}")):
        curve = knot(str([list(map(int, edges)) for edges in each.PD_code()]))
        found = knot_type(curve)
        assert (found.names, found.proved, found.evidence) == ((expected,), False, (CENSUS,))


@pytest.mark.slow
def test_two_hundred_knots_beyond_ten_crossings():
    snappy = pytest.importorskip("snappy")
    rng = np.random.default_rng(20)
    for kind, last in (("K11a", 366), ("K11n", 185), ("K12a", 1287), ("K12n", 888), ("K13a", 4877), ("K13n", 4500)):
        for number in rng.integers(1, last, size=34, endpoint=True):
            name = f"{kind}{number}"
            code = [list(map(int, edges)) for edges in snappy.Link(name).PD_code()]
            assert knot_type(knot(str(code))).names == (name,)
