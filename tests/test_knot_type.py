"""The tests' own instruments have the conventions of tables."""

from jones import jones
from knot_diagrams import diagram, linking_number, pairwise_linking, simplified
from mobius_flow.core.knots import knot

TREFOIL = {2: 1, 6: 1, 8: -1}


def test_the_jones_polynomial_is_in_the_convention_of_tables():
    assert jones(simplified([knot("3_1").vertices])) == TREFOIL
    assert jones(simplified([knot("m3_1").vertices])) == {-power: c for power, c in TREFOIL.items()}
    assert jones(simplified([knot("0_1").vertices])) == {0: 1}


def test_components_apart_count_as_loops():
    circle = knot("0_1", 30).vertices
    apart = [circle, circle + 5.0]
    assert jones(diagram(apart).link()) == jones(simplified(apart)) == {-1: -1, 1: -1}
    with_trefoil = jones(simplified([knot("3_1", 60).vertices, circle + 5.0]))
    assert with_trefoil == {1: -1, 3: -1, 5: -1, 9: 1}  # (t + t³ − t⁴)(−t^½ − t^−½)


def test_linking_numbers_change_sign_with_orientation_and_mirror_image():
    a, b = knot("T(2,6)").components
    assert linking_number(a, b) == 3
    assert linking_number(a[::-1], b) == -3
    assert linking_number(a * [1, 1, -1], b * [1, 1, -1]) == -3
    assert pairwise_linking([a, b, a + 50.0]) == {(0, 1): 3, (0, 2): 0, (1, 2): 0}
