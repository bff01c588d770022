"""The inputs that lie beside the project are read as the knots that their names say."""

from pathlib import Path

import numpy as np
import pytest
from knot_diagrams import linking_number
from knot_type import UNKNOT, knot_invariants
from mobius_flow.core.io import read_curve
from mobius_flow.core.knots import knot

INPUTS = Path(__file__).parents[3].parent / "shared" / "knots"
FILES = sorted(path for path in INPUTS.glob("*") if path.suffix != ".md") if INPUTS.is_dir() else []


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_type(path: Path) -> None:
    curve = read_curve(path)
    if path.stem == "link_hopf":
        assert abs(linking_number(*curve.components)) == 1
        return
    name = path.stem.removeprefix("granny_").replace("+", "#")
    found = knot_invariants(curve.vertices)
    if name.startswith(("unknot", "freedman")):
        assert found == UNKNOT
    else:
        either = [knot_invariants(knot(name).vertices * np.array([1, 1, z])) for z in (1, -1)]
        assert found in either
