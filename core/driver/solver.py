"""Dense or hierarchical: how sums over all pairs of edges are made, and what is solved with them."""

from functools import lru_cache

from ..checks import named
from ..curve import Curve
from ..descent import METHODS, Method, Problem
from ..energies import ENERGIES, Energy, MoebiusEnergy
from ..errors import OptionError
from ..hierarchy import HierarchicalMoebiusEnergy, compressed
from ..hierarchy.inner_product import block_count
from ..hierarchy.metric import MAX_VERTICES
from ..metrics import METRICS, Metric
from ..quadrature import Rule
from ..saddle.iterative import Tolerances
from .options import RelaxOptions

# vertices up to which dense iterations are faster on any curve, and from which on hierarchical ones are
DENSE_UP_TO, HIERARCHICAL_FROM = 1000, 5000
# Between these it is what is counted: all n² pairs of edges, or the blocks of the inner product.  Of these there are as
# many as conjugate gradients have work with, for they are many where strands are near and iterations are too.
PAIRS_PER_BLOCK = 1700  # that take as long as one of them, by `bench speed` on knots and tangles


class Solver:
    """The energy and the metrics of a relaxation.

    Parameters
    ----------
    options
        What is asked for.
    hierarchical
        Whether distant pairs of edges count cluster by cluster.
    """

    def __init__(self, options: RelaxOptions, hierarchical: bool) -> None:
        self._options, self.hierarchical = options, hierarchical
        self._method = named(METHODS, "method", options.method)

    @classmethod
    def for_curve(cls, options: RelaxOptions, curve: Curve) -> "Solver":
        """That with which a curve is relaxed: the one asked for, or the faster one.

        Raises
        ------
        OptionError
            If an option names something unknown, or does not go together with the solver that is asked for.
        """
        return cls(options, _may_be_hierarchical(options) and (options.solver == "hierarchical" or _pays(curve)))

    @classmethod
    def of_problem(cls, options: RelaxOptions, problem: Problem) -> "Solver":
        """That with which a problem is solved already."""
        return cls(options, isinstance(problem.objective.energy, HierarchicalMoebiusEnergy))

    @property
    def energy(self) -> Energy:
        """What is minimised."""
        energy = _energy(self._options)
        return HierarchicalMoebiusEnergy.instead_of(energy) if self.hierarchical else energy

    @property
    def metric(self) -> Metric:
        """The metric of the method, or the one that is asked for in its place.

        Raises
        ------
        OptionError
            If a quadrature rule is asked for, and it has none, or a metric, and the method has another in its name.
        """
        metric, points = _metric(self._method, self._options), self._options.quadrature_points
        kind, dash, own = self._method.name.rpartition(f"-{self._method.metric.name}")
        if isinstance(self._options.metric, str) and dash and not own and metric is not self._method.metric:
            raise OptionError(
                f"method {self._method.name} and metric {metric.name} contradict each other; "
                f"leave the metric out, or choose method {kind}-{metric.name}"
            )
        if points is not None and metric.rule is None:
            raise OptionError(f"quadrature_points is {points}; metric {metric.name!r} has no such rule")
        return self.of_metric(metric)

    def of_metric(self, metric: Metric) -> Metric:
        """A metric in the form that is solved with, and by the quadrature rule if it has any."""
        points = self._options.quadrature_points
        # the energy's own rule, as Section 6.1.2 of [RS21] has it, unless another one is asked for
        metric = metric.with_rule(_energy(self._options).rule if points is None else Rule.gauss(points))
        return compressed(metric, Tolerances.of_norms(self._options.accuracy)) if self.hierarchical else metric


def max_vertices(options: RelaxOptions, wanted: int) -> int:
    """Number of vertices for which there is room and time, if so many are wanted; raises as `Solver.for_curve` does."""
    method = named(METHODS, "method", options.method)
    metric = _metric(method, options)
    if _may_be_hierarchical(options) and (options.solver == "hierarchical" or wanted > HIERARCHICAL_FROM):
        own = compressed(metric, Tolerances()).most_vertices if isinstance(options.metric, Metric) else MAX_VERTICES
        return min(MAX_VERTICES, own)
    metrics = (metric, *method.rule.other_metrics)
    return min(metric.most_vertices for metric in metrics)


def _may_be_hierarchical(options: RelaxOptions) -> bool:
    obstacle = None if options.solver == "dense" else _obstacle(options, named(METHODS, "method", options.method))
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
    if rule.second_order or options.stability or options.escape_saddles:
        return f"{method.name} with these options needs a second derivative"
    if rule.other_metrics:
        return f"{method.name} needs a sum of metrics"
    if not isinstance(_energy(options), MoebiusEnergy):
        return f"energy {_energy(options).name!r} needs all pairs of edges one by one"
    if options.quadrature_points not in (None, 1):
        return f"{options.quadrature_points} Gauss points need all pairs of edges one by one"
    return None


def _energy(options: RelaxOptions) -> Energy:
    return named(ENERGIES, "energy", options.energy) if isinstance(options.energy, str) else options.energy


def _metric(method: Method, options: RelaxOptions) -> Metric:
    wanted = method.metric if options.metric is None else options.metric
    return named(METRICS, "metric", wanted) if isinstance(wanted, str) else wanted
