"""The default energy against another program, Surface Evolver, on polygons with equal edges."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core import Curve, MoebiusEnergy
from smooth_curves import SMOOTH_CURVES

EVOLVER = shutil.which("evolver")


def equilateral(curve: Curve) -> Curve:
    """The same kind of polygon with equal edges, by Newton's method on the lengths."""
    n, edges = len(curve), np.arange(len(curve))
    for _ in range(30):
        tau = curve.edge_vectors / curve.edge_lengths[:, None]
        rows = np.zeros((n, *curve.vertices.shape))
        rows[edges, curve.mesh.tails] -= tau
        rows[edges, curve.mesh.heads] += tau
        excess = curve.edge_lengths.mean() - curve.edge_lengths
        move = np.linalg.lstsq(rows.reshape(n, -1), excess, rcond=None)[0]
        curve = curve.with_vertices(curve.vertices + move.reshape(curve.vertices.shape))
    assert np.ptp(curve.edge_lengths) < 1e-13
    return curve


def evolver_energy(curve: Curve, folder: Path) -> float:
    """What its method circle_knot_energy says."""
    mesh = curve.mesh
    lines = ["STRING", "space_dimension 3", "quantity knot energy method circle_knot_energy global", "vertices"]
    lines += [f"{k + 1} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(curve.vertices.tolist())]
    lines += ["edges"]
    lines += [f"{k + 1} {mesh.tails[k] + 1} {mesh.heads[k] + 1}" for k in range(len(curve))]
    source = folder / "knot.fe"
    source.write_text("\n".join(lines) + "\n")
    command = [str(EVOLVER), str(source)]
    script = 'printf "VALUE %20.15g\\n", knot.value\nq\nq\n'
    answer = subprocess.run(command, input=script, capture_output=True, text=True, timeout=60, check=False)
    values = [line.split()[1] for line in answer.stdout.splitlines() if line.startswith("VALUE")]
    assert len(values) == 1, answer.stdout
    return float(values[0])


@pytest.mark.skipif(EVOLVER is None, reason="Surface Evolver (evolver) is not installed")
@pytest.mark.parametrize("n", [17, 40, 120])
@pytest.mark.parametrize("name", ["wave", "trefoil", "figure-eight"])
def test_surface_evolver_agrees(name: str, n: int, tmp_path: Path) -> None:
    curve = equilateral(SMOOTH_CURVES[name].polygon(n))
    assert MoebiusEnergy().value(curve) == pytest.approx(4 + evolver_energy(curve, tmp_path), rel=1e-10)
