"""The driver: what it yields, how it ends, and that it does not care for units or place."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from changed_moves import change
from families import crossed, family
from mobius_flow.core import (
    METHODS,
    Curve,
    CurveError,
    MobiusFlowError,
    Objective,
    OptionError,
    RelaxOptions,
    Status,
    Trajectory,
    WithOutcome,
    minimize,
    read_curve,
    relax,
    write_curve,
)
from mobius_flow.core.collision import is_free
from mobius_flow.core.curve import refine
from mobius_flow.core.driver.info import measure
from mobius_flow.core.driver.moves import CoarseStart
from mobius_flow.core.energies import ENERGIES
from mobius_flow.core.knots import knot
from mobius_flow.core.solve.metrics import MoebiusMetric
from mobius_flow.lab.compare.comparison import compare
from shapes import hopf_link, lattice_knot, regular_polygon, torus_trefoil
from torus_energies import torus_knot_minimum

SHORT = RelaxOptions(max_iterations=5)


@pytest.fixture(scope="module")
def even_trefoil() -> Curve:
    """A trefoil of 70 equal edges, still far from its minimum."""
    result = minimize(torus_trefoil(70), RelaxOptions(max_iterations=3, vertices=70))
    assert result.last.edge_length_error < 1e-8
    return result.curve


@pytest.mark.parametrize(("method", "name"), crossed(METHODS, ["trefoil", "link"]))
def test_every_method_goes_down_feasibly_and_certified(method, name, even_trefoil):
    curve = even_trefoil if name == "trefoil" else hopf_link(40)
    iterates = list(relax(curve, RelaxOptions(method=method, max_iterations=6, vertices=len(curve))))
    energies = [iterate.energy for iterate in iterates]
    if method != "penalty-nesterov":  # momentum may overshoot
        assert all(b < a for a, b in itertools.pairwise(energies))
    assert energies[-1] < energies[0]
    if METHODS[method].geometry.prescribes:
        assert iterates[-1].edge_length_error < 1e-8
    for before, after in itertools.pairwise(iterates):
        frames = (before.curve.vertices, *after.path)
        assert np.array_equal(frames[-1], after.curve.vertices)
        assert all(is_free(curve.mesh, a, b) for a, b in itertools.pairwise(frames))
        assert after.certified


def test_trefoil_to_its_minimum():
    result = minimize(torus_trefoil(200), RelaxOptions(vertices=200))
    assert result.status is Status.CONVERGED
    assert 0.05 < result.energies[-1] - torus_knot_minimum(2, 3) < 0.06  # the midpoint rule's error, of order N⁻²
    assert result.certified
    assert result.last.edge_length_error < 1e-7


def test_hopf_link_to_round_circles():
    result = minimize(hopf_link(100))
    assert result.status is Status.CONVERGED
    assert result.energies[-1] == pytest.approx(8 + 4 * np.pi**2, rel=1e-3)


def test_lattice_unknot_to_the_circle():
    result = minimize(knot("thistlethwaite"))
    assert result.status is Status.CONVERGED
    assert result.energies[-1] < 4.01
    assert result.certified


def test_plane_curve_to_the_circle():
    t = 2 * np.pi * np.arange(80) / 80
    radius = 1 + 0.5 * np.cos(3 * t)
    result = minimize(Curve(np.stack([radius * np.cos(t), radius * np.sin(t)], axis=1)))
    assert result.status is Status.CONVERGED
    assert result.certified
    assert result.energies[-1] == pytest.approx(4, abs=1e-3)


def test_four_dimensions_are_not_certified():
    t = 2 * np.pi * np.arange(60) / 60
    curve = Curve(np.stack([np.cos(t), np.sin(t), 0.4 * np.cos(2 * t), 0.4 * np.sin(3 * t)], axis=1))
    result = minimize(curve)
    assert not result.certified
    assert result.energies[-1] == pytest.approx(4, abs=1e-3)


@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (3.0, 1e3)])
def test_units_and_place_do_not_matter(scale, shift):
    curve = torus_trefoil(60)
    moved = curve.with_vertices(scale * curve.vertices + shift * scale)
    here, there = minimize(curve, SHORT), minimize(moved, SHORT)
    np.testing.assert_allclose(there.energies, here.energies, rtol=1e-6)
    back = (there.curve.vertices - shift * scale) / scale
    np.testing.assert_allclose(back, here.curve.vertices, atol=1e-4)


def test_length_and_barycenter_are_kept():
    curve = torus_trefoil(60)
    result = minimize(curve, RelaxOptions(max_iterations=20, vertices=60))
    assert result.curve.length == pytest.approx(curve.length, rel=1e-9)
    np.testing.assert_allclose(
        result.curve.edge_lengths @ result.curve.midpoints, curve.edge_lengths @ curve.midpoints, atol=1e-6
    )


def test_energies_are_those_of_the_iterates():
    iterates = []
    result = minimize(torus_trefoil(60), SHORT, iterates.append)
    assert [iterate.index for iterate in iterates] == list(range(6))
    for iterate in iterates:
        assert Objective().value(iterate.curve) == pytest.approx(iterate.energy, rel=1e-12)
    assert result.energies == tuple(iterate.energy for iterate in iterates)
    assert result.status is Status.ITERATION_LIMIT
    assert "iteration limit (5)" in result.message


def test_the_first_iterate_of_a_relaxed_curve_is_the_last():
    relaxation = relax(regular_polygon(200))
    assert next(relaxation).index == 0
    with pytest.raises(StopIteration) as end:
        next(relaxation)
    assert end.value.value.status is Status.CONVERGED


def test_zero_iterations():
    result = minimize(torus_trefoil(60), RelaxOptions(max_iterations=0))
    assert result.status is Status.ITERATION_LIMIT
    assert len(result.energies) == 1


def test_interrupt_keeps_the_curve_reached():
    seen = []

    def interrupt(iterate):
        seen.append(iterate)
        if iterate.index == 3:
            raise KeyboardInterrupt

    result = minimize(torus_trefoil(60), callback=interrupt)
    assert result.status is Status.INTERRUPTED
    assert result.curve is seen[-1].curve
    assert len(result.energies) == 4


def test_report_has_the_contract():
    report = minimize(torus_trefoil(60), SHORT).report()
    assert report["status"] == "iteration_limit"
    assert report["iterations"] == 5
    assert len(report["energy"]) == 6
    assert report["vertices"] == len(minimize(torus_trefoil(60), SHORT).curve)
    assert report["components"] == 1
    assert report["certified"] is True
    assert report["method"] == "lbfgs"
    assert report["final_energy"] == pytest.approx(report["energy"][-1], rel=0.2)


@pytest.mark.parametrize("offset", [0.0, 1e9, 1e12, 1e14])
def test_every_energy_is_that_of_the_curve_given_back(offset):
    """Far from the origin rounding to the user's units is felt; report and message speak of the rounded curve."""
    curve = regular_polygon(40)
    result = minimize(curve.with_vertices(offset + curve.vertices * [3, 2, 1]), RelaxOptions(vertices=60))
    about_origin = result.curve.with_vertices(result.curve.vertices - offset)
    assert result.report()["final_energy"] == pytest.approx(measure(about_origin), rel=1e-12)
    assert result.energies[-1] == pytest.approx(measure(about_origin), rel=1e-9)
    assert measure(result.curve) == result.report()["final_energy"]


def test_a_trajectory_refuses_iterates_of_another_mesh():
    first = list(relax(torus_trefoil(60), RelaxOptions(vertices=60, max_iterations=2)))
    other = list(relax(torus_trefoil(60), RelaxOptions(vertices=70, max_iterations=3)))
    trajectory = Trajectory()
    for iterate in first:
        trajectory.add(iterate)
    with pytest.raises(MobiusFlowError, match="iterate 3 does not follow the 3 iterates"):
        trajectory.add(other[3])


def test_trajectory_starts_at_the_input_and_ends_at_the_output(tmp_path):
    trajectory = Trajectory()
    result = minimize(torus_trefoil(60), SHORT, trajectory.add)
    trajectory.save(tmp_path / "t.npz")
    with np.load(tmp_path / "t.npz", allow_pickle=False) as arrays:
        assert set(arrays) == {"stage_000", "component_sizes_000"}
        assert arrays["stage_000"].shape == (6, len(result.curve), 3)
        np.testing.assert_array_equal(arrays["stage_000"][-1], result.curve.vertices)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": "magic"}, "method 'magic' is unknown; choose one of lbfgs"),
        ({"max_iterations": -1}, "max_iterations is -1"),
        ({"tolerance": 0.0}, "tolerance is 0"),
        ({"tolerance": float("nan")}, "tolerance is nan"),
        ({"vertices": 2}, "vertices is 2"),
        ({"vertices": 10}, "vertices is 10, but the curve has 60 already"),
    ],
)
def test_bad_options(options, message):
    with pytest.raises(OptionError, match=message):
        relax(torus_trefoil(60), RelaxOptions(**options))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda: relax(torus_trefoil(20).vertices), "curve is of type ndarray; give a Curve"),
        (lambda: minimize([[0, 0, 0]]), "curve is of type list; give a Curve"),
        (lambda: write_curve("never.txt", [[0, 0, 0]]), "curve is of type list; give a Curve"),
        (lambda: measure(None), "curve is None; give a Curve"),
        (lambda: minimize(torus_trefoil(20), {"method": "cg"}), "options is of type dict; give a RelaxOptions"),
        (lambda: relax(torus_trefoil(20), "lbfgs"), "options is 'lbfgs'; give a RelaxOptions"),
        (lambda: refine([[0, 0, 0]]), "curve is of type list; give a Curve"),
        (lambda: Curve.from_components(3), "components are of type int; give a list of arrays"),
        (
            lambda: list(compare([[0, 0, 0]], ["cg"], RelaxOptions(), 1.0)),
            "curve is of type list; give a Curve",
        ),
        (lambda: compare(torus_trefoil(20), "lbfgs", RelaxOptions(), 1.0), "methods is 'lbfgs'; give a list"),
        (
            lambda: compare(torus_trefoil(20), ["lbfgs", "cg", "lbfgs"], RelaxOptions(), 1.0),
            "methods are lbfgs,cg,lbfgs; give each of them once",
        ),
        (
            lambda: compare(torus_trefoil(20), ["cg", "cg:moe*"], RelaxOptions(), 1.0),
            "methods are cg,cg:moe.*; give each of them once",
        ),
        (lambda: compare(torus_trefoil(20), ["cg:h5"], RelaxOptions(), 1.0), "metric 'h5' is unknown"),
        (lambda: Trajectory().add(5), "iterate is 5; give an Iterate"),
        (lambda: read_curve(5), "path is 5; give a string or a path"),
        (lambda: knot(5), "name is 5; give a string"),
        (lambda: minimize(torus_trefoil(20), callback=3), "callback is 3; give a function or None"),
    ],
)
def test_arguments_of_a_wrong_type_are_named(wrong, message):
    with pytest.raises(MobiusFlowError, match=message):
        wrong()


def test_paths_are_read_only():
    *_, last = relax(torus_trefoil(40), RelaxOptions(max_iterations=1))
    with pytest.raises(ValueError, match="read-only"):
        last.path[-1][0] = 0.0


def test_a_trajectory_is_of_one_run_and_complete():
    iterates = list(relax(torus_trefoil(40), RelaxOptions(max_iterations=3)))
    trajectory = Trajectory()
    for iterate in iterates:
        trajectory.add(iterate)
    for other in (iterates[0], next(relax(torus_trefoil(50))), iterates[2], iterates[-1]):
        with pytest.raises(
            MobiusFlowError, match=f"iterate {other.index} does not follow the 4 iterates .* make a new"
        ):
            trajectory.add(other)
    assert len(trajectory.arrays()["stage_000"]) == 4
    with pytest.raises(MobiusFlowError, match="iterate 1 does not follow the 0 iterates"):
        Trajectory().add(iterates[1])


def test_curves_that_touch_are_refused_with_the_place():
    t = 2 * np.pi * np.arange(40) / 40
    eight = np.stack([np.sin(t), np.sin(2 * t), 0 * t], axis=1)
    with pytest.raises(CurveError, match="edge"):
        relax(Curve(eight))


def test_strands_a_billionth_apart():
    """Two coaxial circles that nearly touch: downhill and certified as far as the digits reach, then a reason."""
    circle = regular_polygon(40).vertices
    link = Curve.from_components([circle, circle + np.array([0, 0, 1e-9])])
    result = minimize(link, RelaxOptions(vertices=80, max_iterations=8))
    assert np.isfinite(result.energies).all()
    assert result.energies[-1] < result.energies[0]
    assert result.certified
    assert result.status is not Status.CONVERGED
    assert result.message


def test_triangles():
    result = minimize(Curve([[0, 0, 0], [1, 0, 0], [0, 1, 0]]))
    assert result.status is Status.CONVERGED
    assert result.energies[-1] == pytest.approx(4, abs=1e-4)


@pytest.mark.parametrize("seed", family([1, 5, 6]))
def test_noisy_circles_do_not_crumple(seed):
    """Beside corners of few degrees edges keep their lengths; evening them out would fold the corners."""
    circle = regular_polygon(24).vertices
    noisy = Curve(circle + 0.15 * np.random.default_rng(seed).standard_normal(circle.shape))
    result = minimize(noisy)
    assert result.status is Status.CONVERGED
    assert result.energies[-1] < 4.01
    assert result.last.edge_length_error < 1e-6


def test_a_mesh_that_cannot_be_finer_ends_the_run_in_good_order(monkeypatch):
    monkeypatch.setattr(MoebiusMetric, "most_vertices", 80)
    result = minimize(lattice_knot("3_1"), RelaxOptions(vertices=60, mesh="finer"))
    assert len(result.curve) == 60
    assert result.status is Status.CONVERGED
    assert "closer than this mesh resolves" in result.message


def test_strands_that_are_too_near_for_the_mesh_come_with_a_remedy():
    result = minimize(knot("5_1", 60), RelaxOptions(vertices=60))
    assert result.status is Status.CONVERGED
    assert "closer than this mesh resolves" in result.message
    assert "a finer one" in result.message
    assert result.final_energy > result.energies[-1] + 1  # the midpoint rule does not see them well


@pytest.mark.parametrize("name", ENERGIES)
def test_energies_know_how_they_scale(name):
    curve = torus_trefoil(60)
    energy = ENERGIES[name]
    value, larger = (energy.value_and_derivative(curve.with_vertices(s * curve.vertices))[0] for s in (1.0, 2.0))
    assert larger == pytest.approx(2.0**energy.scale_exponent * value)


def test_steps_are_compared_on_one_mesh(monkeypatch):
    """Also of curves that `relax` would begin with fewer vertices."""
    change(monkeypatch, CoarseStart, min_vertices=100)
    options = RelaxOptions(vertices=600, max_iterations=40)
    (history,) = compare(torus_trefoil(600), ["cg"], options, 60.0)
    fixed = minimize(torus_trefoil(600), replace(options, method="cg", mesh="fixed", edge_lengths="keep"))
    assert history.energy == fixed.energies
    assert history.status == fixed.status.value


def test_methods_are_compared_as_they_are():
    """L-BFGS alone, without the Newton steps that it ends with elsewhere."""
    options = RelaxOptions(vertices=60, tolerance=1e-4)
    (history,) = compare(torus_trefoil(60), ["lbfgs"], options, 60.0)
    usual = minimize(torus_trefoil(60), replace(options, mesh="fixed", edge_lengths="keep"))
    assert history.status == "converged"
    assert history.gradient_norm[-1] > 1e3 * usual.last.gradient_norm


def test_methods_are_compared_in_several_metrics():
    """Names are patterns, too; a metric that is the method's own is not said."""
    methods = ["flow-h*", "cg", "penalty-cg:h[12]", "paper:*2"]
    found = compare(torus_trefoil(20), methods, RelaxOptions(vertices=20, max_iterations=0), 60.0)
    assert [(each.label, each.kind) for each in found] == [
        ("flow-h1", "flow"),
        ("flow-h3-2", "flow"),
        ("flow-h2", "flow"),
        ("cg", "cg"),
        ("penalty-cg:h1", "penalty-cg"),
        ("penalty-cg:h2", "penalty-cg"),
        ("paper:l2", "paper"),
        ("paper:h3-2", "paper"),
        ("paper:h2", "paper"),
    ]


def test_methods_are_compared_from_lengths_that_stay():
    """Evening them out costs energy, which is no fault of a method."""
    vertices = torus_trefoil(80).vertices
    uneven = Curve(np.delete(vertices, slice(1, 40, 2), axis=0))
    (history,) = compare(uneven, ["flow-l2"], RelaxOptions(vertices=60, max_iterations=3), 60.0, (0, 3))
    np.testing.assert_allclose(history.stages[3].edge_lengths, history.stages[0].edge_lengths, rtol=1e-9)
    assert history.rises == 0


@pytest.mark.parametrize("option", [{"hops": 3}, {"mesh": "finer"}, {"stability": True}, {"time_limit": 3.0}])
def test_a_comparison_refuses_what_takes_other_steps(option):
    with pytest.raises(OptionError, match=f"{next(iter(option))}=.* has no part in a comparison of methods"):
        compare(torus_trefoil(20), ["cg"], RelaxOptions(**option), 60.0)


def test_compare_ends_at_the_time_limit():
    (history,) = compare(torus_trefoil(60), ["flow-l2"], RelaxOptions(vertices=60, tolerance=1e-12), 1e-9)
    assert history.status == "time_limit"
    assert len(history.energy) == len(history.seconds) == 1


def test_what_is_compared_has_no_penalty():
    """Edges of unequal lengths cost a penalised method much to begin with, the curve is the same."""
    vertices = torus_trefoil(80).vertices
    uneven = Curve(np.delete(vertices, slice(1, 40, 2), axis=0))
    kept, penalised = compare(uneven, ["cg", "penalty-cg"], RelaxOptions(vertices=60, max_iterations=2), 60.0)
    start = next(relax(uneven, RelaxOptions(vertices=60, method="penalty-cg")))
    assert penalised.energy[0] == pytest.approx(kept.energy[0], rel=1e-12)
    assert start.energy > penalised.energy[0] + 1.0


def test_curves_of_some_iterates_are_kept():
    (history,) = compare(torus_trefoil(40), ["cg"], RelaxOptions(vertices=40, max_iterations=3), 60.0, (0, 2, 99))
    assert list(history.stages) == [0, 2, 3]
    iterates = list(
        relax(torus_trefoil(40), RelaxOptions(method="cg", vertices=40, max_iterations=3, edge_lengths="keep"))
    )
    for k, curve in history.stages.items():
        np.testing.assert_array_equal(curve.vertices, iterates[k].curve.vertices)


def test_a_for_loop_that_keeps_the_outcome():
    run = WithOutcome(relax(torus_trefoil(60), SHORT))
    assert run.outcome is None
    assert [iterate.index for iterate in run] == list(range(6))
    assert run.outcome is not None
    assert run.outcome.status is Status.ITERATION_LIMIT


def test_an_interrupt_of_an_adaptive_run_promises_no_vertices():
    """Fewer than at the start are no coarse start here."""

    def interrupt(iterate):
        if iterate.index == 12:
            raise KeyboardInterrupt

    result = minimize(hopf_link(500), RelaxOptions(mesh="adaptive"), interrupt)
    assert len(result.curve) < 1000
    assert result.message == (
        f"interrupted: the curve reached so far is kept; it has {len(result.curve)} vertices, 1000 at the start"
    )
