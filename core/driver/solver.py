"""Dense or hierarchical: how sums over all pairs of edges are made, and what is solved with them."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

from ..checks import named
from ..curve import Curve
from ..descent import METHODS, Method
from ..energies import ENERGIES, TERMS, Energy, MoebiusEnergy, Objective, Stiff, Term, Weighted
from ..errors import CurveError, OptionError
from ..hierarchy import HierarchicalMoebiusEnergy, compressed
from ..hierarchy.inner_product import MAX_VERTICES, block_count
from ..messages import VERTEX_COUNT, Message
from ..metrics import METRICS, Metric
from ..obstacle import Obstacle
from ..quadrature import Rule
from ..saddle.iterative import Tolerances
from .options import RelaxOptions

# vertices up to which dense iterations are faster on any curve, and from which on hierarchical ones are
DENSE_UP_TO, HIERARCHICAL_FROM = 1000, 5000
# Between these it is what is counted: all n² pairs of edges, or the blocks of the inner product.  Of these there are as
# many as conjugate gradients have work with, for they are many where strands are near and iterations are too.
PAIRS_PER_BLOCK = 1700  # that take as long as one of them, by `benchmarks/speed.py` on knots and tangles


@dataclass(frozen=True)
class Solver:
    """The energy and the metrics of a relaxation.

    Parameters
    ----------
    options
        What is asked for.
    hierarchical
        Whether distant pairs of edges count cluster by cluster.

    Raises
    ------
    OptionError
        If an option names something unknown, or does not go together with the solver that is asked for.
    """

    options: RelaxOptions
    hierarchical: bool = False

    def on(self, curve: Curve) -> "Solver":
        """The solver for a curve: the one asked for, or the faster one; a CurveError if it has too many vertices."""
        check_size(curve, self.options)
        wanted = self.options.solver == "hierarchical"
        return Solver(self.options, _may_be_hierarchical(self.options) and (wanted or _pays(curve)))

    def objective(self, obstacles: Iterable[Obstacle] = ()) -> Objective:
        """What is minimised among obstacles, which are in the units of curves."""
        energy = _energy(self.options)
        further = (_weighted(_term(term), weight) for term, weight in self.options.terms)
        energy = HierarchicalMoebiusEnergy.instead_of(energy) if self.hierarchical else energy
        return Objective.of(energy, obstacles, further)

    @property
    def metric(self) -> Metric:
        """The metric of the method, or the one that is asked for in its place.

        Raises
        ------
        OptionError
            If a quadrature rule is asked for, and it has none, or a metric, and the method has another in its name.
        """
        method, points = _method(self.options), self.options.quadrature_points
        metric = _metric(method, self.options)
        kind, dash, own = method.name.rpartition(f"-{method.metric.name}")
        if isinstance(self.options.metric, str) and dash and not own and metric is not method.metric:
            raise OptionError(
                f"method {method.name} and metric {metric.name} contradict each other; "
                f"leave the metric out, or choose method {kind}-{metric.name}"
            )
        if points is not None and metric.rule is None:
            raise OptionError(f"quadrature_points is {points}; metric {metric.name!r} has no such rule")
        return self.of_metric(metric)

    def of_metric(self, metric: Metric) -> Metric:
        """A metric in the form that is solved with, and by the quadrature rule if it has any."""
        points = self.options.quadrature_points
        # the energy's own rule, as Section 6.1.2 of [RS21] has it, unless another one is asked for
        metric = metric.with_rule(_energy(self.options).rule if points is None else Rule.gauss(points))
        return compressed(metric, Tolerances.of_norms(self.options.accuracy)) if self.hierarchical else metric


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
        large = (
            "the curve has {vertices}; {method} has room and time for {most}; thin it out or relax its parts separately"
        )
        raise CurveError(Message(large, vertices=Message(VERTEX_COUNT, count=len(curve)), method=method, most=most))


def max_vertices(options: RelaxOptions, wanted: int) -> int:
    """Number of vertices for which there is room and time, if so many are wanted; raises as `Solver` does."""
    method = _method(options)
    metric = _metric(method, options)
    if _may_be_hierarchical(options) and (options.solver == "hierarchical" or wanted > HIERARCHICAL_FROM):
        own = compressed(metric, Tolerances()).most_vertices if isinstance(options.metric, Metric) else MAX_VERTICES
        return min(MAX_VERTICES, own)
    metrics = (metric, *method.rule.other_metrics)
    return min(metric.most_vertices for metric in metrics)


def _may_be_hierarchical(options: RelaxOptions) -> bool:
    obstacle = None if options.solver == "dense" else _obstacle(options, _method(options))
    if obstacle is not None and options.solver == "hierarchical":
        raise OptionError(f"{obstacle}; solver={options.solver!r} does without: leave it out")
    return options.solver != "dense" and obstacle is None


@lru_cache(maxsize=1)
def _pays(curve: Curve) -> bool:
    """Whether hierarchical iterations are likely to be faster, from what they count: the same on all machines."""
    n = len(curve)
    if not DENSE_UP_TO < n <= HIERARCHICAL_FROM:
        return n > HIERARCHICAL_FROM
    return PAIRS_PER_BLOCK * block_count(curve) < n * n


def _obstacle(options: RelaxOptions, method: Method) -> str | None:
    """What needs dense matrices."""
    rule = method.rule
    if rule.second_order:
        return f"{method.name} needs exact second derivatives"
    if rule.other_metrics:
        return f"{method.name} needs a sum of metrics"
    if not isinstance(_energy(options), MoebiusEnergy):
        return f"energy {_energy(options).name!r} needs all pairs of edges one by one"
    if options.quadrature_points not in (None, 1):
        return f"{options.quadrature_points} Gauss points need all pairs of edges one by one"
    return None


def _method(options: RelaxOptions) -> Method:
    return named(METHODS, "method", options.method)


def _term(term: str | Term) -> Term:
    return named(TERMS, "term", term) if isinstance(term, str) else term


def _weighted(term: Term, weight: float) -> Weighted:
    if weight < 0.0 and isinstance(term, Stiff):
        raise OptionError(
            f"term {term.name!r} has weight {weight:g}, with which its stiffness is no part of a metric; "
            "give a weight of 0 or more"
        )
    return Weighted(term, weight)


def _energy(options: RelaxOptions) -> Energy:
    return named(ENERGIES, "energy", options.energy) if isinstance(options.energy, str) else options.energy


def _metric(method: Method, options: RelaxOptions) -> Metric:
    wanted = method.metric if options.metric is None else options.metric
    return named(METRICS, "metric", wanted) if isinstance(wanted, str) else wanted
