"""The driver: what it yields, how it ends, and that it does not care for units or place."""

import numpy as np
import pytest
from families import family
from mobius_flow.core import (
    Curve,
    MobiusFlowError,
    Objective,
    OptionError,
    RelaxOptions,
    Status,
    Trajectory,
    minimize,
    relax,
)
from mobius_flow.core.driver.info import measure
from mobius_flow.core.knots import knot
from mobius_flow.core.solve.metrics import MoebiusMetric
from shapes import hopf_link, lattice_knot, regular_polygon, torus_trefoil
from torus_energies import torus_knot_minimum

SHORT = RelaxOptions(radius="none", max_iterations=5)
t = 2 * np.pi * np.arange(80) / 80
FLOWER = (1 + 0.5 * np.cos(3 * t))[:, None] * np.stack([np.cos(t), np.sin(t)], axis=1)
FOUR = np.stack([np.cos(t), np.sin(t), 0.4 * np.cos(2 * t), 0.4 * np.sin(3 * t)], axis=1)


@pytest.mark.parametrize(
    ("curve", "energy"),
    [
        (torus_trefoil(200), torus_knot_minimum(2, 3) + 0.055),  # the midpoint rule's error, of order N⁻²
        (hopf_link(100), 8 + 4 * np.pi**2),
        (knot("thistlethwaite"), 4.0),
        (Curve(FLOWER), 4.0),
        (Curve(FOUR), 4.0),
        (Curve([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), 4.0),
    ],
    ids=["trefoil", "Hopf link", "lattice unknot", "plane", "four dimensions", "triangle"],
)
def test_curves_come_to_their_minima(curve, energy):
    result = minimize(curve, RelaxOptions(vertices=200 if len(curve) == 200 else None))
    assert result.status is Status.CONVERGED
    assert result.energies[-1] == pytest.approx(energy, rel=6e-4 if energy < 5 else 7e-5 if energy > 70 else 1e-3)
    assert result.certified == (curve.dimension < 4)
    assert result.last.edge_length_error < 1e-6


@pytest.mark.parametrize("seed", family([1, 5, 6]))
def test_noisy_circles_do_not_crumple(seed):
    """Beside corners of few degrees edges keep their lengths; evening them out would fold the corners."""
    circle = regular_polygon(24).vertices
    result = minimize(Curve(circle + 0.15 * np.random.default_rng(seed).standard_normal(circle.shape)))
    assert result.status is Status.CONVERGED
    assert result.energies[-1] < 4.01
    assert result.last.edge_length_error < 1e-6


@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (3.0, 1e3)])
def test_units_and_place_do_not_matter(scale, shift):
    curve = torus_trefoil(60)
    here, there = minimize(curve, SHORT), minimize(curve.with_vertices(scale * (curve.vertices + shift)), SHORT)
    np.testing.assert_allclose(there.energies, here.energies, rtol=1e-6)
    np.testing.assert_allclose(there.curve.vertices / scale - shift, here.curve.vertices, atol=1e-4)


@pytest.mark.parametrize("offset", [0.0, 1e9, 1e12, 1e14])
def test_every_energy_is_that_of_the_curve_given_back(offset):
    """Far from the origin rounding to the user's units is felt; report and message speak of the rounded curve."""
    curve = regular_polygon(40)
    result = minimize(curve.with_vertices(offset + curve.vertices * [3, 2, 1]), RelaxOptions(vertices=60))
    about_origin = result.curve.with_vertices(result.curve.vertices - offset)
    assert result.report()["final_energy"] == pytest.approx(measure(about_origin), rel=1e-12)
    assert result.energies[-1] == pytest.approx(measure(about_origin), rel=1e-9)
    assert measure(result.curve) == result.report()["final_energy"]


def test_iterates_result_report_and_trajectory_tell_the_same(tmp_path):
    iterates, trajectory = [], Trajectory()
    result = minimize(torus_trefoil(60), SHORT, lambda each: (iterates.append(each), trajectory.add(each)))
    assert [iterate.index for iterate in iterates] == list(range(6))
    for iterate in iterates:
        assert Objective().value(iterate.curve) == pytest.approx(iterate.energy, rel=1e-12)
    assert result.energies == tuple(iterate.energy for iterate in iterates)
    assert result.status is Status.ITERATION_LIMIT
    assert "iteration limit (5)" in result.message
    with pytest.raises(ValueError, match="read-only"):
        iterates[-1].path[-1][0] = 0.0
    report = result.report()
    assert report["final_energy"] == pytest.approx(report["energy"][-1], rel=0.2)
    told = {"status": "iteration_limit", "iterations": 5, "energy": list(result.energies), "components": 1}
    assert report == report | told | {"vertices": len(result.curve), "certified": True, "method": "lbfgs"}
    trajectory.save(tmp_path / "t.npz")
    with np.load(tmp_path / "t.npz", allow_pickle=False) as arrays:
        assert set(arrays) == {"stage_000", "component_sizes_000"}
        np.testing.assert_array_equal(arrays["stage_000"], [each.curve.vertices for each in iterates])


def test_a_trajectory_is_of_one_run_and_complete():
    def run(count):
        return list(relax(torus_trefoil(40), RelaxOptions(vertices=count, max_iterations=4)))

    iterates, other_mesh = run(40), run(50)
    trajectory = Trajectory()
    for iterate in iterates[:4]:
        trajectory.add(iterate)
    for other in (iterates[0], iterates[2], iterates[3], other_mesh[0], other_mesh[4]):
        said = f"iterate {other.index} does not follow the 4 iterates .* make a new"
        with pytest.raises(MobiusFlowError, match=said):
            trajectory.add(other)
    assert len(trajectory.arrays()["stage_000"]) == 4


def test_runs_of_no_iterations():
    result = minimize(torus_trefoil(60), RelaxOptions(max_iterations=0))
    assert (result.status, len(result.energies)) == (Status.ITERATION_LIMIT, 1)
    relaxation = relax(regular_polygon(200))
    assert next(relaxation).index == 0
    with pytest.raises(StopIteration) as end:
        next(relaxation)
    assert end.value.value.status is Status.CONVERGED


@pytest.mark.parametrize(("mesh", "at"), [("auto", 3), ("adaptive", 12)])
def test_an_interrupt_keeps_the_curve_reached(mesh, at):
    """That an adaptive mesh has fewer vertices than at the start is no promise of more."""
    seen = []

    def interrupt(iterate):
        seen.append(iterate)
        if iterate.index == at:
            raise KeyboardInterrupt

    result = minimize(hopf_link(500), RelaxOptions(mesh=mesh), interrupt)
    assert result.status is Status.INTERRUPTED
    assert result.curve is seen[-1].curve
    assert len(result.energies) == at + 1
    vertices = len(result.curve)
    fewer = f"; it has {vertices} vertices, 1000 at the start" if vertices < 1000 else ""
    assert result.message == f"interrupted: the curve reached so far is kept{fewer}"
    assert mesh == "auto" or fewer


def test_a_mesh_that_cannot_be_finer_ends_the_run_in_good_order(monkeypatch):
    monkeypatch.setattr(MoebiusMetric, "most_vertices", 80)
    result = minimize(lattice_knot("3_1"), RelaxOptions(vertices=60, mesh="finer"))
    assert len(result.curve) == 60
    assert result.status is Status.CONVERGED
    assert "closer than this mesh resolves" in result.message


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"method": "magic"}, "method 'magic' is unknown; choose one of lbfgs"),
        ({"max_iterations": -1}, "max_iterations is -1"),
        ({"tolerance": 0.0}, "tolerance is 0"),
        ({"tolerance": float("nan")}, "tolerance is nan"),
        ({"vertices": 2}, "vertices is 2"),
        ({"vertices": 10}, "vertices is 10, but the curve has 60 already"),
        ({"hops": -1}, "hops is -1"),
        ({"hops": 1.5}, "hops is 1.5"),
        ({"seed": -1}, "seed is -1"),
        ({"seed": None}, "seed is None"),
        *(({"grow": value}, "^grow ") for value in (0.0, 1e-300, -1.0, np.nan, np.inf, 1e9, "2", None)),
        ({"mesh": "finer", "edge_lengths": "keep"}, "mesh='finer' makes its own edge_lengths"),
        ({"mesh": "adaptive", "edge_lengths": "keep"}, "mesh='adaptive' makes its own edge_lengths"),
        ({"untangle": "always", "mesh": "fixed"}, "untangle='always' changes the mesh; leave it or mesh='fixed' out"),
        ({"untangle": "always", "edge_lengths": "keep"}, "untangle='always' changes the mesh; .* edge_lengths out"),
        ({"untangle": "always", "edge_lengths": (1.0,) * 9}, "untangle='always' changes the mesh"),
        ({"symmetry": "C3", "untangle": "always"}, "untangle='always' changes the mesh; leave it or symmetry out"),
        ({"symmetry": "C0"}, "^symmetry is 'C0'; give auto, or a group such as C3, D2, S4 or Th"),
        ({"symmetry": "d3"}, "^symmetry is 'd3'; give auto"),
        ({"symmetry": 3}, "^symmetry is 3; it must be a name"),
        ({"symmetry": "C3", "mesh": "adaptive"}, "symmetry keeps orbits of vertices, which mesh='adaptive' does not"),
        ({"symmetry": "C3", "edge_lengths": (1.0, 1.0)}, "symmetry makes its own vertices, to which edge_lengths do"),
        ({"balance": True, "energy": "tangent-point"}, "balance takes Möbius images, which have another tangent-point"),
        ({"method": "penalty-cg", "grow": 2.0}, "grow prescribes lengths, but method penalty-cg penalises them"),
    ],
    ids=str,
)
def test_options_that_cannot_be_are_refused(options, said):
    with pytest.raises(OptionError, match=said):
        relax(torus_trefoil(60), RelaxOptions(**options))
