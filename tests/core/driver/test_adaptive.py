"""Adaptive meshes: neighbours stay nearer than strands, and the changes of mesh are inside the proof."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from mobius_flow.core import Curve, RelaxOptions, Status, minimize, relax
from mobius_flow.core.curve.refine import SPLIT, Resolution, collapsed, graded_spacing, onto_chords, superfluous
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run
from mobius_flow.core.knots import knot
from shapes import hopf_link, lattice_knot, regular_polygon, torus_trefoil
from tasks import proved

RULE = Resolution(200)


def near_strands(gap):
    """A long thin loop with a bulge: two strands ``gap`` apart."""
    x = np.linspace(0, 4, 60)
    upper = np.stack([x, gap * np.ones_like(x), 0 * x], axis=1)
    lower = np.stack([x[::-1], -gap * np.ones_like(x), 0 * x], axis=1)
    t = np.linspace(np.pi / 2, -np.pi / 2, 20)[1:-1]
    end = np.stack([4.0 + np.cos(t), np.sin(t), 0 * t], axis=1)
    return Curve(np.concatenate([upper, end, lower, np.stack([-np.cos(t), -np.sin(t), 0 * t], axis=1)]))


def test_spacing_follows_gaps_and_obstacles_and_is_graded():
    curve = near_strands(0.01)
    spacing = graded_spacing(curve, RULE)
    middle = (curve.vertices[:, 0] > 1) & (curve.vertices[:, 0] < 3)
    assert spacing[middle].max() < 0.03
    ratios = spacing / spacing[curve.mesh.previous]
    assert ratios.max() <= 1.3 * (1 + 1e-12)
    assert ratios.min() >= 1 / 1.3 * (1 - 1e-12)
    # two edges are to fit in between the curve and a wall
    curve = regular_polygon(200)
    rule = replace(RULE, clearance=lambda each: 0.005 + np.abs(each.midpoints[:, 0] - 1.0))
    spacing, plain = graded_spacing(curve, rule), graded_spacing(curve, RULE)
    assert (spacing <= 0.5 * rule.clearance(curve) * (1 + 1e-12)).all()
    assert spacing[100] == pytest.approx(plain[100])
    assert (spacing / spacing[curve.mesh.previous]).max() <= 1.3 * (1 + 1e-12)


def test_remesh_reaches_the_rule():
    curve = near_strands(0.01)
    spacing = graded_spacing(curve, RULE)
    chosen = superfluous(curve, spacing)
    assert (curve.edge_lengths > SPLIT * spacing).any()
    fine = collapsed(onto_chords(curve, chosen), chosen, spacing)
    assert (fine.edge_lengths <= SPLIT * 1.01 * graded_spacing(fine, RULE)).all()
    assert fine.length == pytest.approx(curve.length)


def test_collapse_keeps_far_vertices_and_few_per_component():
    curve = regular_polygon(900)
    spacing = graded_spacing(curve, Resolution(100))
    chosen = superfluous(curve, spacing)
    assert len(chosen) == 300
    assert (np.diff(np.concatenate([chosen, [chosen[0] + 900]])) >= 3).all()
    moved = onto_chords(curve, chosen).vertices
    kept = np.setdiff1d(np.arange(900), chosen)
    np.testing.assert_array_equal(moved[kept], curve.vertices[kept])
    chord = curve.vertices[(chosen + 1) % 900] - curve.vertices[chosen - 1]
    offset = moved[chosen] - curve.vertices[chosen - 1]
    np.testing.assert_allclose(np.linalg.norm(np.cross(chord, offset), axis=1), 0, atol=1e-15)
    assert len(superfluous(regular_polygon(16), np.full(16, 100.0))) == 0


@pytest.mark.parametrize(
    ("curve", "energy"),
    [(near_strands(0.02), 4.0), (hopf_link(500), 8 + 4 * np.pi**2), (knot("culprit"), 4.0)],
    ids=["near strands", "link with too many vertices", "famous unknot"],
)
def test_adaptive_runs_are_certified_through_changes_of_mesh(curve, energy):
    result, iterates = proved(curve, mesh="adaptive")
    assert result.status is Status.CONVERGED
    assert result.energies[-1] == pytest.approx(energy, rel=5e-3)
    assert len(curve) == 56 or sum(not each.path for each in iterates) > 1


def test_another_mesh_is_another_iterate_even_of_the_same_size():
    """What has no iterate is in no trajectory; other constraints on the same mesh are no motion, and have none."""
    curve, options = torus_trefoil(60), RelaxOptions(vertices=60, mesh="adaptive")
    run = Run(start_problem(curve, options), curve, options)
    other_lengths = replace(run.problem, constraints=replace(run.problem.constraints))
    assert not list(run.enter(run.point.within(other_lengths)))
    shifted = Curve(np.roll(curve.vertices, 1, axis=0))
    assert shifted.mesh == curve.mesh
    (iterate,) = run.enter(start_problem(shifted, options).at_curve(shifted))
    assert iterate.index == 1
    np.testing.assert_array_equal(iterate.curve.vertices, shifted.vertices)


def test_changes_of_mesh_are_within_the_limit():
    """A change is an iteration, and so is the motion before it: at no limit do they make more of them."""
    curve = near_strands(0.02)
    steps = itertools.pairwise(relax(curve, RelaxOptions(mesh="adaptive")))
    before, after = next((a, b) for a, b in steps if b.curve.mesh is not a.curve.mesh)
    for limit in range(after.index - 2, after.index + 1):
        result = minimize(curve, RelaxOptions(mesh="adaptive", max_iterations=limit))
        assert result.last.index == limit
        assert result.message.startswith(f"stopped at the iteration limit ({limit})")
        assert len(result.curve) == len((after if limit == after.index else before).curve)


@pytest.mark.parametrize("mesh", [pytest.param("finer", marks=pytest.mark.slow), "adaptive"])
def test_granny_has_no_minimiser_and_is_told_so(mesh):
    """A composite knot's strands pull tight without limit: that is no convergence, and no finer mesh would help."""
    result, _ = proved(lattice_knot("3_1#3_1"), vertices=100, mesh=mesh, tolerance=3e-3)
    assert result.status is Status.STALLED
    assert "pull tight" in result.message
    assert mesh == "adaptive" or len(result.phases) == 1
