"""What a run calls certified is exactly what was proved, and what it writes is exactly that."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from families import family
from mobius_flow.core import METHODS, Curve, Iterate, RelaxOptions, Trajectory, minimize, relax
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.collision import FreeMotion, Limit, survives_rounding
from mobius_flow.core.descent import NoStep, Point, SearchState, Step, problem
from mobius_flow.core.driver import run as driver
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import verify
from shapes import torus_trefoil

PENALISED = [name for name, method in METHODS.items() if not method.geometry.prescribes]

Proofs = set[tuple[bytes, bytes]]


@pytest.fixture
def proofs(monkeypatch: pytest.MonkeyPatch) -> Proofs:
    """The motions that are proved while a test runs, each by the bits of its ends."""
    proved: Proofs = set()
    prove = problem.free_motion

    def recorded(mesh: object, start: FloatArray, end: FloatArray, obstacles: object) -> FreeMotion:
        motion = prove(mesh, start, end, obstacles)
        if motion.proved:
            proved.add((start.tobytes(), end.tobytes()))
        return motion

    monkeypatch.setattr(problem, "free_motion", recorded)
    return proved


def assert_all_proved(trajectory: Trajectory, proofs: Proofs) -> int:
    """Every leg that is written was proved, bit for bit; returns how many there are."""
    arrays, legs = trajectory.arrays(), 0
    for name, frames in arrays.items():
        if name.startswith("stage_"):
            for a, b in pairwise(frames):
                assert (a.tobytes(), b.tobytes()) in proofs
                legs += 1
    return legs


def crooked(curve: Curve) -> Curve:
    """Coordinates that do not survive the way to the program's units and back."""
    rng = np.random.default_rng(83)
    vertices = curve.vertices + rng.uniform(1.0, 3.0, size=curve.dimension)
    vertices[0, 0] = 1.1e-13
    return curve.with_vertices(vertices)


@pytest.mark.parametrize("method", family(METHODS, every=3))
def test_what_is_written_was_proved(method: str, proofs: Proofs, tmp_path: Path) -> None:
    start = crooked(torus_trefoil(36))
    trajectory, certified = Trajectory(), True
    for iterate in relax(start, RelaxOptions(method=method, max_iterations=6, vertices=36)):
        trajectory.add(iterate)
        certified &= iterate.certified
    assert certified
    assert assert_all_proved(trajectory, proofs) >= 3
    trajectory.save(tmp_path / "T.npz")
    assert verify(tmp_path / "T.npz").accepted


def test_the_start_is_the_input_to_the_last_digit() -> None:
    start = crooked(torus_trefoil(36))
    first = next(relax(start, RelaxOptions(vertices=36)))
    assert first.curve.vertices.tobytes() == start.vertices.tobytes()
    units = problem.Units.of(start)
    assert not np.array_equal(units.to_user(units.from_user(start.vertices)), start.vertices)


def test_changes_of_mesh_are_proved_too(proofs: Proofs) -> None:
    trajectory = Trajectory()
    result = minimize(knot("4_1"), RelaxOptions(mesh="adaptive", max_iterations=12, vertices=75), trajectory.add)
    assert result.certified
    assert len(trajectory.arrays()) >= 4
    assert assert_all_proved(trajectory, proofs) > 9


class Forgetful:
    """A rule that now and then takes a step and proves nothing of it."""

    def __init__(self, limit: Limit) -> None:
        self._rule, self._limit, self._count = METHODS["lbfgs"].rule, limit, 0
        self.second_order, self.other_metrics = False, ()

    def step(self, point: Point, state: SearchState) -> tuple[Step | NoStep, SearchState]:
        step, state = self._rule.step(point, state)
        self._count += 1
        if self._count == 3:
            assert isinstance(step, Step)
            legs = (step.legs[-1]._replace(proof=FreeMotion(1.0, None, self._limit)),)
            return replace(step, legs=legs), state
        return step, state


def certified(iterates: list[Iterate]) -> list[bool]:
    return [iterate.certified for iterate in iterates]


@pytest.mark.parametrize("limit", [Limit.UNTESTED, Limit.CONTACT])
def test_one_step_without_proof_and_nothing_after_it_is_certified(
    limit: Limit, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(driver, "METHODS", {"lbfgs": replace(METHODS["lbfgs"], rule=Forgetful(limit))})
    iterates = list(relax(torus_trefoil(60), RelaxOptions(max_iterations=6, vertices=60)))
    assert certified(iterates) == [True] * 3 + [False] * 4


def test_nothing_is_certified_in_four_dimensions() -> None:
    curve = torus_trefoil(30)
    lifted = Curve(np.column_stack([curve.vertices, 0.1 * np.cos(np.arange(30))]))
    assert not any(certified(list(relax(lifted, RelaxOptions(max_iterations=3, vertices=30)))))


# far from the origin a point that is part of a proved motion is rounded beside it
FAR_TRIANGLE = [
    [-997959080.8786148, -1002555665.0313143, -999581901.1532742],
    [-1000567769.606128, -1000452649.2921104, -1000215597.1630898],
    [-1002019986.1291473, -1000231932.3776442, -1000865213.0762749],
]


def far_polygons() -> list[Curve]:
    rng = np.random.default_rng(17)
    shapes = [rng.normal(size=(int(rng.integers(3, 9)), 3)) for _ in range(3)]
    return [Curve(FAR_TRIANGLE), *[Curve(1e6 * shape + 1e9 * rng.choice([-1, 1], size=3)) for shape in shapes]]


@pytest.mark.parametrize("mesh", ["fixed", "adaptive"])
@pytest.mark.parametrize("method", PENALISED)
def test_part_of_a_proved_motion_is_proved_as_it_is_rounded(
    method: str, mesh: str, proofs: Proofs, tmp_path: Path
) -> None:
    for curve in far_polygons():
        trajectory = Trajectory()
        options = RelaxOptions(method=method, max_iterations=3, vertices=29, mesh=mesh)
        assert minimize(curve, options, trajectory.add).certified
        assert_all_proved(trajectory, proofs)
        trajectory.save(tmp_path / "T.npz")
        assert verify(tmp_path / "T.npz").accepted


def test_rounding_that_matters() -> None:
    curve = torus_trefoil(40)
    assert survives_rounding(curve)
    assert not survives_rounding(curve.with_vertices(curve.vertices + 1e15))
    near = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, 1e-15, 0.0], [0, 1, 0]])
    assert not survives_rounding(Curve(near))
    near[3, 1] = 1e-12
    assert survives_rounding(Curve(near))
