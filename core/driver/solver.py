"""Dense or hierarchical: how sums over all pairs of edges are made, and what is solved with them."""

from ..checks import named
from ..descent import METHODS, Method
from ..energies import ENERGIES, Energy, MoebiusEnergy
from ..errors import OptionError
from ..hierarchy import HierarchicalMoebiusEnergy, compressed
from ..hierarchy.metric import MAX_VERTICES
from ..metrics import METRICS, Metric
from ..quadrature import Rule
from ..saddle.iterative import Tolerances
from .options import RelaxOptions

# vertices: on smooth curves hierarchical steps are faster from 1,100 on, on some tangles only from 3,500
DENSE_UP_TO = 2500


class Solver:
    """The energy and the metrics of a relaxation of a curve with so many vertices.

    Attributes
    ----------
    hierarchical
        Whether distant pairs of edges count cluster by cluster.

    Raises
    ------
    OptionError
        If an option names something unknown, or does not go together with the solver that is asked for.
    """

    def __init__(self, options: RelaxOptions, vertices: int) -> None:
        self._options, self._method = options, named(METHODS, "method", options.method)
        obstacle = None if options.solver == "dense" else self._obstacle()
        if obstacle is not None and options.solver == "hierarchical":
            raise OptionError(f"{obstacle}; solver={options.solver!r} does without: leave it out")
        wanted = options.solver == "hierarchical" or vertices > DENSE_UP_TO
        self.hierarchical = options.solver != "dense" and obstacle is None and wanted

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
            If a quadrature rule is asked for, and it has none.
        """
        metric, points = _metric(self._method, self._options), self._options.quadrature_points
        if points is not None and metric.rule is None:
            raise OptionError(f"quadrature_points is {points}; metric {metric.name!r} has no such rule")
        return self.of_metric(metric)

    def of_metric(self, metric: Metric) -> Metric:
        """A metric in the form that is solved with, and by the quadrature rule if it has any."""
        points = self._options.quadrature_points
        # the energy's own rule, as Section 6.1.2 of [RS21] has it, unless another one is asked for
        metric = metric.with_rule(_energy(self._options).rule if points is None else Rule.gauss(points))
        return compressed(metric, Tolerances.of_norms(self._options.accuracy)) if self.hierarchical else metric

    @property
    def max_vertices(self) -> int:
        """Number of vertices for which there is room and time."""
        if self.hierarchical:
            return MAX_VERTICES
        metrics = (_metric(self._method, self._options), *self._method.rule.other_metrics)
        return min(metric.most_vertices for metric in metrics)

    def _obstacle(self) -> str | None:
        """What needs dense matrices."""
        options, rule = self._options, self._method.rule
        if rule.second_order or options.stability or options.escape_saddles:
            return f"{self._method.name} with these options needs a second derivative"
        if rule.other_metrics:
            return f"{self._method.name} needs a sum of metrics"
        if not isinstance(_energy(options), MoebiusEnergy):
            return f"energy {_energy(options).name!r} needs all pairs of edges one by one"
        if options.quadrature_points not in (None, 1):
            return f"{options.quadrature_points} Gauss points need all pairs of edges one by one"
        return None


def _energy(options: RelaxOptions) -> Energy:
    return named(ENERGIES, "energy", options.energy) if isinstance(options.energy, str) else options.energy


def _metric(method: Method, options: RelaxOptions) -> Metric:
    return method.metric if options.metric is None else named(METRICS, "metric", options.metric)
