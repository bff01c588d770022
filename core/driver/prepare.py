"""From a task and options to the start, and the problem that is solved; what is not the program's own is tried."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ..base import CurveError, FloatArray, IntArray, Message, OptionError, Place
from ..collision import is_rope, minimal_gap, rope_motion, thickness, written
from ..curve import TAUT, Curve, Mesh, Obstacle, arcs, at_edges, bending_radii, check_closed, free_edges, spans
from ..curve.refine import Resolution, graded_spacing, normalised
from ..descent import METHODS, Problem, Task
from ..energies import Term, TwiceDifferentiable, is_moebius_invariant
from ..energies.rope import Rope
from ..solve.metrics import Metric
from .options import RelaxOptions
from .solver import Solver


def start_problem(given: Task | Curve, options: RelaxOptions) -> Problem:
    """The problem of relaxing a refined task: target lengths, and its barycenter or pins, are prescribed.

    Raises CurveError if the curve has more vertices than the method has room and time for, and OptionError if options
    contradict each other.
    """
    task, method, options = Task.of(given), METHODS[options.method], options.resolved
    pins = task.held
    geometry = method.geometry
    if options.penalty is not None:
        if geometry.prescribes:
            raise OptionError(f"penalty is {options.penalty}; the method keeps lengths and has no penalty")
        geometry = replace(geometry, penalty=options.penalty)
    lengths = target_lengths(task.curve, pins.vertices, task.obstacles, options)
    if options.radius != "none" and not method.geometry.prescribes:
        raise OptionError(f"radius needs lengths that stay, but method {method.name} penalises them; leave it out")
    radius = rope_radius(task, options)
    problem = Problem.of(task.curve, lengths, pins, task.obstacles, Solver(options), geometry, radius=radius)
    about_minima, lacking = options.stability or options.escape_saddles, problem.objective.without_hessian
    if (method.rule.second_order or about_minima) and lacking is not None:
        raise OptionError(f"{method.name} with these options needs a second derivative; {lacking.name} has none")
    if about_minima and not method.geometry.prescribes:
        raise OptionError(f"stability is about constrained minima, but method {method.name} penalises lengths")
    if options.grow != 1.0:
        if not method.geometry.prescribes:
            told = f"grow prescribes lengths, but method {method.name} penalises them; choose another method"
            raise OptionError(told)
        if not len(free_edges(task.curve.mesh, pins.vertices)):
            raise OptionError(
                "grow changes lengths, but all edges lie between pinned vertices or on straight arcs between them; "
                "leave some of the pins out, or bend the arcs"
            )
        grown = problem.units.scale * problem.constraints.scaled(options.grow, task.curve.mesh).lengths
        _check_spans(task.curve, grown, pins.vertices, "grow")
    if options.balance:
        if task.pins:
            raise OptionError("balance would move pins, as Möbius maps do; leave one of the two out")
        terms = (term for term in problem.objective.terms if not isinstance(term, Rope))
        other = next((term for term in terms if not is_moebius_invariant(term)), None)
        if other is not None:
            told = f"balance takes Möbius images, which have another {other.name} than the curve; leave it out"
            raise OptionError(told)
        check_closed(task.curve, "Möbius images of equal energy, which balance takes,")
    check_foreign(problem, task.curve, options)
    return problem


def rope_radius(task: Task, options: RelaxOptions) -> FloatArray | None:
    """The radius of each component of a refined task as a rope, in the user's units; None if it is none.

    Raises OptionError if there are neither one nor as many as components, CurveError if the curve is not that thick.
    """
    curve, wanted, components = task.curve, options.radius, len(task.curve.mesh.component_sizes)
    if wanted == "none" or (wanted == "keep" and curve.dimension > 3):
        return None
    if not isinstance(wanted, str):
        given = np.ravel(wanted)
        if curve.dimension > 3:
            told = f"radius is for curves in the plane and in space, not in R^{curve.dimension}; leave it out"
            raise OptionError(told)
        if len(given) not in (1, components):
            told = f"radius has {len(given)} numbers; give one, or one for each component, of which there "
            raise OptionError(told + ("is one" if components == 1 else f"are {components}"))
        radius = np.broadcast_to(given, components).astype(np.float64)
        found = rope_motion(curve.mesh, curve.vertices, curve.vertices, radius, task.obstacles)
        if found.proved and _has_room(curve, radius):
            return radius
        contact, sharpest = found.contact, int(bending_radii(curve).argmin())
        place = at_edges(curve, contact.edges).position if contact else tuple(curve.vertices[sharpest])
        why = Message("it bends too sharply")
        if contact and contact.obstacle:
            why = Message("{obstacle} is in the way", obstacle=contact.obstacle)
        elif contact and curve.mesh.disjoint(*np.array(contact.edges)):
            why = Message("strands are too near to each other")
        kept = rope_radius(task, replace(options, radius="keep"))
        remedy = Message("make more room there")
        if kept is not None:
            less = "it is one of radius {kept:.4g}, so give a smaller radius, or more room"
            remedy = Message(less, kept=kept.min())
        thin = "the curve is no rope of radius {radius:.4g}: {why} near {place}; {remedy}"
        raise CurveError(
            Message(thin, radius=radius.max(), why=why, place=written(np.array(place)), remedy=remedy),
            Place((), place),  # vertices of the refined curve mean nothing to the user
        )
    bends, parts = bending_radii(curve), list[FloatArray]()
    for part, piece in zip(curve.components, curve.mesh.slices, strict=True):  # without vertices on edges
        corners = bends[piece] < 1e9 * curve.length
        corners[[0, -1]] |= not curve.mesh.closed[len(parts)]
        parts.append(part[corners] if corners.sum() > 2 else part)
    # no rope can be knotted or linked that is thicker for its length than the Hopf link's; circles could not move
    thickest = min(thickness(Curve.from_components(parts, curve.mesh.closed)), curve.length / (8.0 * np.pi))
    radius = np.full(components, 0.9 * thickest)
    for _ in range(40):  # less, where obstacles are nearer than strands, or the barrier has no room at a sharp corner
        if radius.max() <= 1e-9 * curve.length:
            return None
        if is_rope(curve.mesh, curve.vertices, curve.vertices, radius, task.obstacles) and _has_room(curve, radius):
            return radius
        radius *= 0.8
    return None


def _has_room(curve: Curve, radius: FloatArray) -> bool:
    """Whether the barrier is finite, with bends that the mesh allows."""
    return bool(np.isfinite(Rope(radius).frozen_at(curve).value(curve)))


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
    # edges are evened out if the longest is up to ten times the shortest and the gap between edges
    uneven = start.edge_lengths.max() > 10.0 * min(start.edge_lengths.min(), minimal_gap(start)[0])
    if wanted == "keep" or (wanted == "auto" and (uneven or obstacles)):
        return start.edge_lengths
    return equal_lengths(start.mesh, start.edge_lengths, pins)


def equal_lengths(mesh: Mesh, lengths: FloatArray, pins: IntArray) -> FloatArray:
    """The total length of every arc between pins, or component, spread evenly over its edges; shape (n,)."""
    even = np.empty_like(lengths)
    for arc in arcs(mesh, pins):
        even[arc] = lengths[arc].mean()
    return even


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


def check_foreign(problem: Problem, start: Curve, options: RelaxOptions) -> None:
    """Try the energy, terms and metric that are objects rather than names; start is in the user's units.

    A wrong sign would show as steps that never go down, which says nothing about the reason.  Raises OptionError with
    the numbers that do not fit.  Functions whose difference quotients do not settle, as they are not smooth, pass.
    """
    curve = start.with_vertices(problem.units.from_user(start.vertices))
    random = np.random.default_rng(35).standard_normal(curve.vertices.shape)
    for kind, term in (("energy", options.energy), *(("term", term) for term, _ in options.terms)):
        if not isinstance(term, Term):
            continue
        name, alone = f"{kind} {term.name!r}", term.value(curve)
        value, derivative = term.value_and_derivative(curve)
        if not (np.ndim(alone) == np.ndim(value) == 0 and np.isfinite([alone, value]).all()):
            raise OptionError(f"{name} is {alone!r:.60} at the start; its value must be one finite number there")
        if abs(alone - value) > 0.05 * max(abs(alone), abs(value)):
            raise OptionError(f"{name} is {alone:.6g} by value, and {value:.6g} by value_and_derivative at one curve")
        if np.shape(derivative) != random.shape or not np.isfinite(derivative).all():
            found = f"of shape {np.shape(derivative)}" if np.shape(derivative) != random.shape else "not finite"
            raise OptionError(f"{name} has a derivative that is {found}; give finite numbers, of shape {random.shape}")
        steepest = derivative / (float(np.linalg.norm(derivative)) or 1.0)
        direction: FloatArray = np.asarray(random / np.linalg.norm(random) + steepest, dtype=np.float64)
        _check_slope(name, term.value, np.asarray(np.sum(derivative * direction)), curve, direction)
        twice = METHODS[options.method].rule.second_order or options.stability or options.escape_saddles
        if twice and isinstance(term, TwiceDifferentiable):
            try:
                change = term.hessian_product(curve, direction)
            except TypeError as error:  # NumPy's, of functions for real numbers alone
                raise OptionError(f"{name} has no second derivative by complex steps: {error}") from None
            derivative_at = lambda at, term=term: term.value_and_derivative(at)[1]  # noqa: E731
            _check_slope(f"the derivative of {name}", derivative_at, change, curve, direction)
    if isinstance(options.metric, Metric):
        products = random.T @ problem.inner_product(curve).apply(random)
        norms, name = np.diagonal(products), options.metric.name
        if not (norms > 0.0).all():
            raise OptionError(f"metric {name!r} has ⟨u, u⟩ = {norms.min():.6g} for some u; it must be above 0")
        if not np.abs(products - products.T).max() <= 1e-6 * norms.max():
            told = f"⟨u, v⟩ = {products[0, 1]:.6g} and ⟨v, u⟩ = {products[1, 0]:.6g}"
            raise OptionError(f"metric {name!r} has {told} for some u and v; they must be equal")


def _check_slope(
    name: str, function: Callable[[Curve], float | FloatArray], slope: FloatArray, curve: Curve, direction: FloatArray
) -> None:
    """Raise unless a function's slope is what its values say, or these do not say any."""
    room = min(float(curve.edge_lengths.min()), minimal_gap(curve)[0]) / np.abs(direction).max()
    before = np.full(np.shape(slope), np.nan)
    # of difference quotients, in lengths of the shortest edge or gap
    for h in room * 10.0 ** -np.arange(3, 7):
        ahead, behind = (np.asarray(function(curve.with_vertices(curve.vertices + t * direction))) for t in (h, -h))
        with np.errstate(invalid="ignore"):  # what is infinite nearby has no slope
            quotient = (ahead - behind) / (2.0 * h)
            size, off = np.linalg.norm(quotient), np.linalg.norm(quotient - slope)
            settled = np.linalg.norm(quotient - before) <= 0.01 * size
        if off <= 0.05 * max(size, np.linalg.norm(slope)):
            return
        if settled:
            wrong_sign = np.linalg.norm(quotient + slope) <= 0.05 * size
            advice = "its derivative has the wrong sign" if wrong_sign else "correct its derivative"
            one, other = (" ".join(f"{x:.6g}" for x in np.ravel(each)[:3]) for each in (slope, quotient))
            raise OptionError(f"{name} has the slope {one} by its derivative and {other} by its values; {advice}")
        before = quotient
