"""The numbers of knots that docs/least-energies.md tells apart, by invariants."""

import re
from pathlib import Path

import pytest
from mobius_flow.core.knots import knot, knot_type

PAGE = (Path(__file__).parents[3] / "docs" / "least-energies.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| (10_\d+) \| (\d+) \|", PAGE, re.MULTILINE)


@pytest.mark.parametrize(("name", "determinant"), ROWS)
def test_determinants_tell_which_knot_is_meant(name: str, determinant: str) -> None:
    found = knot_type(knot(name))
    assert found.names == (name,)
    assert found.determinant == int(determinant)


def test_all_numbers_in_doubt_are_there() -> None:
    assert [name for name, _ in ROWS] == [f"10_{number}" for number in (83, 86, 161, 162, 163, 164, 165)]


def test_perkos_pair_is_10_161() -> None:
    """A code of one of Perko's two diagrams."""
    assert knot_type(knot("DT: 4 12 -16 14 -18 2 8 -20 -10 -6")).names == ("10_161",)
