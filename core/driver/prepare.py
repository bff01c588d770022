"""From a task and options to the problem that is solved."""

from collections.abc import Sequence

import numpy as np

from ..collision import minimal_gap
from ..curve import Curve, Mesh, check_closed
from ..curve.pins import TAUT, arcs, free_edges, spans
from ..curve.refine import Resolution
from ..curve.remesh import graded_spacing, normalised
from ..descent import METHODS, Method, Problem
from ..energies import is_moebius_invariant
from ..errors import OptionError
from ..obstacle import Obstacle
from ..task import Task
from ..types import FloatArray, IntArray
from .options import RelaxOptions
from .solver import Solver

EVEN_RATIO = 10.0  # of the longest edge to the shortest, and to the gap between edges, up to which they are evened out


def start_problem(given: Task | Curve, options: RelaxOptions) -> Problem:
    """The problem of relaxing a refined task: target lengths, and its barycenter or pins, are prescribed.

    Raises CurveError if the curve has more vertices than the method has room and time for, and OptionError if options
    contradict each other.
    """
    task, method = Task.of(given), METHODS[options.method]
    pins = task.held
    geometry = method.geometry if options.penalty is None else method.geometry.weighted(options.penalty)
    lengths = target_lengths(task.curve, pins.vertices, task.obstacles, options)
    problem = Problem.of(task.curve, lengths, pins, task.obstacles, Solver(options), geometry)
    _check_second_order(problem, options, method)
    if options.grow != 1.0:
        _check_growth(task.curve, problem, options, method)
    if options.balance:
        _check_balance(task, problem)
    return problem


def _check_second_order(problem: Problem, options: RelaxOptions, method: Method) -> None:
    about_minima = options.stability or options.escape_saddles
    lacking = problem.objective.without_hessian
    if (method.rule.second_order or about_minima) and lacking is not None:
        raise OptionError(f"{method.name} with these options needs a second derivative; {lacking.name} has none")
    if about_minima and not method.geometry.prescribes:
        raise OptionError(f"stability is about constrained minima, but method {method.name} penalises lengths")


def _check_balance(task: Task, problem: Problem) -> None:
    if task.pins:
        raise OptionError("balance would move pins, as Möbius maps do; leave one of the two out")
    term = next((term for term in problem.objective.terms if not is_moebius_invariant(term)), None)
    if term is not None:
        raise OptionError(f"balance takes Möbius images, which have another {term.name} than the curve; leave it out")
    check_closed(task.curve, "Möbius images of equal energy, which balance takes,")


def target_lengths(start: Curve, pins: IntArray, obstacles: Sequence[Obstacle], options: RelaxOptions) -> FloatArray:
    """Target edge lengths in the user's units; shape (edges,)."""
    wanted = options.edge_lengths
    if not isinstance(wanted, str):
        edges = start.mesh.edges
        if len(wanted) != edges:
            raise OptionError(
                f"edge_lengths has {len(wanted)} numbers, but the refined curve has {edges} edges; "
                f"give one for each edge, and vertices={len(wanted) + len(start) - edges}"
            )
        lengths = np.array(wanted)
        _check_spans(start, lengths, pins)
        return lengths
    if options.mesh == "adaptive":
        return normalised(start, graded_spacing(start, Resolution(options.vertices)), pins)
    uneven = start.edge_lengths.max() > EVEN_RATIO * min(start.edge_lengths.min(), minimal_gap(start)[0])
    if wanted == "keep" or (wanted == "auto" and (uneven or obstacles)):
        return start.edge_lengths
    return equal_lengths(start.mesh, start.edge_lengths, pins)


def equal_lengths(mesh: Mesh, lengths: FloatArray, pins: IntArray) -> FloatArray:
    """The total length of every arc between pins, or component, spread evenly over its edges; shape (n,)."""
    even = np.empty_like(lengths)
    for arc in arcs(mesh, pins):
        even[arc] = lengths[arc].mean()
    return even


def _check_growth(start: Curve, problem: Problem, options: RelaxOptions, method: Method) -> None:
    """Refuse to change lengths that are not prescribed, or cannot change by the requested factor."""
    pins = problem.constraints.pins.vertices
    if not method.geometry.prescribes:
        raise OptionError(f"grow prescribes lengths, but method {method.name} penalises them; choose another method")
    if not len(free_edges(start.mesh, pins)):
        raise OptionError(
            "grow changes lengths, but all edges lie between pinned vertices or on straight arcs between them; "
            "leave some of the pins out, or bend the arcs"
        )
    lengths = problem.units.scale * problem.constraints.scaled(options.grow, start.mesh).lengths
    _check_spans(start, lengths, pins, "grow")


def _check_spans(start: Curve, lengths: FloatArray, pins: IntArray, option: str = "edge_lengths") -> None:
    """Refuse target lengths from an option with which an arc does not reach from pin to pin, or only barely does."""
    for span in spans(start, pins):
        i, j = (end + 1 for end in span.ends)
        wanted = float(lengths[span.edges].sum())
        if len(span.edges) == 1 and abs(wanted - span.length) > TAUT * span.length:
            raise OptionError(f"{option} changes the edge between vertices {i} and {j}, which are both pinned")
        if len(span.edges) > 1 and wanted <= (1.0 + TAUT) * span.distance:
            ratio = wanted / span.distance
            raise OptionError(
                f"{option} makes the arc between vertices {i} and {j}, which are pinned, {ratio:.6g} times as long "
                "as their distance; give it more than that"
            )
