"""What every method promises on every kind of task: it goes down, keeps what it is to keep, and all of it is proved."""

from itertools import pairwise

import numpy as np
import pytest
from families import crossed
from mobius_flow.core import METHODS, Curve, Trajectory
from mobius_flow.core.curve.symmetry import Symmetry, symmetries
from mobius_flow.core.descent import problem
from mobius_flow.core.knots import smooth_knot
from shapes import hopf_link, opened, regular_polygon, torus_trefoil
from solids import box, plate
from tasks import proved

PENALISED = [name for name, method in METHODS.items() if not method.geometry.prescribes]
SADDLE = regular_polygon(32).vertices + 0.1 * np.cos(4 * np.pi * np.arange(32) / 32)[:, None] * [0, 0, 1]
WALK = np.cumsum(np.random.default_rng(3).normal(size=(9, 3)), axis=0)


@pytest.fixture
def proofs(monkeypatch):
    """The motions that are proved while a test runs, each by the bits of its ends."""
    found = set()
    prove = problem.Problem.free_motion

    def recorded(given, start, end):
        motion = prove(given, start, end)
        if motion.proved:
            found.add((start.tobytes(), end.tobytes()))
        return motion

    monkeypatch.setattr(problem.Problem, "free_motion", recorded)
    return found


def assert_written(iterates, proofs):
    """Every leg that is written was proved, bit for bit; returns how many there are."""
    trajectory = Trajectory()
    for iterate in iterates:
        trajectory.add(iterate)
    stages = [frames for name, frames in trajectory.arrays().items() if name.startswith("stage_")]
    legs = [(a.tobytes(), b.tobytes()) for frames in stages for a, b in pairwise(frames)]
    assert set(legs) <= proofs
    return len(legs)


def crooked(curve):
    """Coordinates that do not survive the way to the program's units and back."""
    vertices = curve.vertices + np.random.default_rng(83).uniform(1.0, 3.0, size=curve.dimension)
    vertices[0, 0] = 1.1e-13
    return curve.with_vertices(vertices)


BENT = crooked(torus_trefoil(48).with_vertices(torus_trefoil(48).vertices * [1.0, 1.3, 1.1]))
KINDS = {
    "knot": (crooked(torus_trefoil(36)), {}),
    "link": (hopf_link(40), {}),
    "arc": (opened(Curve(WALK), 0), {"vertices": 50}),
    "pins": (BENT, {"pins": (3, 17, 33)}),
    "pins far away": (BENT.with_vertices(BENT.vertices * 0.37 + [1e4, -3e3, 7.0]), {"pins": (3, 17, 33)}),
    # a relaxed trefoil would rise through both
    "walls": (
        torus_trefoil(40).with_vertices(torus_trefoil(40).vertices * [1.0, 1.0, 0.9]),
        {"avoid": (plate(0.95), plate(-0.95))},
    ),
    "growing": (Curve(SADDLE), {"avoid": (box(-1.5, 1.5),), "grow": 1.1, "max_iterations": 12}),
    "symmetric": (smooth_knot("3_1"), {"symmetry": "D3", "vertices": 72, "edge_lengths": "auto"}),
}


@pytest.mark.parametrize(
    ("method", "kind"),
    [each for each in crossed(METHODS, KINDS) if each.values[1] != "growing" or each.values[0] not in PENALISED],
)
def test_every_method_on_every_kind_of_task(method, kind, proofs):
    curve, settings = KINDS[kind]
    usual = {"vertices": len(curve), "mesh": "fixed", "edge_lengths": "keep", "max_iterations": 6, "untangle": "never"}
    result, iterates = proved(curve, **usual | settings, method=method)
    assert assert_written(iterates, proofs) >= 3
    energies = result.energies
    if kind == "growing":
        assert result.last.grown > 1.0
    else:
        assert energies[-1] < energies[0]
        lower = method == "penalty-nesterov" or all(b < a for a, b in pairwise(energies))  # momentum may overshoot
        assert lower or kind == "symmetric", "where edges are evened out"
    if METHODS[method].geometry.prescribes and kind != "symmetric":
        assert result.last.edge_length_error < 1e-8
    if kind == "symmetric":
        group = symmetries(result.curve, 1e-6).subgroup("D3")
        kept = Symmetry("D3", group.centre, group.matrices)
        assert [each.symmetry for each in iterates[:3]] == ["", "", "D3"]
        assert max(kept.on(each.curve).error(each.curve) for each in iterates[2:]) < 1e-10
    held = list(settings.get("pins", ()))
    assert all(np.array_equal(leg[held], curve.vertices[held]) for each in iterates for leg in each.path)


def test_without_walls_a_trefoil_goes_where_they_are():
    """Those above are about something."""
    curve, _ = KINDS["walls"]
    result, _ = proved(curve, max_iterations=6, vertices=60, mesh="fixed")
    assert np.abs(result.curve.vertices[:, 2]).max() > 1.0


# far from the origin a point that is part of a proved motion is rounded beside it
FAR_TRIANGLE = [
    [-997959080.8786148, -1002555665.0313143, -999581901.1532742],
    [-1000567769.606128, -1000452649.2921104, -1000215597.1630898],
    [-1002019986.1291473, -1000231932.3776442, -1000865213.0762749],
]


@pytest.mark.parametrize("mesh", ["fixed", "adaptive"])
@pytest.mark.parametrize("method", PENALISED)
def test_part_of_a_proved_motion_is_proved_as_it_is_rounded(method, mesh, proofs):
    rng = np.random.default_rng(17)
    shapes = [rng.normal(size=(int(rng.integers(3, 9)), 3)) for _ in range(3)]
    for curve in (Curve(FAR_TRIANGLE), *[Curve(1e6 * each + 1e9 * rng.choice([-1, 1], size=3)) for each in shapes]):
        _, iterates = proved(curve, method=method, max_iterations=3, vertices=29, mesh=mesh)
        assert_written(iterates, proofs)
