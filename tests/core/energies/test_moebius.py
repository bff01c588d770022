"""The default energy: its known values, energy per length, and another program, Surface Evolver."""

import shutil
import subprocess

import numpy as np
import pytest
from mobius_flow.core import Curve, MoebiusEnergy
from mobius_flow.core.energies.moebius import moebius_by_length
from shapes import regular_polygon, torus_trefoil
from smooth_curves import SMOOTH_CURVES

ENERGY = MoebiusEnergy()
EVOLVER = shutil.which("evolver")


@pytest.mark.parametrize("n", [3, 4, 5, 6, 7, 17, 64, 301, 1000])
@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_regular_polygons_have_energy_4_and_are_critical(n, dimension):
    curve = regular_polygon(n, dimension)
    energy, derivative = ENERGY.value_and_derivative(curve)
    assert energy == pytest.approx(4, abs=1e-12)
    assert np.abs(derivative).max() < 1e-13 * n**2
    np.testing.assert_allclose(moebius_by_length(curve), 0, atol=1e-14 * n**2)
    # at a critical point the second derivative does not see motions and scalings
    spin = np.zeros_like(curve.vertices)
    spin[:, 0], spin[:, 1] = -curve.vertices[:, 1], curve.vertices[:, 0]
    for motion in (np.ones_like(curve.vertices), curve.vertices, spin):
        assert np.abs(ENERGY.hessian_product(curve, motion)).max() < 1e-13 * n**4


@pytest.mark.parametrize("n", [60, 400])
def test_energy_per_length(n):
    curve = torus_trefoil(n)
    by_length = moebius_by_length(curve)
    assert by_length @ curve.edge_lengths + 4 == pytest.approx(ENERGY.value(curve), rel=1e-12)
    np.testing.assert_allclose(4 * moebius_by_length(Curve(4 * curve.vertices)), by_length, rtol=1e-12)
    some, pairs = np.array([n - 1, 0, 7, 30]), (np.array([0, 7, 20]), np.array([30, n - 20, 40]))
    rows = ENERGY.row_energies(curve, some)
    np.testing.assert_allclose(rows, (by_length * curve.edge_lengths)[some], rtol=0, atol=1e-13 * rows.sum())
    missing = rows - MoebiusEnergy(pairs).row_energies(curve, some)
    assert np.flatnonzero(missing).tolist() == [1, 2, 3]
    assert missing[1] == pytest.approx(missing[3])


def equilateral(curve):
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


def evolver_energy(curve, folder):
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
def test_surface_evolver_agrees(name, n, tmp_path):
    curve = equilateral(SMOOTH_CURVES[name].polygon(n))
    assert MoebiusEnergy().value(curve) == pytest.approx(4 + evolver_energy(curve, tmp_path), rel=1e-10)
