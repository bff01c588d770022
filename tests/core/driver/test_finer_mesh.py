"""By default a run ends on a mesh that resolves what it ends at: its energy is that of the smooth curve."""

from itertools import pairwise
from types import MappingProxyType

import numpy as np
import pytest
from changed_moves import change
from families import family
from mobius_flow.core import METHODS, Curve, Objective, RelaxOptions, Status, Task, minimize, relax
from mobius_flow.core.curve import Mesh
from mobius_flow.core.driver.moves import FinerMesh
from mobius_flow.core.energies import ENERGIES
from mobius_flow.core.knots import knot
from shapes import hopf_link, lattice_knot, regular_polygon, torus_trefoil
from tasks import proved
from torus_energies import torus_knot_minimum

SMOOTH = {"5_1": torus_knot_minimum(2, 5), "6_2": 172.0607, "7_6": 207.2577}
"""Minima of smooth curves, those beside the torus knot by extrapolation; see docs/accuracy.md."""


def recorded(curve, **options):
    """A run's result, and its curve on each of its meshes when that was new."""
    curves: list[Curve] = []

    def note(iterate):
        if not iterate.path:
            curves.append(iterate.curve)

    return minimize(curve, RelaxOptions(**options), note), curves


@pytest.mark.parametrize(
    "name", ["5_1", *(pytest.param(each, marks=pytest.mark.slow) for each in SMOOTH if each != "5_1")]
)
def test_default_options_end_near_the_smooth_minimum(name):
    """Within 0.1 %; on the mesh they begin with 5_1 ends 0.9 % above it, 6_2 0.6 % and 7_6 1.1 %."""
    result, curves = recorded(lattice_knot(name))
    assert result.status is Status.CONVERGED
    assert result.certified
    assert 0.0 < result.final_energy / SMOOTH[name] - 1.0 < 1e-3
    assert Objective().barrier.value(result.curve) == pytest.approx(0, abs=1e-3)
    assert len(curves[0]) < len(curves[-1]) < 2 * len(curves[0])


def test_changes_of_mesh_are_in_the_certificate_and_told():
    """Vertices are put on edges and do not move, and with fewer asked for they are not enough."""
    result, iterates = proved(lattice_knot("3_1"), vertices=40, mesh="finer")
    k = next(k for k, each in enumerate(iterates) if k and not each.path)
    before, after = (each.curve.vertices for each in iterates[k - 1 : k + 1])
    assert len(before) == 40
    assert {tuple(vertex) for vertex in before} < {tuple(vertex) for vertex in after}
    assert result.last.edge_length_error < 1e-6
    assert result.final_energy == pytest.approx(torus_knot_minimum(2, 3), rel=1e-2)
    assert [phase.vertices for phase in result.phases] == [len(each.curve) for each in iterates if not each.path]
    assert sum(phase.iterations for phase in result.phases) == len(result.energies) - 1
    assert sum(phase.seconds for phase in result.phases) == pytest.approx(result.seconds)
    assert result.report()["phases"] == [vars(phase) for phase in result.phases]


def test_the_bends_of_a_resolved_curve_get_more_vertices_until_its_energy_is_exact(monkeypatch):
    """Strands of T(2, 7) are far from each other, and on the first mesh it ends 0.18 % above the smooth minimum."""
    least = torus_knot_minimum(2, 7)
    for accuracy, meshes in ((1e-3, 2), (2e-3, 1)):
        change(monkeypatch, FinerMesh, accuracy=accuracy)
        result, curves = recorded(knot("7_1"))
        assert len(curves) == meshes
        assert 0.5 * accuracy < result.final_energy / least - 1.0 < accuracy
        assert len(result.curve) < 2 * len(curves[0])


def left(curve, **options):
    """The last iterate on a run's first mesh, and the first one on its second."""
    for before, after in pairwise(relax(curve, RelaxOptions(**options))):
        if not after.path:
            return before, after
    raise AssertionError("the mesh has not changed")


LEFT_OUT = ("flow-l2", "flow-h2", "paper")  # two take thousands of steps, and the last one's mesh stays
METHODICAL = [{"method": name} for name in METHODS if name not in LEFT_OUT]


@pytest.mark.parametrize("options", [*({"energy": name} for name in ENERGIES), *family(METHODICAL, every=5)], ids=str)
def test_a_mesh_is_left_when_what_is_still_to_gain_is_small_against_its_error(options):
    before, after = left(lattice_knot("3_1"), vertices=40, mesh="finer", tolerance=1e-6, **options)
    assert len(after.curve) > len(before.curve) == 40
    assert before.gradient_norm > 1e-3 * np.sqrt(before.energy)
    assert still_to_gain(before, options) < 2 * FinerMesh.share * abs(after.energy - before.energy)


def test_the_share_is_one_of_the_error(monkeypatch):
    change(monkeypatch, FinerMesh, share=0.5)
    before, after = left(lattice_knot("3_1"), vertices=40, mesh="finer")
    assert still_to_gain(before) < 0.5 * (after.energy - before.energy)


def still_to_gain(iterate, options=MappingProxyType({})):
    """How far above the end of a run on its mesh it is."""
    energy, vertices = options.get("energy", "moebius"), len(iterate.curve)
    resting = RelaxOptions(energy=energy, tolerance=1e-6, mesh="fixed", vertices=vertices, edge_lengths="keep")
    return iterate.energy - minimize(iterate.curve, resting).energies[-1]


@pytest.mark.parametrize(
    ("curve", "options", "is_coarse"),
    [
        (regular_polygon(60), {}, False),  # no strands are near
        (torus_trefoil(200), {}, False),
        (hopf_link(100), {}, False),
        (lattice_knot("5_1"), {"vertices": 60}, True),
        (lattice_knot("5_1"), {"mesh": "fixed"}, True),
    ],
    ids=["circle", "trefoil", "link", "vertices", "mesh"],
)
def test_where_a_mesh_suffices_or_is_asked_for_it_stays(curve, options, is_coarse):
    result, curves = recorded(curve, **options)
    assert len(curves) == 1
    assert result.status is Status.CONVERGED
    assert ("closer than this mesh resolves" in result.message) is is_coarse


def test_a_run_that_is_about_to_end_keeps_its_mesh(monkeypatch):
    """The curve would end with corners where edges were split."""
    change(monkeypatch, FinerMesh, share=1e-9)  # not before it converges
    coarse = {"vertices": 40, "tolerance": 1e-3}
    steps = len(recorded(lattice_knot("3_1"), **coarse)[0].energies) - 1
    for left, meshes in ((FinerMesh.min_iterations - 1, 1), (FinerMesh.min_iterations, 2)):
        options = coarse | {"mesh": "finer", "max_iterations": steps + left}
        assert len(recorded(lattice_knot("3_1"), **options)[1]) == meshes


@pytest.mark.parametrize(("finest", "count"), [(1, 40), (80, 80)])
def test_there_are_never_more_than_there_is_time_for(finest, count, monkeypatch):
    """What is not resolved by as many is said to be so."""
    change(monkeypatch, FinerMesh, most=finest)
    result, _ = recorded(lattice_knot("3_1"), vertices=40, mesh="finer", tolerance=1e-3)
    assert len(result.curve) == count
    assert result.status is Status.CONVERGED
    unresolved = Objective().barrier.value(result.curve) < -1e-3
    assert ("closer than this mesh resolves" in result.message) == unresolved == (count == 40)


@pytest.mark.parametrize("gap", [1e-4, 1e-9])
def test_ends_that_nearly_touch_are_held_with_few_vertices(gap):
    """No mesh resolves the gap between two pins; thousands of vertices were put around it, and memory ran out."""
    arc = regular_polygon(24).vertices
    arc = Curve(np.vstack([arc, arc[0] + [0.0, 0.0, gap]]), Mesh((25,), (False,)))
    result = minimize(Task(curve=arc, pins=(0, 24)), RelaxOptions(vertices=100, tolerance=1e-3))
    assert result.status is Status.CONVERGED
    assert "closer than this mesh resolves" in result.message
    assert len(result.curve) < 1000
