"""Audits find every passing of an oracle's and invent none, say what became of types, and break off with a sentence."""

import numpy as np
import pytest
from melts import melt, passings_by_eigenvalues, planted
from mobius_flow.core import Curve, MobiusFlowError, audit
from mobius_flow.core.knots.diagrams.invariants import linking_numbers
from shapes import regular_polygon

CIRCLE = regular_polygon(12).vertices
HOPF = np.concatenate([CIRCLE, CIRCLE[:, [0, 2, 1]] + [1.0, 0.07, 0.03]])
APART = HOPF + np.repeat([[0.0, 0, 0], [5, 0, 0]], 12, axis=0)


def told(report):
    """As the oracle tells it."""
    each = report.passings
    first = report.topology.beads[report.topology.tails[each["edges"]]]
    columns = (first[:, 0], first[:, 1], each["sign"], each["time"])
    return sorted(zip(*(column.tolist() for column in columns), strict=True))


@pytest.mark.parametrize(
    ("rings", "beads", "seeds"), [(12, 40, range(3)), pytest.param(50, 200, range(100, 120), marks=pytest.mark.slow)]
)
def test_planted_passings_are_found_and_none_invented(rings, beads, seeds):
    for seed in seeds:
        points, box = melt(rings, beads, seed)
        moved, pairs = planted(points, box, beads, 10 if rings < 50 else 50, seed)
        known = passings_by_eigenvalues(points, moved, box, beads)
        found = told(audit([points % box, moved % box], beads, box=[box] * 3))
        assert [each[:3] for each in found] == [each[:3] for each in known]
        assert np.allclose([each[3] for each in found], [each[3] for each in known], atol=1e-9)
        assert pairs <= {(a, b) for a, b, sign, time in found if sign and abs(time - 0.625) < 1e-9}


def test_it_does_not_matter_how_chains_are_wrapped_or_who_works():
    points, box = melt(40, 40, 5)
    rng = np.random.default_rng(5)
    frames = [points, points + 0.05 * rng.normal(size=points.shape)]
    frames.append(frames[1] + 0.05 * rng.normal(size=points.shape))
    whole = audit(frames, 40, box=[box] * 3)
    assert len(whole.passings) > 10
    others = [frame + box * rng.integers(-2, 3, size=frame.shape) for frame in frames]
    for report in (audit(others, 40, box=[box] * 3), audit(others, 40, box=[box] * 3, processes=2)):
        assert [each[:3] for each in told(report)] == [each[:3] for each in told(whole)]
        assert report.passings["leg"].tolist() == whole.passings["leg"].tolist()
    # apart from images, without a box there is the same
    own = whole.passings[(whole.passings["image"] == 0).all(axis=1)]
    assert [each[0:2] for each in told(audit(frames, 40))] == sorted(map(tuple, own["edges"].tolist()))


def linking(points):
    """The linking number of two rings of half the beads each."""
    (found,) = linking_numbers(Curve.from_components(np.split(points, 2)))
    return found


def test_linking_numbers_and_types_change_as_told():
    report = audit([HOPF, APART, APART], 12)
    (pair,) = report.meetings()
    assert (pair.chains, pair.passings, abs(pair.linking)) == ((0, 1), 1, 1)
    assert (str(pair.before), str(pair.after)) == ("L2a1", "unknot ⊔ unknot")
    assert pair.linking == -linking(HOPF)
    assert [each.before for each in report.meetings(0)] == [None]
    assert list(audit([HOPF, HOPF], 12).meetings()) == []
    assert [each.linking for each in audit([HOPF, APART], 12, closed=False).meetings()] == [0]
    touching = np.concatenate([CIRCLE, CIRCLE[::-1]])  # which is no type
    assert [(str(each.before), each.after) for each in audit([HOPF, touching], 12).meetings()] == [("L2a1", None)]


def test_what_goes_through_beads_or_happens_at_frames_is_counted():
    """Rings on a small lattice, whose beads and strands often meet, at frames too, between two that do not."""
    exact = np.concatenate([CIRCLE, CIRCLE[:, [0, 2, 1]] + [1.0, 0, 0]])  # one leaves the other through corners of both
    (pair,) = audit([exact, exact + np.repeat([[0.0, 0, 0], [5, 0, 0]], 12, axis=0)], 12).meetings()
    assert (pair.passings, pair.linking) == (1, -linking(exact))
    rng, changed, touched = np.random.default_rng(6), 0, 0
    for _ in range(2):
        off = rng.normal(size=(2, 10, 3))  # at first and at last, beads are anywhere
        frames = [2.0 * off[0], *rng.integers(0, 3, size=(3, 10, 3)).astype(float), 2.0 * off[1]]
        found = audit(frames, 5)
        change = sum(pair.linking for pair in found.meetings(0) if pair.chains == (0, 1))
        assert change == linking(frames[-1]) - linking(frames[0])
        changed += change != 0
        touched += any((found.passings["time"] % 1.0 == 0.0) & (found.passings["sign"] != 0))
    assert (changed, touched) == (2, 2)


def test_rings_may_go_round_the_box():
    """An arm of one passes through the other; where an edge leaves the box is as good as any other place."""
    line = np.array([[0.5, 1.7, 2], [1.5, 1.7, 2], [2.5, 1.7, 2], [3.5, 1.7, 2]])
    arm = np.array([[0.5, 1.0, 0], [1.5, 1, 0], [2.5, 1, 0], [3.5, 1, 0]])
    frames = [np.concatenate([line, arm + np.array([0, 0, height])]) for height in (1.0, 3.0)]
    assert len(audit(frames, 4, box=[4, 4, 4]).passings) == 0  # they are parallel
    frames[1][5:7] += [0.0, 1.5, 0.0]
    report = audit(frames, 4, box=[4, 4, 4])
    assert report.passings["sign"].sum() == 0
    assert len(report.passings) == 2
    assert [each.before for each in report.meetings()] == [None]


def nan(points):
    return np.where(np.arange(points.size).reshape(points.shape) == 4, np.nan, points)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda points: points[:-1], "frame 2 has 23 beads and the first one 24; none may come or go"),
        (nan, "frame 2: bead 2 is not finite"),
        (lambda points: 0.0 * points, "frame 2: all beads are in one place"),
        (lambda points: points[:, :2], "frame 2 has shape (24, 2); frames are arrays"),
        (lambda points: [["x"]], "frame 2 is no array of numbers"),
    ],
)
def test_what_was_found_is_kept_when_a_trajectory_breaks_off(spoil, said):
    report = audit([HOPF, APART, spoil(APART), HOPF], 12)
    assert len(report.found) == len(report.passings) == 1
    assert said in report.problem


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"chains": 7}, "24 beads are not chains of 7 each"),
        ({"chains": [12, 13]}, "chains of 25 beads do not fit 24 beads"),
        ({"chains": [2] * 12}, "there are no chains"),
        ({}, "does not say which beads are chains"),
        ({"chains": 12, "box": [1, 2]}, "give three lengths"),
        ({"chains": 12, "box": "x"}, "box"),
        ({"chains": 12, "box": [10, -10, 10]}, "box has the lengths 10, -10, 10; give"),
        ({"chains": 12, "box": [1, np.nan, 1]}, "frame 0: the box is flat, or not finite"),
        ({"chains": 12, "box": [[1, 0, 0], [1, 0, 0], [0, 0, 1]]}, "frame 0: the box is flat"),
        ({"chains": 12, "box": [1e-30] * 3}, "more than 2³¹ boxes away"),
        ({"chains": 12, "box": [1, 1, 1]}, "neighbours on chain 1 are 0.5176 apart, half the box or more"),
    ],
)
def test_bad_questions_are_refused(arguments, said):
    with pytest.raises(MobiusFlowError, match=said):
        audit([HOPF, HOPF], **arguments)
    with pytest.raises(MobiusFlowError, match="there are no frames"):
        audit([], 12)
    with pytest.raises(MobiusFlowError, match="there is one frame only"):
        audit([HOPF], 12)
