"""Curves of many vertices begin with fewer, and end with all."""

import itertools

import numpy as np
import pytest
from changed_moves import change
from families import family
from hard_curves import hard_unknot
from mobius_flow.core import Iterate, Outcome, RelaxOptions, Status, minimize
from mobius_flow.core.curve import refine
from mobius_flow.core.driver.moves import CoarseStart
from mobius_flow.core.driver.outcome import Rises
from mobius_flow.core.knots import knot
from shapes import regular_polygon, torus_trefoil
from tasks import proved


@pytest.fixture
def everywhere(monkeypatch):
    """Also for curves that are small enough for tests."""
    change(monkeypatch, CoarseStart, min_vertices=100)


def bent(curve):
    """Something to do."""
    return curve.with_vertices(curve.vertices + 0.1 * np.sin(3 * curve.vertices[:, ::-1]))


def relaxed(curve, **options):
    return proved(curve, **{"vertices": len(curve), "untangle": "never"} | options)[1]


@pytest.mark.usefixtures("everywhere")
@pytest.mark.parametrize(
    "curve",
    family([bent(torus_trefoil(200)), hard_unknot(20, seed=3), bent(knot("L2a1", 400))]),
    ids=["trefoil", "hard unknot", "Hopf link"],
)
def test_fewer_vertices_at_first_and_all_in_the_end(curve):
    fine = refine(curve, 3 * len(curve))
    iterates = relaxed(fine)
    counts = [len(iterate.curve) for iterate in iterates]
    assert counts[0] == counts[-1] == len(fine)
    assert min(counts) < 0.7 * len(fine)
    assert iterates[-1].curve.mesh == fine.mesh
    assert iterates[-1].edge_length_error < 1e-6
    assert sum(a < b for a, b in itertools.pairwise(counts)) == 1, "all come back at once"


@pytest.mark.usefixtures("everywhere")
def test_the_same_minimum_in_fewer_steps_on_the_fine_mesh():
    curve = bent(torus_trefoil(300))
    fixed = relaxed(curve, mesh="fixed", method="cg")  # which second derivatives do not end
    iterates = relaxed(curve, method="cg")
    assert iterates[-1].energy == pytest.approx(fixed[-1].energy, rel=1e-6)
    assert sum(bool(iterate.path) for iterate in iterates if len(iterate.curve) == 300) < len(fixed)


@pytest.mark.usefixtures("everywhere")
@pytest.mark.parametrize(
    ("least", "limit"),
    [(1, 0), (1, 5), (1, 33), *((CoarseStart.min_iterations, k) for k in (1, 12, CoarseStart.min_iterations))],
)
def test_a_run_that_is_cut_short_has_all_vertices(least, limit, monkeypatch):
    """The way back is within the limit, and ends on the smooth curve: no corners of the coarse one are left."""
    change(monkeypatch, CoarseStart, min_iterations=least)
    options = RelaxOptions(vertices=300, max_iterations=limit, tolerance=1e-9, method="flow-h1")
    result = minimize(torus_trefoil(300), options)
    assert (result.status, len(result.energies), len(result.curve)) == (Status.ITERATION_LIMIT, limit + 1, 300)
    assert result.certified
    assert result.last.energy < 1.0005 * result.energies[0]


@pytest.mark.usefixtures("everywhere")
@pytest.mark.parametrize("limit", family([CoarseStart.min_iterations, 34]))
def test_a_run_that_is_cut_short_ends_on_the_constraints(limit):
    """Between strands the smooth curve with all vertices is a hundredth off."""
    result = minimize(hard_unknot(20, seed=3), RelaxOptions(vertices=600, max_iterations=limit, untangle="never"))
    assert result.message.startswith(f"stopped at the iteration limit ({limit}); changes of mesh")
    assert result.last.edge_length_error < 1e-10
    assert result.certified


def test_lengths_that_are_not_reached_at_the_limit_are_told_of():
    result = minimize(bent(torus_trefoil(300)), RelaxOptions(vertices=300, max_iterations=1))
    off = 100 * result.last.edge_length_error
    assert off > 1
    assert result.message.endswith(f"; lengths are still up to {off:.2g} % off target")


@pytest.mark.usefixtures("everywhere")
def test_few_iterations_are_all_for_untangling():
    iterates = relaxed(torus_trefoil(600), max_iterations=4)
    assert iterates[-1].energy < 0.95 * iterates[0].energy


@pytest.mark.parametrize(
    "options",
    [
        {"mesh": "fixed"},
        {"edge_lengths": "keep"},
        {"mesh": "finer"},
        pytest.param({"method": "penalty-lbfgs", "max_iterations": 40}, marks=pytest.mark.slow),
    ],
    ids=str,
)
@pytest.mark.usefixtures("everywhere")
def test_where_vertices_are_to_stay_they_do(options):
    iterates = relaxed(bent(torus_trefoil(300)), **{"max_iterations": 3} | options)
    assert {len(iterate.curve) for iterate in iterates} == {300}


@pytest.mark.usefixtures("everywhere")
@pytest.mark.parametrize("options", [{"vertices": 420}, {"mesh": "adaptive"}], ids=["coarse start", "adaptive"])
def test_rises_of_the_energy_with_the_mesh_are_told_of(options):
    iterates = []
    result = minimize(bent(torus_trefoil(420)), RelaxOptions(**options), iterates.append)
    energies, told = result.energies, []
    changed = [k for k, iterate in enumerate(iterates) if k and iterate.step_size == 0.0]
    for _, group in itertools.groupby(enumerate(changed), lambda place: place[1] - place[0]):
        first, *_, last = [k for _, k in group]
        highest = max(energies[first : last + 1])
        assert highest > max(energies[first - 1], energies[last])
        passed = " → ".join(f"{energy:.6g}" for energy in (energies[first - 1], highest, energies[last]))
        told.append(f"{passed} at iteration {last}")
    assert told
    assert result.message.endswith(f"; changes of mesh or shape raised the energy: {', '.join(told)}")


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ([[4.0, 4.5, 4.25]], "4 → 4.5 → 4.25 at iteration 3"),
        ([[5.0, 3.0, 4.0]], "5 → 3 → 4 at iteration 3"),
        ([[9.1549, 9.15490002, 9.1549]], "9.1549 → 9.15490002 → 9.1549 at iteration 3"),
        ([[9.1549, 9.15490002]], "9.1549 → 9.15490002 at iteration 3"),
        ([[4, 4.5], [3, 3.5]], "4 → 4.5 at iteration 3, 3 → 3.5 at iteration 6"),
        ([[4, 4.5], [3, 3.5], [2, 2.25], [1, 1.125]], "… 9, and in another change by 0.125"),
        ([[4, 4.5], [3, 3.5], [2, 2.25], [1, 1.125], [1, 1.0625]], "… 9, and in 2 further changes by 0.188 in total"),
    ],
)
def test_rises_are_told_one_by_one_and_further_ones_added_up(changes, told):
    curve, rises = regular_polygon(5), Rises()
    for k, energies in enumerate(changes, 1):
        iterates = [Iterate(3 * k, curve, energy, 1.0, 0.0, (), True, 0.0, "lbfgs") for energy in energies]
        for before, after in itertools.pairwise(iterates):
            rises.change(before, after)
    message = rises.summarised(Outcome(Status.CONVERGED, ("done",)), 9).message
    assert message.startswith("done; changes of mesh or shape raised the energy: ")
    assert message.endswith(told.removeprefix("…"))
