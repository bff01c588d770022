"""What is public takes any nonsense: it works or ends in a sentence, and its values are short."""

import enum
import inspect
from collections.abc import Callable

import numpy as np
import pytest
import scipy.sparse as sp
from mobius_flow import core
from mobius_flow.core import (
    Curve,
    Iterate,
    Mesh,
    MobiusFlowError,
    Obstacle,
    Outcome,
    RelaxOptions,
    Result,
    Status,
    Trajectory,
    WithOutcome,
    curve,
    energies,
    io,
    knots,
    minimize,
    relax,
)
from mobius_flow.core.base.arguments import checked
from mobius_flow.core.driver.info import info, measure
from mobius_flow.core.energies import Objective, moebius_kpoint
from mobius_flow.core.proof import verify
from mobius_flow.core.solve import metrics
from mobius_flow.lab.compare.comparison import compare
from mobius_flow.lab.extrapolation import Extrapolation, extrapolated
from shapes import torus_trefoil

NONSENSE = [5, -1, 10**400, 2.5, float("nan"), 1j, None, True, "x", "", b"x", [], [1, 2, 3], ["x"], {}, object(), Curve]
NONSENSE += [np.zeros((2, 2)), np.array("x")]
SHORT = RelaxOptions(max_iterations=0, vertices=20)
TREFOIL = torus_trefoil(20)
ARC = Curve([[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [2.0, 0.0, 0.0]], Mesh((3,), (False,)))
PLANAR = Curve(torus_trefoil(20).vertices[:, :2])
START = next(relax(TREFOIL, SHORT))
WALL = Obstacle([[9.0, 0.0, 0.0], [9.0, 1.0, 0.0], [9.0, 0.0, 1.0]], [[0, 1, 2]], "wall")
RULE = energies.Rule.gauss(1)

# arguments that are fine, but for values that are written to or take long
FINE: dict[str, tuple[Callable[..., object], dict[str, object]]] = {
    "Curve": (Curve, {"vertices": np.eye(3), "mesh": Mesh((3,))}),
    "Curve.from_components": (Curve.from_components, {"components": [np.eye(3)], "closed": (True,)}),
    "Curve.with_vertices": (TREFOIL.with_vertices, {"vertices": TREFOIL.vertices}),
    "Mesh": (Mesh, {"component_sizes": (3,), "closed": (True,)}),
    "Obstacle": (Obstacle, {"vertices": np.eye(3), "faces": [[0, 1, 2]], "name": "wall"}),
    "MoebiusEnergy": (core.MoebiusEnergy, {"without": None}),
    "Objective": (Objective, {"energy": core.MoebiusEnergy(), "barrier": energies.Barrier(), "further": ()}),
    "Barrier": (energies.Barrier, {"replaces_midpoint": True, "left_out": False}),
    "KPointEnergy": (
        energies.KPointEnergy,
        {"name": "a", "description": "b", "density": moebius_kpoint(2).density, "rule": RULE},
    ),
    "Rule": (energies.Rule, {"points": (0.5,), "weights": (1.0,)}),
    "Rule.gauss": (energies.Rule.gauss, {"points": 2}),
    "moebius_kpoint": (moebius_kpoint, {"points": 2}),
    "MoebiusMetric": (metrics.MoebiusMetric, {"rule": RULE}),
    "DenseInnerProduct": (metrics.DenseInnerProduct, {"matrix": np.eye(3)}),
    "SparseInnerProduct": (metrics.SparseInnerProduct, {"matrix": sp.csr_array(np.eye(3))}),
    "Task": (core.Task, {"curve": TREFOIL, "obstacles": (WALL,), "pins": (0, 5), "pin_tangents": True}),
    "RelaxOptions": (RelaxOptions, vars(SHORT)),
    "relax": (relax, {"curve": TREFOIL, "options": SHORT, "hand": core.Hand()}),
    "Hand": (core.Hand, {"stays": True}),
    "Hand.grab": (core.Hand().grab, {"component": 0, "share": 0.5}),
    "Hand.move": (core.Hand().move, {"target": (0.0, 0.0, 1.0)}),
    "Hand.release": (core.Hand().release, {"pin": True}),
    "minimize": (minimize, {"curve": TREFOIL, "options": SHORT, "callback": lambda *_: None}),
    "morph": (core.morph, {"a": TREFOIL, "b": TREFOIL, "options": SHORT, "callback": lambda *_: None}),
    "separate": (
        core.separate,
        {"curve": ARC, "radius": 0.01, "over": "z", "lengths": "keep", "free_ends": True, "callback": lambda *_: None},
    ),
    "tighten": (core.tighten, {"curve": ARC, "vertices": 100, "starts": 1, "seed": 0, "callback": lambda *_: None}),
    "audit": (
        core.audit,
        {
            "trajectory": [TREFOIL.vertices, TREFOIL.vertices],
            "chains": 20,
            "closed": True,
            "box": [99.0, 99.0, 99.0],
            "processes": 1,
            "callback": lambda *_: None,
        },
    ),
    "Iterate": (Iterate, vars(START)),
    "Outcome": (Outcome, {"status": Status.STALLED, "clauses": ("stuck",), "place": None}),
    "Result": (Result, vars(minimize(TREFOIL, SHORT))),
    "WithOutcome": (WithOutcome, {"relaxation": relax(TREFOIL, SHORT)}),
    "Trajectory": (Trajectory, {"provenance": {}, "obstacles": (WALL,)}),
    "Trajectory.add": (Trajectory().add, {"iterate": START}),
    "Trajectory.save": (Trajectory().save, {"path": "t.npz"}),
    "read_curve": (core.read_curve, {"path": "missing.txt"}),
    "knot_list": (core.knot_list, {"path": "missing.csv"}),
    "write_curve": (core.write_curve, {"path": "c.txt", "curve": TREFOIL, "form": None}),
    "read_obstacle": (core.read_obstacle, {"path": "missing.obj"}),
    "refine": (curve.refine, {"curve": TREFOIL, "vertices": 30}),
    "compare": (compare, {"curve": TREFOIL, "methods": ["cg"], "options": SHORT, "time_limit": 1.0, "stages": ()}),
    "info": (info, {"curve": TREFOIL}),
    "measure": (measure, {"curve": TREFOIL, "energy": "edge"}),
    "Extrapolation": (Extrapolation, {"energies": (3.0, 2.0, 1.5)}),
    "extrapolated": (extrapolated, {"curve": TREFOIL, "options": SHORT}),
    "verify": (verify, {"path": "missing.npz", "callback": lambda *_: None}),
    "knot": (knots.knot, {"name": "3_1", "vertices": 20}),
    "knot_type": (knots.knot_type, {"curve": TREFOIL, "effort": knots.Effort()}),
    "Effort": (knots.Effort, {"vertices": 1000, "views": 3, "work": 5000}),
    "smooth_knot": (knots.smooth_knot, {"name": "3_1", "vertices": 20}),
    "rounded": (knots.rounded, {"curve": TREFOIL, "least": 40}),
    "torus_knot": (knots.torus_knot, {"p": 2, "q": 3, "vertices": 20, "major": 1.0, "minor": 0.3}),
    "lissajous_knot": (
        knots.lissajous_knot,
        {"frequencies": (2, 3, 7), "phases": (0.7, 0.2), "vertices": 200},
    ),
    "braid_closure": (knots.braid_closure, {"word": (1, 1, 1), "vertices": 20, "strands": 2}),
    "braid_word": (knots.braid_word, {"name": "3_1"}),
    "cable": (knots.cable, {"companion": torus_trefoil(60), "p": 2, "q": 1, "vertices": 200}),
    "double": (knots.double, {"companion": torus_trefoil(60), "twists": 0, "clasp": 1, "vertices": 200}),
    "scramble": (
        knots.scramble,
        {"curve": TREFOIL, "seed": 1, "moves": 2, "reach": 0.1, "gap": 0.01, "least_angle": 0.2},
    ),
    "overhand": (knots.overhand, {"vertices": 40}),
    "freedman": (knots.freedman, {"vertices": 500}),
    "Drawing.of": (knots.Drawing.of, {"curve": PLANAR}),
    "Drawing.seen": (knots.Drawing.seen, {"curve": TREFOIL}),
}
# not made by users
OF_THE_PROGRAM = {"CurveFile", "Weighted", "Format", "KnotType", "Drawing", "format_of", "load_curve", "check_closed"}
OF_THE_PROGRAM |= {"at_edges", "at_vertices", "Audit", "weighted_term"}


def test_all_that_is_public_is_tried():
    public = {
        name
        for room in (core, curve, io, knots, energies, metrics)
        for name in getattr(room, "__all__", vars(room))
        if callable(found := getattr(room, name))
        and (hasattr(room, "__all__") or found.__module__.startswith(room.__name__))
        and not (isinstance(found, type) and issubclass(found, Exception | enum.Enum))
        and not getattr(found, "_is_protocol", False)
        and any(each.annotation is not object for each in inspect.signature(found).parameters.values())
    }
    assert public - OF_THE_PROGRAM - set(FINE) == set()


@pytest.mark.parametrize("name", FINE)
def test_nonsense_ends_in_one_sentence(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    function, fine = FINE[name]
    ends = {
        f"{parameter}={value!r:.60}": _end(function, fine | {parameter: value})
        for parameter in fine
        for value in NONSENSE
        if not (parameter == "callback" and callable(value))
    }
    assert {call: end for call, end in ends.items() if end not in ("fine", "refused")} == {}
    assert "refused" in ends.values()


def _end(function, arguments):
    """How a call ends; warnings are errors."""
    try:
        function(**arguments)
    except MobiusFlowError as error:
        return "refused" if "\n" not in str(error) and len(str(error)) < 600 else f"not one sentence: {error}"
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return "fine"


@checked
def bake(cakes: int, heat: float = 180.0, shelf: str | None = None, *names: str, fan: Callable[[], None] = list) -> int:
    """Any function."""
    return cakes


@pytest.mark.parametrize(
    ("arguments", "keywords", "said"),
    [
        ((2.5,), {}, "cakes is 2.5; give a whole number"),
        ((True,), {}, "cakes is True; give a whole number"),
        ((1, "hot"), {}, "heat is 'hot'; give a number"),
        ((1,), {"shelf": 3}, "shelf is 3; give a string or None"),
        ((1,), {"shelf": [1]}, "shelf is of type list; give a string or None"),
        ((1,), {"fan": 3}, "fan is 3; give a function"),
    ],
)
def test_the_argument_is_named(arguments, keywords, said):
    with pytest.raises(MobiusFlowError) as error:
        bake(*arguments, **keywords)
    assert str(error.value) == said


def test_a_call_that_does_not_fit_is_pythons_own_error_and_numpys_numbers_are_numbers():
    with pytest.raises(TypeError, match=r"^bake\(\) missing 1 required positional argument: 'cakes'$"):
        bake()
    with pytest.raises(TypeError, match=r"^bake\(\) got an unexpected keyword argument 'tins'$"):
        bake(1, tins=3)
    assert bake(np.int64(3), np.float32(0.5), None) == 3
    assert bake.__doc__ == "Any function."


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (TREFOIL, "<Curve: 1 closed polygon, 20 vertices in R^3>"),
        (Mesh((3,) * 1000), "Mesh((3, 3, 3, 3, 3, 3, ...), closed=(True, True, True, True, True, True, ...))"),
        (WALL, "<Obstacle 'wall': 1 faces, 3 vertices>"),
        (RelaxOptions(), "RelaxOptions()"),
        (RelaxOptions(method="cg", vertices=9), "RelaxOptions(method='cg', vertices=9)"),
        (RelaxOptions(edge_lengths=[1.0] * 999), "RelaxOptions(edge_lengths=(1.0, 1.0, 1.0, 1.0, 1.0, 1.0, ...))"),
        (Outcome(Status.STALLED, ("stuck",)), "<Outcome: stuck>"),
        (Trajectory(), "<Trajectory: 0 stages, 0 frames>"),
    ],
)
def test_values_show_as_a_line(value, said):
    assert repr(value) == said


def test_what_is_public_has_a_docstring():
    exported = {name: getattr(core, name) for name in core.__all__}
    members = {
        f"{owner}.{name}": getattr(member, "__func__", member)
        for owner, each in exported.items()
        if inspect.isclass(each)
        for name, member in vars(each).items()
        if not name.startswith("_")
    }
    wanted = {
        name: each
        for name, each in (exported | members).items()
        if inspect.isroutine(each) or inspect.isclass(each) or isinstance(each, property)
    }
    assert len(wanted) > 60
    assert not [name for name, each in wanted.items() if not inspect.getdoc(each)]
