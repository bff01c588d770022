"""Fifty trajectories in which a strand moves through another between two frames: each is refused at that leg.

Every frame of them is an embedded polygon, so only the motion between two frames is wrong; and that it is wrong is
known from elsewhere: the knots before and after have different signatures.
"""

from functools import cache

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Mesh, RelaxOptions, Trajectory, relax
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.knots import knot
from mobius_flow.core.knots.diagrams import quick_invariants
from trajectory_files import checked, trajectory

RUNS: dict[str, tuple[str, RelaxOptions]] = {
    "trefoil": ("3_1", RelaxOptions(max_iterations=5)),
    "coarse trefoil": ("3_1", RelaxOptions(max_iterations=5, vertices=60)),
    "figure eight": ("4_1", RelaxOptions(max_iterations=5, vertices=150, method="flow-moebius")),
    "torus knot": ("T(3,5)", RelaxOptions(max_iterations=4, vertices=160, method="trust-region")),
    "Hopf link": ("hopf", RelaxOptions(max_iterations=5, vertices=100)),
    "Borromean rings": ("borromean", RelaxOptions(max_iterations=5, vertices=150)),
    "cinquefoil": ("5_1", RelaxOptions(max_iterations=5, vertices=120, edge_lengths="keep")),
    "seven crossings": ("7_4", RelaxOptions(max_iterations=4, vertices=200, method="implicit-moebius")),
    "adaptive figure eight": ("4_1", RelaxOptions(max_iterations=20, vertices=75, mesh="adaptive")),
    "adaptive Whitehead link": ("whitehead", RelaxOptions(max_iterations=17, vertices=100, mesh="adaptive")),
}
SEEDS = range(5)


@cache
def run(name):
    """The stages of a run."""
    kind, options = RUNS[name]
    record = Trajectory()
    for iterate in relax(knot(kind), options):
        record.add(iterate)
    arrays = record.arrays()
    count = len(arrays) // 2
    return [(Mesh(tuple(arrays[f"component_sizes_{k:03d}"].tolist())), arrays[f"stage_{k:03d}"]) for k in range(count)]


def verdict_on(folder, stages):
    return checked(folder, trajectory(*((mesh.component_sizes, frames) for mesh, frames in stages)))


def finger(curve, rng):
    """A displacement that pushes the strand at a random vertex through the strand nearest to it; shape (n, m)."""
    i = int(rng.integers(len(curve)))
    component, sizes = curve.mesh.component, curve.mesh.component_sizes
    apart = np.abs(np.arange(len(curve)) - i)
    apart = np.where(component == component[i], np.minimum(apart, sizes[component[i]] - apart), len(curve))
    distance = np.linalg.norm(curve.vertices - curve.vertices[i], axis=1)
    others = np.where(apart > sizes[component[i]] / 8, distance, np.inf)
    j = int(others.argmin())
    reach = rng.uniform(0.7, 2.0) * others[j] / curve.edge_lengths.mean()
    weight = np.exp(-((apart / reach) ** 2)) * (apart < sizes[component[i]])
    return rng.uniform(1.3, 1.8) * weight[:, None] * (curve.vertices[j] - curve.vertices[i])


def embedded(curve):
    try:
        check_embedded(curve)
    except CurveError:
        return False
    return True


def mutated(stages, rng):
    """The stages with a strand moved through another, and the stage and frame before it moves."""
    several = [k for k, (_, frames) in enumerate(stages) if len(frames) > 1]
    for _ in range(200):
        stage = several[rng.integers(len(several))]
        mesh, frames = stages[stage]
        frame = int(rng.integers(len(frames) - 1))
        push = finger(Curve(frames[frame + 1], mesh), rng)
        after = [Curve(vertices + push, mesh) for vertices in frames[frame + 1 :]]
        if quick_invariants(after[0]) != quick_invariants(Curve(frames[frame], mesh)) and all(map(embedded, after)):
            changed = np.concatenate([frames[: frame + 1], [curve.vertices for curve in after]])
            return [*stages[:stage], (mesh, changed), *stages[stage + 1 :]], stage, frame
    raise AssertionError("no strand could be moved through another")


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", RUNS)
def test_a_strand_moved_through_another_is_refused(tmp_path, name, seed):
    stages, stage, frame = mutated(run(name), np.random.default_rng([seed, len(name)]))
    verdict = verdict_on(tmp_path, stages)
    assert (verdict.accepted, verdict.stage, verdict.frame) == (False, stage, frame)
    assert "meet" in verdict.reason
