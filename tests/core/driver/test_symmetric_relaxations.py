"""Relaxations among symmetric curves: exact all along and proved, with their own minima, and what cannot be."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, OptionError, RelaxOptions, Task, minimize
from mobius_flow.core.curve.symmetry import Symmetry, symmetries
from mobius_flow.core.driver.moves.balance import moebius_image
from mobius_flow.core.knots import knot, smooth_knot, torus_knot
from shapes import half_circle, regular_polygon
from tasks import proved

EXACT = 1e-10  # shortest edges, of rounded coordinates


def error(last, *others):
    """How far vertices are from where symmetry puts them, under the group that the last curve is said to have."""
    group = symmetries(last.curve, 1e-6).subgroup(last.symmetry)
    kept = Symmetry(group.name, group.centre, group.matrices)
    return max(kept.on(each.curve).error(each.curve) for each in (last, *others))


def test_a_motion_to_a_symmetric_curve_comes_first():
    start = smooth_knot("3_1")
    result, (given, moved, meshed, *others) = proved(start, symmetry="D3", vertices=70, max_iterations=9)
    assert given.symmetry == moved.symmetry == ""
    assert given.curve.length == pytest.approx(start.length)  # the same polygon, with more vertices
    assert symmetries(moved.curve, 1e-6).name == "D3"
    assert len(meshed.curve) == 72
    assert all(each.symmetry == "D3" for each in [meshed, *others])
    assert error(result.last, meshed, *others) < EXACT
    assert result.report()["symmetry"] == "D3"


def test_links_are_symmetric_across_components():
    result = minimize(smooth_knot("L6a4"), RelaxOptions(symmetry="Th", vertices=192, max_iterations=12))
    assert len(set(result.curve.mesh.component_sizes)) == 1
    assert error(result.last) < EXACT


@pytest.mark.parametrize(("p", "q", "index"), [(3, 4, 2), pytest.param(3, 5, 4, marks=pytest.mark.slow)])
def test_torus_knots_are_saddles_that_only_broken_symmetry_leaves(p, q, index):
    options = {"vertices": 32 * q, "mesh": "fixed", "escape_saddles": True}
    symmetric = minimize(torus_knot(p, q), RelaxOptions(symmetry=f"D{q}", hops=1, **options))
    assert symmetric.outcome.negative_eigenvalues == index
    assert symmetric.outcome.symmetric_negative_eigenvalues == 0
    assert error(symmetric.last) < EXACT
    said = f"a minimum among curves of symmetry D{q}, a saddle of index {index} among all"
    assert said in symmetric.message
    broken = minimize(symmetric.curve, RelaxOptions(**options))
    assert broken.outcome.negative_eigenvalues == 0
    assert broken.energies[-1] < symmetric.energies[-1] - 2.0
    part = minimize(symmetric.curve, RelaxOptions(symmetry="C2", **options))
    assert part.outcome.symmetric_negative_eigenvalues == 0
    assert part.energies[-1] < symmetric.energies[-1] - 2.0
    assert error(part.last) < EXACT


def test_lengths_reach_their_targets_where_the_barycenter_moves():
    """The image of a relaxed curve has uneven edges; evening them out changes its length on the way."""
    curve = minimize(torus_knot(2, 3), RelaxOptions(symmetry="D3", vertices=120, mesh="fixed")).curve
    image = curve.with_vertices(moebius_image(curve.vertices / 2.0, np.array([1.0, 0.0, 0.0, 0.3])))
    result = minimize(image, RelaxOptions(symmetry="C3", vertices=120, mesh="fixed", max_iterations=30))
    assert result.outcome.converged
    assert result.last.edge_length_error < 1e-9


def test_without_symmetry_or_iterations_none_is_kept():
    result = minimize(smooth_knot("6_3"), RelaxOptions(symmetry="auto", max_iterations=2))
    assert result.message.endswith("; symmetry C1, so that there was none to keep")
    assert result.report()["symmetry"] is None
    assert len(result.energies) == 3
    result = minimize(torus_knot(2, 3), RelaxOptions(symmetry="D3", vertices=100, max_iterations=1))
    assert (result.last.symmetry, len(result.energies)) == ("", 2)
    result = minimize(torus_knot(2, 3), RelaxOptions(max_iterations=1, untangle="never"))
    assert result.last.symmetry == ""
    assert "symmetry" not in result.message


def test_strands_that_meet_on_the_axis_are_refused():
    """A rose of four leaves, whose strands pass its axis at different heights, which are the same in the mean."""
    t = 2.0 * np.pi * np.arange(400) / 400
    radius, height = np.cos(2.0 * t), 0.02 * np.cos(t + 0.3)
    rose = Curve(np.stack([radius * np.cos(t), radius * np.sin(t), height], axis=1))
    with pytest.raises(CurveError, match="is not free of contact, as where strands meet on an axis"):
        minimize(rose, RelaxOptions(symmetry="C4"))


@pytest.mark.parametrize(
    ("given", "more", "said"),
    [
        (torus_knot(2, 3), {"symmetry": "C4"}, "the curve has no symmetry C4: within 0.1 times its size its group"),
        (knot("6_2"), {"symmetry": "Th"}, "the curve has no symmetry Th: within 0.1"),
        (Task(curve=torus_knot(2, 3), pins=(1,)), {}, "pins and obstacles break symmetry; leave them out"),
        (half_circle(20), {}, "component 1 is open; symmetries are for closed components"),
        (regular_polygon(20, 2), {}, "the curve is in dimension 2; symmetries are for curves in space"),
    ],
)
def test_what_has_or_allows_no_symmetry_is_refused(given, more, said):
    with pytest.raises((CurveError, OptionError)) as caught:
        minimize(given, RelaxOptions(**{"symmetry": "C3", **more}))
    assert str(caught.value).startswith(said)
