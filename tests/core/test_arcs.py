"""Relaxing arcs: they become straight, slip out of knots, and stay in place in links; all of it is proved."""

from pathlib import Path

import numpy as np
import pytest
from families import family
from mobius_flow.core import Curve, CurveError, Mesh, OptionError, RelaxOptions, Result, Status, minimize
from mobius_flow.core.descent.task import Units
from mobius_flow.core.driver.moves.links import split
from mobius_flow.core.io.trajectory import Trajectory
from mobius_flow.core.knots import knot_type, overhand
from mobius_flow.core.knots.composite import knotted_ball
from mobius_flow.core.knots.diagrams import linking_numbers, quick_invariants
from mobius_flow.core.proof import verify
from shapes import half_circle, opened, regular_polygon, straight_arc, torus_trefoil


def relaxed(tmp_path: Path, curve: Curve, **options: object) -> Result:
    """Relax, and have every leg and every change of mesh verified."""
    path = Trajectory()
    result = minimize(curve, RelaxOptions(**options), path.add)
    path.save(tmp_path / "path.npz")
    assert result.certified
    assert verify(tmp_path / "path.npz").accepted
    return result


def bend(curve: Curve) -> float:
    """Length over the distance of the ends, less 1: 0 on a straight segment."""
    return curve.length / float(np.linalg.norm(curve.vertices[-1] - curve.vertices[0])) - 1.0


@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_half_circles_become_straight(dimension: int) -> None:
    result = minimize(half_circle(30, dimension), RelaxOptions(vertices=60))
    assert result.status is Status.CONVERGED
    assert result.final_energy < 1e-6
    assert bend(result.curve) < 1e-6
    assert result.certified == (dimension < 4)


@pytest.mark.parametrize("method", family(["cg", "trust-region", "flow-h3-2", "implicit-h2", "penalty-lbfgs"], every=2))
def test_methods(tmp_path: Path, method: str) -> None:
    walk = np.cumsum(np.random.default_rng(3).normal(size=(9, 3)), axis=0)
    result = relaxed(tmp_path, opened(Curve(walk), 0), method=method, vertices=50, max_iterations=300)
    assert result.energies[0] > 10
    assert result.final_energy < 1e-3


@pytest.mark.parametrize("energy", ["edge", "moebius-k2", "tangent-point"])
def test_energies(tmp_path: Path, energy: str) -> None:
    result = relaxed(tmp_path, half_circle(20), energy=energy, vertices=50, max_iterations=300)
    assert result.status is Status.CONVERGED
    assert bend(result.curve) < 1e-4


def test_single_edges(tmp_path: Path) -> None:
    edges = Curve([[0, 0, 0], [1, 0, 0], [0, 0.1, 1], [0, 1, 1]], Mesh((2, 2), (False, False)))
    result = relaxed(tmp_path, edges, vertices=4, max_iterations=50)
    assert result.final_energy < 0.1 * result.energies[0]  # they drift apart for ever
    np.testing.assert_allclose(result.curve.edge_lengths, [1.0, 0.9])


@pytest.mark.parametrize("edges", [2, 3])
def test_short_arcs(tmp_path: Path, edges: int) -> None:
    """With so few edges that there is one pair, or none at all, that makes up the energy."""
    result = relaxed(tmp_path, half_circle(edges), vertices=edges + 1)
    assert result.status is Status.CONVERGED
    assert result.final_energy < 1e-6


def test_overhand_arcs_are_knotted() -> None:
    """Closed far away they are trefoils."""
    for vertices in (40, 120):
        points = overhand(vertices).vertices
        ends = [3 * points[end] - 2 * points[inner] for end, inner in ((-1, -5), (0, 4))]
        closed = Curve([*points, ends[0], (ends[0] + ends[1]) / 2 + [0, 40, 0], ends[1]])
        assert str(knot_type(closed)) == "3_1"


def test_overhand_arcs_slip_out(tmp_path: Path) -> None:
    result = relaxed(tmp_path, overhand(60))
    assert result.status is Status.CONVERGED
    assert result.final_energy < 1e-6
    assert bend(result.curve) < 1e-6


@pytest.mark.parametrize("mesh", ["adaptive", "finer"])
def test_meshes_that_change(tmp_path: Path, mesh: str) -> None:
    arc = overhand(40)
    result = relaxed(tmp_path, arc, mesh=mesh, max_iterations=25)
    assert result.energies[-1] < result.energies[0]
    assert result.curve.mesh.closed == (False,)


def test_coarse_starts_with_arcs(tmp_path: Path) -> None:
    result = relaxed(tmp_path, opened(torus_trefoil(900), 0), max_iterations=35)
    assert len(result.curve) == 900


@pytest.mark.slow
def test_hierarchical_solver(tmp_path: Path) -> None:
    result = relaxed(tmp_path, overhand(200), solver="hierarchical")
    assert result.status is Status.CONVERGED
    assert result.final_energy < 1e-6
    assert bend(result.curve) < 1e-6


def test_an_arc_leaves_a_ring_that_it_is_not_linked_with(tmp_path: Path) -> None:
    height = np.linspace(-1.5, 1.5, 21)
    rod = np.stack([np.full(21, 0.2), 0.1 * np.sin(height + 1.5), height], axis=1)
    curve = Curve.from_components([regular_polygon(60).vertices, rod], [True, False])
    result = relaxed(tmp_path, curve, vertices=120)
    assert result.energies[0] > 25
    assert result.status is Status.CONVERGED
    assert "unlinked parts" in result.message
    parts = result.curve.components
    middles = [part.mean(axis=0) for part in parts]
    radii = [np.linalg.norm(part - middle, axis=1).max() for part, middle in zip(parts, middles, strict=True)]
    assert np.linalg.norm(middles[1] - middles[0]) > sum(radii)  # balls around them do not meet


def test_parts_far_from_each_other_are_held(tmp_path: Path) -> None:
    arc, far = straight_arc(4).vertices, np.array([9.0, 0.0, 0.0])
    result = relaxed(tmp_path, Curve.from_components([arc, arc + far], [False, False]), vertices=40)
    assert "unlinked parts" in result.message
    assert "their own energies add up to" in result.message
    parts = split(Curve.from_components([arc, np.eye(3), arc + 9], [False, True, False]), (0, 1, 0))
    assert [part.mesh.closed for part in parts] == [(False, False), (True,)]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_random_mixtures(tmp_path: Path, seed: int) -> None:
    rng = np.random.default_rng(1000 + seed)
    closed = [bool(flag) for flag in rng.integers(0, 2, 3)]
    parts = [np.cumsum(rng.normal(size=(rng.integers(3, 8), 3)), axis=0) for _ in closed]
    method = ("lbfgs", "cg", "flow-l2", "implicit-moebius")[seed % 4]
    result = relaxed(tmp_path, Curve.from_components(parts, closed), method=method, max_iterations=5)
    assert np.isfinite(result.energies).all()
    assert np.isfinite(result.curve.vertices).all()


def test_what_only_closed_components_have() -> None:
    arc = opened(torus_trefoil(60), 0)
    for function in (quick_invariants, linking_numbers):
        with pytest.raises(CurveError, match=r"^component 1 is open; .* are for closed components$"):
            function(arc)
    assert knot_type(arc).names == ()
    assert knotted_ball(arc) is None
    with pytest.raises(CurveError, match=r"component 1 is open; Möbius images of equal energy"):
        minimize(arc, RelaxOptions(balance=True))


def test_lengths_are_one_for_each_edge(tmp_path: Path) -> None:
    arc = half_circle(5)
    result = relaxed(tmp_path, arc, edge_lengths=(1.0, 2.0, 1.0, 2.0, 1.0), vertices=6, max_iterations=200)
    np.testing.assert_allclose(result.curve.edge_lengths, [1, 2, 1, 2, 1], rtol=1e-4)
    with pytest.raises(OptionError, match=r"has 6 numbers, but the refined curve has 5 edges; .* vertices=7$"):
        minimize(arc, RelaxOptions(edge_lengths=(1.0,) * 6, vertices=6))


def test_units_of_arcs() -> None:
    arc = Curve(1e6 * half_circle(30).vertices + 1e7, Mesh((31,), (False,)))
    assert 4 <= arc.length / Units.of(arc).scale <= 8
