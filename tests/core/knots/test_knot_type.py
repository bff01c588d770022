"""What polygons are called, and how surely."""

import re
import sys

import numpy as np
import pytest
from families import family
from hard_curves import hard_unknot, lattice_closure
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.knots import HARD_UNKNOTS, KNOTS, KnotType, braid_closure, knot, knot_type, scramble, smooth_knot
from mobius_flow.core.knots.diagrams import simplifying
from mobius_flow.core.knots.diagrams.codes import diagram_from_code
from mobius_flow.core.knots.knot_type import ALEXANDER, DOUBLED, JONES, Effort, type_of_diagram
from mobius_flow.core.knots.names import AMPHICHEIRAL

# The one prime knot to ten crossings whose mirror image has the same invariants of all those that are computed.
UNTOLD = {"10_71": ("10_71", "m10_71"), "m10_71": ("10_71", "m10_71")}


@pytest.fixture(autouse=True)
def _without_snappy(monkeypatch):
    """Its census knows larger knots; see `test_exterior`."""
    monkeypatch.setitem(sys.modules, "snappy", None)


@pytest.mark.parametrize("name", family(KNOTS))
def test_smooth_shapes_of_the_table_and_their_mirror_images(name):
    curve = smooth_knot(name)
    for mirror, expected in ((1.0, name), (-1.0, name if name in AMPHICHEIRAL else f"m{name}")):
        found = knot_type(curve.with_vertices(curve.vertices * [1.0, 1.0, mirror]))
        assert found.names == UNTOLD.get(expected, (expected,))
        assert found.proved


TREFOIL = knot("3_1")
CURVES = {
    "3_1#3_1": knot("granny"),
    "3_1#m3_1": knot("square"),
    "4_1#4_1#m5_2": knot("m5_2#4_1#4_1"),
    "8_19#10_161": knot("8_19#10_161"),
    "L2a1#3_1": knot("3_1#hopf"),
    "L2a1#L2a1": knot("braid(1,1,2,2)"),
    "L2a1 ⊔ 3_1": knot("braid(1,1,3,3,3)"),
    "unknot ⊔ unknot": knot("braid(1,3)"),
    "8_19": knot("T(3,4)"),
    "mL4a1": knot("T(2,-4)"),
    "unknot": knot("0_1#0_1"),
    "unknot, of thousands of crossings": hard_unknot(120, 3),
    "8_20, whose edges hide each other": lattice_closure(KNOTS["8_20"]),
    # 8_8 and 10_129 have one Jones and one Alexander polynomial; their doubles have not
    "8_8, stabilised": braid_closure((*KNOTS["8_8"], max(map(abs, KNOTS["8_8"])) + 1)),
    "10_129": smooth_knot("10_129"),
} | {
    f"3_1, of size {size}": TREFOIL.with_vertices(TREFOIL.vertices * (size / np.abs(TREFOIL.vertices).max()))
    for size in (1e-300, 1e-160, 1e160, 1e308)
}


@pytest.mark.parametrize("told", CURVES)
def test_sums_parts_that_come_apart_and_curves_that_are_hard_to_read(told):
    found = knot_type(CURVES[told])
    assert str(found) == told.partition(",")[0]
    assert found.proved


@pytest.mark.slow
@pytest.mark.parametrize("name", ["0_1", "3_1", "m5_1", "7_7", "8_19", "10_132", "L5a1", "mL7a6"])
@pytest.mark.parametrize("seed", [1, 3])
def test_scrambled_curves(name, seed):
    found = knot_type(scramble(knot(name, 150), seed))
    assert found.names == (name,)
    assert found.proved


@pytest.mark.parametrize("name", HARD_UNKNOTS)
def test_hard_unknots(name):
    found = knot_type(knot(name))
    assert str(found) == "unknot"
    assert found.sentence == "unknot (proved by a diagram without crossings)"


def test_a_knot_beyond_the_table_is_not_called_by_the_name_of_one_with_its_polynomials():
    """11n_37 has the Jones and Alexander polynomials of 10_155; those of their doubles are different."""
    found = type_of_diagram(diagram_from_code("DT[kakCKeAhbjidfg.11100011100]"))
    assert found.names == ()
    assert DOUBLED in found.evidence


def test_that_a_part_has_no_crossings_is_no_evidence_for_others():
    found = type_of_diagram(diagram_from_code("Gauss: O1+U2+O3+U1+O2+U3+ / []"))
    assert found.names == ("0_1 ⊔ 3_1",)
    assert found.evidence == (JONES, ALEXANDER)


def test_types_beyond_the_table_are_not_told():
    for name, polynomial in (("T(3,7)", "[1, -1, 0, 1,"), ("T(2,13)", "[1, -1, 1, -1,")):
        found = knot_type(knot(name))
        assert found.names == ()
        assert not found.proved
        assert str(found) == "not identified"
        assert found.sentence.startswith(f"not identified: Alexander polynomial {polynomial}")
    assert found.diagram.crossings == 13


@pytest.mark.parametrize(
    ("step", "dimension", "ends", "told"),
    [
        (1, 3, (), "not identified: the curve has 20,001 vertices, more than 20,000"),
        (1000, 2, (), "none: only curves in space have a knot type, and this one is in dimension 2"),
        (1000, 3, (7,), "none: only closed curves have a knot type, and this one is open"),
        (1000, 3, (7, 14), "none: only closed curves have a knot type, and some parts of this one are open"),
    ],
)
def test_why_a_curve_has_no_type(step, dimension, ends, told):
    angle = np.linspace(0.0, 2.0 * np.pi, Effort().vertices + 1)
    circle = np.column_stack([np.cos(angle), np.sin(angle), np.sin(2 * angle)])[::step, :dimension]
    sizes = np.diff([0, *ends[:-1], len(circle)]).tolist()
    closed = [not ends] + [True] * (len(sizes) - 1)
    found = knot_type(Curve(circle, Mesh(sizes, closed)))
    assert found == KnotType((), False, None, (), told)
    assert found.sentence == told


def test_tangles_are_given_up_after_a_bounded_amount_of_work(monkeypatch):
    visited = 0

    def counting(view):
        nonlocal visited
        for diagram in simplifying(view):
            visited += diagram.crossings
            yield diagram

    monkeypatch.setattr(sys.modules[KnotType.__module__], "simplifying", counting)
    tangle = Curve(np.random.default_rng(1).normal(size=(200, 3)))  # of 3768 crossings at first
    found = knot_type(tangle, Effort(work=20_000))
    assert 20_000 < visited < 24_000
    assert str(found) == "not identified"
    assert re.fullmatch(r"not identified: \d,\d{3} crossings are left after .* allowed", found.sentence)
    # what is simplified from one side counts, however little is left for others
    assert str(knot_type(scramble(knot("4_1"), 1, moves=300), Effort(work=visited // 50))) == "4_1"


def test_invariants():
    found = knot_type(knot("4_1"))
    assert found.alexander == (-1, 3, -1)
    assert found.determinant == 5
    assert found.jones == {-4: 1, -2: -1, 0: 1, 2: -1, 4: 1}
    link = knot_type(knot("hopf"))
    assert link.alexander is None
    assert link.determinant is None
