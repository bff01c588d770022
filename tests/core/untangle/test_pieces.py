"""Each piece of a strand move keeps what it has to."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.collision import is_free, thickness
from mobius_flow.core.curve.distances import arc_distance_of_vertices
from mobius_flow.core.curve.pins import holds
from mobius_flow.core.energies.edge_pairs import EdgePairs
from mobius_flow.core.energies.rope import closest, phi
from mobius_flow.core.knots import knot, scramble
from mobius_flow.core.knots.diagrams import is_least, jones, simplified
from mobius_flow.core.knots.diagrams.diagram import ENDS, PIN
from mobius_flow.core.knots.diagrams.projection import projections, rotation
from mobius_flow.core.knots.diagrams.rerouting import StrandMove, shortened, strands
from mobius_flow.core.untangle.leading import Lead, lead
from mobius_flow.core.untangle.model import ElasticModel
from mobius_flow.core.untangle.rope import ElasticRope, Springs
from mobius_flow.core.untangle.ways import Plane, Way
from taylor import taylor_slope


@cache
def scrambled(name):
    return scramble(knot(name, 60), 1, moves=1500)


def messy(name, held=(), *, is_open=False):
    """The drawing of a messy curve from a random direction."""
    curve = scrambled(name)
    if is_open:
        curve = Curve(curve.vertices[:-1], Mesh((len(curve) - 1,), (False,)))
    frame, still = rotation(np.random.default_rng(1).normal(size=(3, 3))), [*held, *curve.mesh.ends.ravel()]
    return next(projections(curve.mesh, curve.vertices, [frame], np.array(still, dtype=int)))[1]


def laid(name, vertices=120, held=(), radius=None):
    """A knot's rope on the table after a few steps."""
    curve = knot(name, vertices)
    own = None if radius is None else np.array([radius])
    rope = ElasticRope(curve, np.eye(3), holds(curve.mesh, np.array(held, dtype=int)), (), own)
    rope.face, rope.thick = 0.3 * float(np.ptp(curve.vertices, axis=0).max()), 0.3 * thickness(curve)
    for _ in range(6):
        assert rope.step()
    return rope


def drawing(rope):
    return next(projections(rope.mesh, rope.seen, [np.eye(3)], np.flatnonzero(rope.held)))[1]


def test_where_a_curve_is_held_strands_end():
    pinned = messy("5_2", held=(3, 30)).diagram
    assert pinned.sequence.count(PIN) == 2
    arc = messy("5_2", is_open=True).diagram
    assert arc.sequence.count(ENDS) == 1
    for diagram in (pinned, arc):
        assert diagram.is_planar
        while (move := shortened(diagram)) is not None:
            assert all(move.before.sequence[i][0] >= 0 for i in move.strand.inner)
            diagram = move.after
            assert diagram.is_planar
        assert is_least(diagram)
        assert diagram.crossings == (0 if diagram.sequence.count(ENDS) else 5)


@pytest.mark.parametrize(("name", "is_open"), [("5_2", False), ("5_2", True), ("L6a4", False)])
def test_ways_lead_to_diagrams_of_the_same_knot(name, is_open):
    seen = messy(name, is_open=is_open)
    plane, known = Plane(seen, 0.05 * float(np.ptp(seen.points, axis=0).max())), None
    triangle_sides = set(zip(plane.leave.tolist(), plane.enter.tolist(), strict=True))
    assert all((b, a) in triangle_sides for a, b in triangle_sides)
    assert np.isin(np.arange(len(plane.pieces)), plane.piece).all()
    found = [(strand, way) for strand in strands(seen.diagram) if (way := plane.way(strand)) is not None]
    assert found
    for strand, way in found[::3]:
        assert len(way.route) < len(strand.inner)
        after = StrandMove(seen.diagram, strand, way.route).after
        assert after.is_planar
        if not is_open:
            known = known or jones(simplified(seen.diagram))
            assert jones(simplified(after)) == known


def test_a_rope_at_rest_keeps_its_length_its_type_and_what_is_held():
    rope = laid("5_2")
    assert rope.curve.length == pytest.approx(knot("5_2", 120).length)
    assert jones(simplified(drawing(rope).diagram)) == jones(simplified(drawing(laid("5_2", 120)).diagram))
    assert np.ptp(rope.seen[:, 2]) < 0.8 * np.ptp(knot("5_2", 120).vertices[:, 2])
    rope = laid("5_2", held=(3, 40))
    np.testing.assert_array_equal(rope.vertices[[3, 40]], knot("5_2", 120).vertices[[3, 40]])


def test_forces_of_barrier_tension_and_weight_are_derivatives():
    """Of energies whose weights are those of the rope as it is."""
    rope = laid("5_2")
    here, r, n = Curve(rope.seen, rope.mesh), rope.thick, rope.mesh.size
    v = np.random.default_rng(4).normal(size=(n, 3)) * 0.1 * r
    e, f = rope._strands(here, 4.0 * r, r)
    ell, mean = here.edge_lengths, float(here.edge_lengths.mean())
    barrier, tension = ElasticModel(n), ElasticModel(n)
    rope._add_barrier(barrier, here, e, f)
    rope._add_tension(tension, here, 5, np.ones(n, dtype=bool), None)
    goal = (1.0 - rope._pull) * mean

    def apart(t):
        chord, _, _ = closest(EdgePairs.of(rope.mesh, here.vertices + t * v, e, f))
        value, _, _ = phi(0.5 * np.linalg.norm(chord, axis=1) / r - 1.0)
        return float(np.sum(0.2 * ell[e] * ell[f] / r * value))

    def tense(t):
        moved = Curve(here.vertices + t * v, rope.mesh)
        weight = 0.75 * mean / rope.face**2 * np.sum(moved.vertices[:, 2] ** 2)
        return float(np.sum((moved.edge_lengths - goal) ** 2) / (0.12 * mean) + weight)

    assert apart(0.0) > 0.0
    for energy, model in ((apart, barrier), (tense, tension)):
        assert taylor_slope(energy, [energy(0.0), np.sum(model.force * v)]) > 1.9


def test_the_repulsion_in_the_plane_is_that_of_all_pairs_which_are_not_near_one_crossing():
    """Its force is the derivative of what is added up pair by pair."""
    rope = laid("5_2")
    here, face, n = Curve(rope.seen, rope.mesh), rope.face, rope.mesh.size
    mean, crossings, x = float(here.edge_lengths.mean()), drawing(rope).crossings.edges, here.vertices
    reach = int(0.5 * face / mean)
    i, j = np.triu_indices(n, 1)
    apart = (arc_distance_of_vertices(here, i, j) > 1.6 * face) & (np.linalg.norm((x[i] - x[j])[:, :2], axis=1) < face)
    assert apart.any()
    for a, b in crossings.T:
        at_a, at_b = ((np.stack([i, j]) - each + reach + 1) % n < 2 * reach + 4 for each in (a, b))
        apart &= ~(at_a & at_b[::-1]).any(axis=0)
    i, j = i[apart], j[apart]
    model, v = ElasticModel(n), np.random.default_rng(5).normal(size=(n, 3)) * 0.05 * face
    rope._add_repulsion(model, here, crossings, np.ones(n, dtype=bool))

    def energy(t):
        moved = x + t * v
        value, _, _ = phi(np.linalg.norm((moved[i] - moved[j])[:, :2], axis=1) / face)
        return float(1.5 * (mean / face) ** 2 * face * value.sum())

    assert energy(0.0) > 0.0
    assert taylor_slope(energy, [energy(0.0), np.sum(model.force * v)]) > 1.9


def test_the_minimum_of_forces_is_that_of_the_dense_form():
    rng, n = np.random.default_rng(6), 12
    model, dense = ElasticModel(n), np.eye(3 * n)
    model.form += np.eye(3)
    for _ in range(5):  # functions of x_a − x_b / 2
        a, b = rng.permutation(n)[:8].reshape(2, 4)
        first, second = rng.normal(size=(4, 3)), np.einsum("kij,klj->kil", *[rng.normal(size=(4, 3, 3))] * 2)
        model.couple(((a, np.ones(4)), (b, np.full(4, -0.5))), first, second)
        for k in range(4):
            by = np.kron(np.eye(n)[a[k]] - 0.5 * np.eye(n)[b[k]], np.eye(3))
            dense += by.T @ second[k] @ by
    np.testing.assert_allclose(model.minimum().ravel(), -np.linalg.solve(dense, model.force.ravel()), rtol=1e-9)


def test_springs_lead_vertices_and_no_further_than_the_rest_allows():
    rope = laid("3_1")
    k = np.arange(20, 40)
    places = rope.seen[k] + [0.0, 0.0, 0.5 * rope.face]
    for _ in range(8):
        rope.step(Springs(k, places, np.tile(np.eye(3), (20, 1, 1)), landed=False))
    assert np.abs(rope.seen[k[5:-5]] - places[5:-5]).max() < 0.3 * rope.face
    through = places - [0.0, 0.0, 2.0 * rope.face]  # below all other strands, through which no way leads
    for _ in range(12):
        rope.step(Springs(k, through, np.tile(np.eye(3), (20, 1, 1)), landed=False))
    assert jones(simplified(drawing(rope).diagram)) == jones(simplified(drawing(laid("3_1")).diagram))


def test_strands_go_short_ways_to_their_ends():
    rope = laid("3_1")
    seen, bump = drawing(rope), np.sin(np.linspace(0.0, np.pi, 21))[:, None]
    out = rope.seen[40:61, :2] - rope.seen[:, :2].mean(axis=0)
    corners = rope.seen[40:61, :2] + 0.1 * rope.face * bump * out / np.linalg.norm(out, axis=1)[:, None]
    each = Lead(rope, seen, StrandMove(seen.diagram, next(strands(seen.diagram)), []), Way((40.0, 60.0), corners, []))
    lead(rope, [each])
    way, gone = each.new - each.old[:, :2], rope.seen[each.vertices, :2] - each.old[:, :2]
    assert (np.sum(gone * way, axis=1) > 0.35 * np.sum(way**2, axis=1))[6:-6].all()


def test_what_is_too_long_is_drawn_in_gently():
    """Tension that shortens all edges at once would draw loops tight that hook each other."""
    rope = laid("5_2")
    rope.face *= 0.1
    assert rope.step()
    assert rope._pull == 0.02
    rope.face *= 30.0
    rope.step()
    assert rope._pull == -0.012, "and what is too short swells as gently"


def test_a_rope_stays_one_of_its_radius():
    radius = 0.5 * thickness(knot("3_1", 120))
    rope = laid("3_1", radius=radius)
    rope.thick, k = 0.1 * radius, np.arange(20, 40)  # only the proof keeps it so thick
    for _ in range(12):
        rope.step(Springs(k, rope.seen[k] - [0.0, 0.0, rope.face], np.tile(np.eye(3), (20, 1, 1)), landed=False))
    assert thickness(rope.curve) > 0.99 * radius


@pytest.mark.parametrize("name", ["goeritz", "culprit"])
def test_a_move_in_space_leads_to_the_diagram_that_was_planned(name):
    rope = laid(name, 160)
    seen = drawing(rope)
    plane = Plane(seen, rope.face)
    found = ((strand, plane.way(strand)) for strand in strands(seen.diagram))
    strand, way = next((strand, way) for strand, way in found if way and len(way.route) < len(strand.inner))
    move = StrandMove(seen.diagram, strand, way.route)
    lead(rope, [Lead(rope, seen, move, way)])
    after = drawing(rope).diagram
    assert after.crossings <= move.after.crossings
    assert simplified(after).crossings == simplified(move.after).crossings


def test_short_steps_are_one_leg_and_what_is_taken_back_leaves_no_trace():
    rope = laid("3_1", 60)
    before, mark = rope.take(3, 0), rope.mark()
    legs = [before.start.vertices, *before.path]
    assert 1 < len(legs) <= 6
    for start, end in pairwise(legs):
        assert is_free(rope.mesh, start, end)
        assert np.linalg.norm(end - start, axis=1).max() < 1.01 * rope.stride * rope.face
    assert rope.step()
    rope.rewind(mark)
    np.testing.assert_array_equal(rope.vertices, before.path[-1])
    assert rope.step()
    assert len(rope.take(3, 0).path) == 1


@pytest.mark.parametrize(("crossings", "long"), [(3, True), (20, False)])
def test_faces_are_no_wider_than_the_rope_is_long_for(crossings, long):
    """For as many crossings as could be where it lies; else it would shrink, further and further."""
    rope = laid("3_1", 60)
    area = np.sqrt(np.linalg.det(np.cov(rope.seen[:, :2].T)))
    length = np.linalg.norm(rope.mesh.changes(rope.seen), axis=1).sum()
    rope.lie_down(crossings, 1.0)
    assert bool(rope.face == pytest.approx(np.sqrt(10.0 * area / crossings))) is long
    assert rope.face * 1.8 * crossings < 1.001 * length


def test_a_rope_rises_until_its_corners_are_right():
    rope = laid("3_1", 60)
    low = np.ptp(rope.seen[:, 2])
    rope.rise(1e3)
    assert np.ptp(rope.seen[:, 2]) > 1.5 * low
    assert rope._cosines(Curve(rope.seen, rope.mesh)).min() >= 0.0
