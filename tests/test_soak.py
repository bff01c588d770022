"""A few dozen of the random flows of benchmarks/soak.py among obstacles, with pins and open ends."""

import runpy
from pathlib import Path

import numpy as np
import pytest

SOAK = runpy.run_path(str(Path(__file__).resolve().parents[1] / "benchmarks" / "soak.py"))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(30))
def test_random_flows_in_the_world(seed: int) -> None:
    assert SOAK["flow"](np.random.default_rng([2, seed]), world=True) in ("ok", "refused")
