"""Benchmarks run, and their curves are what they are said to be."""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from braid_words import burau_alexander
from hard_curves import hard_unknot, lattice_closure, rope, unknot_word
from hypothesis import given, settings
from hypothesis import strategies as st
from knot_type import UNKNOT, knot_invariants
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.knots import KNOTS, braid_closure
from mobius_flow.core.knots.diagrams import quick_invariants
from processes import finished

BENCHMARKS = Path(__file__).resolve().parents[1] / "benchmarks"
ARGUMENTS = {
    "bundles": ["1"],
    "collision": ["curves", "60"],
    "hops": ["T34", "--hops", "1"],
    "knots": ["knots", "--only", "3_1,L2a1,unknot-rope", "--tolerance", "1e-2"],
    "morphs": ["--only", "ochiai"],
    "resolution": ["3_1"],
    "rope": ["4_1", "--vertices", "80", "--iterations", "20"],
    "seeded_runs": ["different", "--save", "runs.json"],
    "untangling": ["culprit"],
    "speed": ["--sizes", "60,80", "--solver", "hierarchical"],
}


def test_every_benchmark_is_tried():
    assert {path.stem for path in BENCHMARKS.glob("*.py")} - {"hard_curves"} == set(ARGUMENTS)


def run(name, *arguments):
    return finished([sys.executable, str(BENCHMARKS / f"{name}.py"), *arguments])


@pytest.mark.parametrize(
    "name", [pytest.param(each, marks=() if each == "collision" else pytest.mark.slow) for each in ARGUMENTS]
)
def test_it_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = run(name, *ARGUMENTS[name])
    assert done.returncode == 0, done.stdout + done.stderr
    few = {"seeded_runs": 0, "untangling": 2, "resolution": 3, "hops": 3, "rope": 3, "collision": 3, "knots": 6}
    least = few.get(name, 5)  # a title, and a line for each curve
    assert len(done.stdout.splitlines()) >= least


@pytest.mark.slow
def test_collisions_with_an_obstacle_are_measured():
    done = run("collision", "obstacle", "60")
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) > 3


WORDS = {name: KNOTS[name] for name in ("0_1", "3_1", "4_1", "8_19", "10_132", "L2a1", "L5a1", "L6a4")}
WORDS |= {f"unknot {c}": unknot_word(c, seed=c) for c in (20, 141)}


@pytest.mark.parametrize(("crossings", "seed"), [(0, 1), (1, 1), (2, 1), (5, 3), (10, 3), (30, 7)])
def test_hard_unknots_are_unknots(crossings, seed):
    assert knot_invariants(hard_unknot(crossings, seed).vertices) == UNKNOT


@given(crossings=st.integers(0, 40), seed=st.integers(0, 2**32))
@settings(max_examples=30, deadline=None)
def test_words_are_long_reduced_and_trivial(crossings, seed):
    word = unknot_word(crossings, seed)
    assert len(word) == crossings
    assert burau_alexander(word, max(map(abs, word), default=0) + 1) == (1,)
    assert all(a != -b for a, b in pairwise(word + word[:1]))


@pytest.mark.parametrize("gap", [0.2, 1e-9])
@pytest.mark.parametrize("twists", [0.0, 3.0, -7.5])
def test_ropes_are_unknots_with_strands_as_near_as_asked(twists, gap):
    curve = rope(twists, gap, vertices=100)
    opposite = np.linalg.norm(curve.vertices[:49] - curve.vertices[50:99][::-1], axis=1)
    assert opposite == pytest.approx(gap)
    assert knot_invariants(curve.vertices * [1, 1 / gap, 1 / gap]) == UNKNOT


@pytest.mark.parametrize("name", WORDS)
def test_lattice_polygons_turn_at_every_vertex_and_have_the_type_of_the_smooth_closure(name):
    curve = lattice_closure(WORDS[name])
    check_embedded(curve)
    assert quick_invariants(curve) == quick_invariants(braid_closure(WORDS[name]))
    assert np.array_equal(curve.vertices, np.round(curve.vertices))
    assert np.all(np.count_nonzero(curve.edge_vectors, axis=1) == 1)
    assert np.all(np.einsum("ij,ij->i", curve.edge_vectors, curve.edge_vectors[curve.mesh.previous]) == 0)
