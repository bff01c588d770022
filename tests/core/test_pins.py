"""Pins: vertices that stay where they are to the last digit, whatever becomes of the mesh around them."""

from dataclasses import replace

import numpy as np
import pytest
from descent_contracts import point_on
from mobius_flow.core import Curve, MobiusFlowError, RelaxOptions, Status, Task, minimize
from mobius_flow.core.curve import Mesh, refine
from mobius_flow.core.curve.pins import Pins, arcs, ends_of, spans
from mobius_flow.core.curve.refine import smoothed, subdivide, superfluous
from mobius_flow.core.descent.geometry import Geometry
from mobius_flow.core.descent.hessian import lagrangian_hessian, lagrangian_matrix
from mobius_flow.core.driver.moves.rest import stability
from mobius_flow.core.knots import knot
from shapes import regular_polygon, torus_trefoil
from solids import plate
from tasks import proved, wanted
from taylor import taylor_slope

SLOW = [pytest.param(mesh, marks=pytest.mark.slow) for mesh in ("fixed", "finer")]


def test_arcs_go_from_pin_to_pin_round_the_end_and_have_every_edge():
    mesh = Mesh((6, 4))
    found = [arc.tolist() for arc in arcs(mesh, np.array([2, 4]))]
    assert found == [[0, 1, 4, 5], [2, 3], [6, 7, 8, 9]]
    assert [arc.tolist() for arc in arcs(mesh, np.array([], dtype=int))] == [[0, 1, 2, 3, 4, 5], [6, 7, 8, 9]]
    assert [arc.tolist() for arc in arcs(mesh, np.array([3]))] == [[0, 1, 2, 3, 4, 5], [6, 7, 8, 9]]
    mesh = Mesh((7, 5, 9))
    rng = np.random.default_rng(101)
    for count in range(22):
        edges = np.concatenate(arcs(mesh, np.sort(rng.choice(21, count, replace=False))))
        assert sorted(edges.tolist()) == list(range(21))


@pytest.mark.parametrize("pins", [[0, 50], [3, 20, 99], [10]])
def test_collapses_take_no_pin_and_leave_each_arc_enough_edges_to_bend(pins):
    curve, kept = regular_polygon(100), np.array(pins)
    chosen = superfluous(curve, np.full(100, 1e3), kept)
    assert len(chosen) > 10
    assert not np.isin(chosen, kept).any()
    for arc in arcs(curve.mesh, kept):
        inside = np.isin(chosen, np.setdiff1d(ends_of(curve.mesh, arc), kept)).sum()
        assert len(arc) - inside >= min(len(arc), 16)


@pytest.mark.parametrize(("pins", "places"), [([4], [11]), ([2, 9, 30], [0, 40, 99]), ([0, 39], [0, 99])])
def test_smooth_curves_have_pins_at_their_places(pins, places):
    """Equal distances from one to the next, round the first vertex."""
    coarse = regular_polygon(40)
    fine = smoothed(coarse, Mesh((100,)), np.array(pins), np.array(places))
    np.testing.assert_allclose(fine.vertices[places], coarse.vertices[pins], atol=1e-15)
    for arc in arcs(fine.mesh, np.array(places)):
        assert np.ptp(fine.edge_lengths[arc]) < 1e-3 * fine.edge_lengths[arc].mean()


SQUARE = Curve([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]])


def test_straight_arcs_are_held_also_where_vertices_are_inserted():
    """A corner between pins leaves slack."""
    fine = subdivide(SQUARE, np.array([4, 4, 4, 4]))
    pins = Pins.at(fine, SQUARE.vertices[[0, 1]])
    assert pins.vertices.tolist() == [0, 1, 2, 3, 4]
    finer = subdivide(fine, np.full(16, 3))
    assert pins.on(finer).vertices.tolist() == list(range(13))
    np.testing.assert_array_equal(pins.on(finer).positions[::3], pins.positions)
    assert [span.taut for span in spans(fine, np.array([0, 4]))] == [True, False]
    assert Pins.at(fine, SQUARE.vertices[[0, 2]]).vertices.tolist() == [0, 8]
    pins = Pins.of(torus_trefoil(40), np.array([0, 20])).with_neighbours(torus_trefoil(40))
    assert pins.vertices.tolist() == [0, 1, 19, 20, 21, 39], "with tangents"


BENT = torus_trefoil(90).with_vertices(torus_trefoil(90).vertices * [1.0, 1.3, 1.1])
PINS = (3, 30, 62)


def checked(curve, **options):
    """The iterates of a proved run, at every one of which all pins of the start are found among the vertices."""
    options = {"pins": PINS, **options}
    result, iterates = proved(curve, **options)
    pinned = {tuple(v) for v in curve.vertices[list(options["pins"])].tolist()}
    for iterate in iterates:
        assert pinned <= {tuple(v) for v in iterate.curve.vertices[list(iterate.pins)].tolist()}
    return iterates, result.message


def test_pins_are_held_by_the_hierarchical_solver_too():
    dense, _ = checked(BENT, solver="dense", vertices=90, mesh="fixed")
    hierarchical, message = checked(BENT, solver="hierarchical", vertices=90, mesh="fixed")
    assert message.startswith("converged")
    assert hierarchical[-1].energy == pytest.approx(dense[-1].energy, rel=1e-6)


@pytest.mark.parametrize("mesh", [*SLOW, "adaptive", "auto"])
def test_pins_survive_every_mesh(mesh):
    """Coarse input with near strands: vertices are inserted at the start, and later on split and left out."""
    iterates, message = checked(knot("ochiai-1"), pins=(1, 8, 20), mesh=mesh, max_iterations=60)
    assert all(len(iterate.pins) == 3 for iterate in iterates)
    assert mesh in ("fixed", "finer", "auto") or len({len(iterate.curve) for iterate in iterates}) > 1
    assert iterates[-1].energy < 0.5 * iterates[0].energy, message


def test_arcs_keep_their_lengths_spread_evenly():
    curve = refine(torus_trefoil(40).with_vertices(torus_trefoil(40).vertices * [1.0, 2.0, 1.0]), 160)
    pins = (10, 11, 70, 130)
    end = checked(curve, pins=pins, vertices=160)[0][-1].curve
    for arc in arcs(curve.mesh, np.array(pins)):
        assert end.edge_lengths[arc].sum() == pytest.approx(curve.edge_lengths[arc].sum(), rel=1e-9)
        assert np.ptp(end.edge_lengths[arc]) < 1e-9


def test_pinned_tangents_stay_on_finer_meshes():
    curve, pins = knot("ochiai-1"), (1, 8)
    (start, *_, end), _ = checked(curve, pins=pins, pin_tangents=True, mesh="adaptive", max_iterations=60)
    assert len(start.pins) == 6
    assert len(end.curve) != len(start.curve)
    for vertex in curve.vertices[list(pins)]:
        before, after = (directions(each.curve, vertex) for each in (start, end))
        np.testing.assert_allclose(after, before, atol=1e-12)


def directions(curve, vertex):
    """Unit tangents on either side of a vertex."""
    k = int(np.flatnonzero((curve.vertices == vertex).all(axis=1))[0])
    edges = [int(curve.mesh.previous[k]), k]
    return curve.edge_vectors[edges] / curve.edge_lengths[edges, None]


@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_loops_converge_in_every_dimension(dimension):
    """A star with pinned corners, down to a small gradient; in four dimensions nothing is proved."""
    angle = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
    radius = np.where(np.arange(16) % 2 == 0, 1.0, 0.45)
    star = np.full((16, dimension), 0.1)
    star[:, :2] = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    pinned = {"pins": (0, 4, 8, 12), "tolerance": 1e-6, "vertices": 160}
    result = minimize(*wanted(Curve(star), **pinned)) if dimension == 4 else proved(Curve(star), **pinned)[0]
    assert result.status is Status.CONVERGED
    assert result.last.gradient_norm <= 1e-6 * np.sqrt(result.last.energy)
    np.testing.assert_array_equal(result.curve.vertices[list(result.last.pins)], star[[0, 4, 8, 12]])


def test_nothing_moves_where_everything_is_pinned():
    for options in ({}, {"solver": "hierarchical"}, {"metric": "l2"}, {"method": "penalty-cg"}, {"stability": True}):
        iterates, message = checked(BENT, pins=tuple(range(90)), **options)
        assert message.startswith("converged: projected gradient 0 ≤")
        assert "nothing can move: the curve is pinned, or straight between pins" in message
        assert len(iterates) == 1


def test_straight_arcs_of_a_start_do_not_move_and_others_do(caplog):
    curve = Curve([[0, 0, 0], [3, 0, 0], [3, 1, 0.2], [1.5, 2, 0.9], [0, 1, -0.3]])
    iterates, message = checked(curve, pins=(0, 1), vertices=100)
    assert message.startswith("converged")
    held = len(iterates[0].pins)
    assert caplog.messages == [f"{held - 2} of 100 vertices are on straight arcs between pins, and held as well"]
    assert 20 < held < 60
    np.testing.assert_array_equal(iterates[-1].curve.vertices[:held], iterates[0].curve.vertices[:held])
    assert np.abs(iterates[-1].curve.vertices - iterates[0].curve.vertices).max() > 0.1


@pytest.mark.kernels
def test_little_slack_is_no_obstacle():
    """The arc hardly bends out: 1 + 10⁻⁴ times as long as the distance of its ends."""
    x, t = np.linspace(0.0, 4.0, 40, endpoint=False), np.linspace(0.0, np.pi, 120)[:-1]
    sag = 4.0 * np.sqrt(3e-4 / 8.0)
    below = np.stack([x, -sag * x * (4.0 - x) / 4.0, 0.0 * x], axis=1)
    above = np.stack([2.0 + 2.0 * np.cos(t), 2.5 * np.sin(t), 0.4 * np.sin(2.0 * t)], axis=1)
    iterates, message = checked(Curve(np.concatenate([below, above])), pins=(0, 40), mesh="fixed", max_iterations=300)
    assert message.startswith("converged")
    # (42) ends as soon as a correction leaves no relative error of a length above its tolerance: how far below it the
    # last one leads, by quadratic convergence, depends on the last step, and with that on the processor
    assert iterates[-1].edge_length_error <= Geometry().tolerance


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"pins": (2, 90)}, "pins asks for vertex 91, but the curve has 90 vertices"),
        ({"pins": (2, 5, 2)}, "pins names vertex 3 more than once"),
        ({"pins": (-1,)}, "pins asks for vertex 0, but the curve has 90 vertices"),
        ({"pins": (0.5,)}, "pins is (0.5,); give a tuple, each a whole number"),
        ({"pins": "12"}, "pins is '12'; give a tuple, each a whole number"),
        ({"pins": 12}, "pins is 12; give a tuple, each a whole number"),
        ({"pins": (1,), "balance": True}, "balance would move pins, as Möbius maps do; leave one of the two out"),
        (
            {"avoid": (plate(9.0),), "balance": True},
            "balance takes Möbius images, which have another repulsion than the curve; leave it out",
        ),
    ],
)
def test_pins_that_cannot_be_are_refused(options, said):
    with pytest.raises(MobiusFlowError) as error:
        minimize(*wanted(BENT, **options))
    assert str(error.value) == said


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ((slice(3, 30), 0.1), r"edge_lengths makes the arc between vertices 4 and 31, which are pinned, 0\.\d+ times"),
        ((slice(62, 63), 1.01), "edge_lengths changes the edge between vertices 63 and 64, which are both pinned"),
    ],
)
def test_target_lengths_must_reach_from_pin_to_pin(change, said):
    lengths = BENT.edge_lengths.copy()
    task, kept = wanted(BENT, vertices=90, pins=(*PINS, 63), edge_lengths=tuple(lengths), max_iterations=2)
    assert minimize(task, kept).certified
    lengths[change[0]] *= change[1]
    with pytest.raises(MobiusFlowError, match=said):
        minimize(task, replace(kept, edge_lengths=tuple(lengths)))


def test_the_report_tells_the_pins_of_the_result():
    assert [Task(curve=BENT, pins=pins).pins for pins in ([3, 5], np.array([3, 5]))] == [(3, 5), (3, 5)]
    result = minimize(*wanted(BENT, pins=PINS, vertices=180, max_iterations=2))
    pins = result.report()["pins"]
    assert isinstance(pins, list)
    np.testing.assert_array_equal(result.curve.vertices[pins], BENT.vertices[list(PINS)])
    assert minimize(BENT, RelaxOptions(max_iterations=0)).report()["pins"] == []


def test_the_kernel_at_a_minimum_has_no_rotations_that_pins_forbid():
    """A round circle can rotate about its axes and slide; with three pins it can do neither."""
    circle = regular_polygon(40)
    free, pinned = (stability(point_on(circle, pins=pins)) for pins in ((), (0, 13, 26)))
    assert np.count_nonzero(np.abs(free.modes.values) < 1e-5) >= 3
    assert not np.count_nonzero(np.abs(pinned.modes.values) < 1e-5)
    assert not pinned.modes.vectors[:, [0, 13, 26]].any()


def test_the_lagrangians_hessian_knows_pins():
    """At a critical point it is the second derivative of the energy along the constraints."""
    pins = (3, 4, 62)
    relaxed = minimize(*wanted(BENT, pins=pins, vertices=90, mesh="fixed", method="trust-region", tolerance=1e-9))
    point = point_on(relaxed.curve, pins=pins)
    v = np.sin(3.0 * BENT.vertices[:, [1, 2, 0]])
    v[list(pins)] = 0.0
    v = point.tangent_space.project(v)
    matrix = lagrangian_matrix(point)
    np.testing.assert_allclose(
        (matrix @ v.ravel()).reshape(v.shape), lagrangian_hessian(point)(v), atol=1e-9 * np.abs(matrix).max()
    )

    def second_order(t):
        end = point.retract(point.vertices + t * v / np.abs(v).max(), 0.0 * point.residual)
        return np.array(end.energy)

    slope = float(np.sum(point.derivative * v)) / np.abs(v).max()
    curvature = float(v.ravel() @ matrix @ v.ravel()) / np.abs(v).max() ** 2
    assert taylor_slope(second_order, [point.energy, slope, curvature], largest=0.02, halvings=9) > 2.8
