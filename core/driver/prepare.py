"""From a curve and options to the problem that is solved."""

import logging
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..checks import named
from ..collision import check_clear, check_embedded, check_gap, minimal_gap, survives_rounding
from ..constraints import Constraints, weighted_barycenter
from ..curve import Curve, Mesh, check_closed, refine
from ..curve.pins import NO_PINS, TAUT, Pins, arcs, free_edges, spans
from ..curve.refine import Resolution
from ..curve.remesh import graded_spacing, normalised
from ..descent import METHODS, Method, Point, Problem
from ..energies import Objective
from ..errors import CurveError, CurveOptionError, OptionError
from ..obstacle import Obstacle
from ..types import FloatArray, IntArray
from ..units import Units, check_units
from .options import RelaxOptions
from .solver import Solver, max_vertices

_log = logging.getLogger(__name__)

EVEN_RATIO = 10.0  # of the longest edge to the shortest, and to the gap between edges, up to which they are evened out


def check_size(curve: Curve, options: RelaxOptions) -> None:
    """Refuse more vertices than the method's inner products have room for, before anything is made of them.

    Raises
    ------
    CurveError, OptionError
        If the curve has too many vertices, or too many are asked for.
    """
    most, method = max_vertices(options, max(len(curve), options.vertices or 0)), options.method
    if options.vertices is not None and options.vertices > most:
        raise OptionError(f"vertices is {options.vertices!s:.40}; {method} has room and time for {most}")
    if len(curve) > most:
        raise CurveError(
            f"the curve has {len(curve)} vertices; {method} has room and time for {most}; "
            "thin the curve out or relax its components apart"
        )


def prepared_start(curve: Curve, vertices: int | None, each: Sequence[RelaxOptions]) -> Curve:
    """The refined curve, from which relaxations can start whose options differ by their methods only.

    Raises
    ------
    CurveError
        If the curve touches itself or an obstacle, or is degenerate, or too large.
    OptionError
        If an option does not fit it.
    """
    for options in each:
        check_size(curve, options)
    check_units(curve)
    check_embedded(curve)
    obstacles = each[0].avoid
    check_clear(curve, obstacles)
    refined = refine(curve, vertices)
    check_refined(curve, refined, obstacles)
    return refined


def pins_of(curve: Curve, refined: Curve, options: RelaxOptions) -> Pins:
    """Those that options about a curve ask for, on the refined curve.

    Raises
    ------
    CurveOptionError
        If the curve has no such vertex.
    OptionError
        If tangents are to be pinned where no vertex is.
    """
    if options.pin_tangents and not options.pins:
        raise OptionError("pin_tangents holds the neighbours of pinned vertices, but there are no pins; give some")
    if not options.pins:
        return NO_PINS
    last = max(options.pins)
    if last >= len(curve):
        raise CurveOptionError(f"pins asks for vertex {last + 1}, but the curve has {len(curve)} vertices")
    pins = Pins.at(refined, curve.vertices[list(options.pins)])
    if len(pins) > len(options.pins):
        more = len(pins) - len(options.pins)
        _log.warning("%d of %d vertices are on straight arcs between pins, and held as well", more, len(refined))
    return pins.with_neighbours(refined) if options.pin_tangents else pins


def check_refined(curve: Curve, refined: Curve, obstacles: Sequence[Obstacle]) -> None:
    """Refuse a refined curve that is not what the curve was, or that cannot be computed with.

    Raises
    ------
    CurveError
        If strands are too near to compute with, or the new vertices, rounded to doubles, might not be on their edges
        for all that matters.
    """
    if len(refined) > len(curve) and not survives_rounding(refined, obstacles):
        raise CurveError(
            "the curve is so far from the origin, or has strands so near to each other, that there are too few digits "
            "for vertices to be inserted; move it nearer to the origin, or its strands apart"
        )
    check_gap(refined)


def start_problem(curve: Curve, options: RelaxOptions, pins: Pins | None = None) -> Problem:
    """The problem of relaxing a refined curve: target lengths, and its barycenter or pins, are prescribed.

    Parameters
    ----------
    pins
        Vertices of it that are held; by default those that the options name.

    Raises
    ------
    CurveError
        If the curve has more vertices than the method has room and time for.
    OptionError
        If an option names something unknown, or a method and an energy do not go together.
    """
    method = named(METHODS, "method", options.method)
    check_size(curve, options)
    units = Units.of(curve)
    start = curve.with_vertices(units.from_user(curve.vertices))
    pins = pins_of(curve, curve, options) if pins is None else pins
    lengths = _target_lengths(start, options, units.scale, pins.vertices)
    constraints = Constraints(lengths, weighted_barycenter(start, pins=pins.vertices), pins=pins)
    solver = Solver.for_curve(options, curve)
    objective = Objective.of(solver.energy, map(units.obstacle_from_user, options.avoid))
    second_order = method.rule.second_order or options.stability or options.escape_saddles
    if second_order and not objective.has_hessian:
        name = objective.energy.name
        raise OptionError(f"{method.name} with these options needs a second derivative; energy {name} has none")
    if options.grow != 1.0:
        _check_growth(start, constraints, options, method)
    if (options.stability or options.escape_saddles) and not method.geometry.prescribes:
        raise OptionError(f"stability is about constrained minima, but method {method.name} penalises lengths")
    if options.balance and objective.energy.scale_exponent != 0.0:
        name = objective.energy.name
        raise OptionError(f"balance takes Möbius images for curves of equal energy; that is not so for energy {name}")
    if options.balance:
        check_closed(curve, "Möbius images of equal energy, which balance takes,")
    geometry = method.geometry if options.penalty is None else method.geometry.weighted(options.penalty)
    return Problem(curve.mesh, objective, solver.metric, constraints, units, geometry, options.avoid)


def on_mesh(problem: Problem, curve: Curve, options: RelaxOptions) -> Point:
    """The point of a curve in the user's units in the same problem on its own mesh; raises as `start_problem` does."""
    pins = problem.constraints.pins.on(curve)
    return with_parts_of(problem, start_problem(curve, replace(options, grow=1.0), pins), curve)


def with_parts_of(problem: Problem, other: Problem, curve: Curve) -> Point:
    """The point of a curve in another problem, with the parts held in place that ``problem`` holds, grown as much."""
    parts, grown = problem.constraints.parts, problem.constraints.grown
    other = replace(other, constraints=replace(other.constraints, grown=grown))
    if parts is not None:
        own_units = curve.with_vertices(other.units.from_user(curve.vertices))
        other = replace(other, constraints=other.constraints.of_parts(own_units, parts))
    return other.at_curve(curve)


def _target_lengths(start: Curve, options: RelaxOptions, scale: float, pins: IntArray) -> FloatArray:
    """In the program's units, of which one is ``scale`` of the user's."""
    if not isinstance(options.edge_lengths, str):
        given, edges = len(options.edge_lengths), start.mesh.edges
        if given != edges:
            raise OptionError(
                f"edge_lengths has {given} numbers, but the refined curve has {edges} edges; "
                f"give one for each edge, and vertices={given + len(start) - edges}"
            )
        lengths = np.array(options.edge_lengths) / scale
        _check_spans(start, lengths, pins)
        return lengths
    if options.mesh == "adaptive":
        return normalised(start, graded_spacing(start, Resolution(options.vertices)), pins)
    uneven = start.edge_lengths.max() > EVEN_RATIO * min(start.edge_lengths.min(), minimal_gap(start)[0])
    if options.edge_lengths == "keep" or (options.edge_lengths == "auto" and (uneven or options.avoid)):
        return start.edge_lengths
    return equal_lengths(start.mesh, start.edge_lengths, pins)


def equal_lengths(mesh: Mesh, lengths: FloatArray, pins: IntArray) -> FloatArray:
    """The total length of every arc between pins, or component, spread evenly over its edges; shape (n,)."""
    even = np.empty_like(lengths)
    for arc in arcs(mesh, pins):
        even[arc] = lengths[arc].mean()
    return even


def _check_growth(start: Curve, constraints: Constraints, options: RelaxOptions, method: Method) -> None:
    """Refuse to change lengths that are not prescribed, or cannot change by the factor that is asked for."""
    pins = constraints.pins.vertices
    if not method.geometry.prescribes:
        raise OptionError(f"grow prescribes lengths, but method {method.name} penalises them; choose another method")
    if not len(free_edges(start.mesh, pins)):
        raise OptionError(
            "grow changes lengths, but all edges lie between pinned vertices or on straight arcs between them; "
            "leave some of the pins out, or bend the arcs"
        )
    _check_spans(start, constraints.scaled(options.grow, start.mesh).lengths, pins, "grow")


def _check_spans(start: Curve, lengths: FloatArray, pins: IntArray, option: str = "edge_lengths") -> None:
    """Refuse target lengths, made by an option, with which an arc does not reach from pin to pin, or only just."""
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
