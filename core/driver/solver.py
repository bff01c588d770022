"""Dense or hierarchical: how sums over all pairs of edges are computed, in energies and in metrics."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

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

# vertices up to which dense iterations are faster on any curve, and from which hierarchical ones are
DENSE_UP_TO, HIERARCHICAL_FROM = 1000, 5000
# In between, counts decide: all n² pairs of edges, or the blocks of the inner product.  The number of blocks stands for
# the work of conjugate gradients, as both blocks and iterations are many where strands are near.
PAIRS_PER_BLOCK = 1700  # that take as long as one block, by `benchmarks/speed.py` on knots and tangles


@dataclass(frozen=True)
class Solver:
    """The energy and the metrics of a relaxation; an OptionError says which of its options contradict each other."""

    options: RelaxOptions
    hierarchical: bool = False  # whether distant pairs of edges are summed cluster by cluster

    def on(self, curve: Curve) -> "Solver":
        """The solver for a curve: the requested one, or the faster one; a CurveError if it has too many vertices."""
        self.check_size(curve)
        wanted = self.options.solver == "hierarchical"
        return Solver(self.options, self._may_be_hierarchical and (wanted or _pays(curve)))

    def objective(self, obstacles: Iterable[Obstacle] = ()) -> Objective:
        """The objective to minimise among obstacles, which are in the units of curves."""
        energy = HierarchicalMoebiusEnergy.instead_of(self._energy) if self.hierarchical else self._energy
        return Objective.of(energy, obstacles, (_weighted(*term) for term in self.options.terms))

    @property
    def metric(self) -> Metric:
        """The requested metric, by default the method's."""
        method, metric, points = self._method, self._metric, self.options.quadrature_points
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
        """A metric in the form used for solving, with the quadrature rule if it takes one."""
        points = self.options.quadrature_points
        # the energy's own rule, as Section 6.1.2 of [RS21] has it, unless another one is requested
        metric = metric.with_rule(self._energy.rule if points is None else Rule.gauss(points))
        return compressed(metric, Tolerances.of_norms(self.options.accuracy)) if self.hierarchical else metric

    def check_size(self, curve: Curve) -> None:
        """Refuse more vertices than the method's inner products have room for, before anything is computed."""
        wanted, name = self.options.vertices, self._method.name
        most = self._max_vertices(max(len(curve), wanted or 0))
        if wanted is not None and wanted > most:
            raise OptionError(f"vertices is {wanted!s:.40}; {name} has room and time for {most}")
        if len(curve) > most:
            large = (
                "the curve has {vertices}; {method} has room and time for {most}; thin it out or relax its parts "
                "separately"
            )
            raise CurveError(Message(large, vertices=Message(VERTEX_COUNT, count=len(curve)), method=name, most=most))

    def _max_vertices(self, wanted: int) -> int:
        """The largest feasible number of vertices, if a certain number is wanted."""
        metric, solver = self._metric, self.options.solver
        if self._may_be_hierarchical and (solver == "hierarchical" or wanted > HIERARCHICAL_FROM):
            given = isinstance(self.options.metric, Metric)
            return min(MAX_VERTICES, compressed(metric, Tolerances()).most_vertices if given else MAX_VERTICES)
        return min(each.most_vertices for each in (metric, *self._method.rule.other_metrics))

    @property
    def _may_be_hierarchical(self) -> bool:
        solver = self.options.solver
        obstacle = None if solver == "dense" else self._needs_dense
        if obstacle is not None and solver == "hierarchical":
            raise OptionError(f"{obstacle}; solver={solver!r} does without: leave it out")
        return solver != "dense" and obstacle is None

    @property
    def _needs_dense(self) -> str | None:
        rule, name, points = self._method.rule, self._method.name, self.options.quadrature_points
        if rule.second_order:
            return f"{name} needs exact second derivatives"
        if rule.other_metrics:
            return f"{name} needs a sum of metrics"
        if not isinstance(self._energy, MoebiusEnergy):
            return f"energy {self._energy.name!r} needs all pairs of edges one by one"
        return None if points in (None, 1) else f"{points} Gauss points need all pairs of edges one by one"

    @property
    def _method(self) -> Method:
        return METHODS[self.options.method]

    @property
    def _energy(self) -> Energy:
        energy = self.options.energy
        return ENERGIES[energy] if isinstance(energy, str) else energy

    @property
    def _metric(self) -> Metric:
        metric = self._method.metric if self.options.metric is None else self.options.metric
        return METRICS[metric] if isinstance(metric, str) else metric


@lru_cache(maxsize=1)
def _pays(curve: Curve) -> bool:
    """Whether hierarchical iterations are likely to be faster, judged by counts that are the same on all machines."""
    n = len(curve)
    if not DENSE_UP_TO < n <= HIERARCHICAL_FROM:
        return n > HIERARCHICAL_FROM
    return PAIRS_PER_BLOCK * block_count(curve) < n * n


def _weighted(term: str | Term, weight: float) -> Weighted:
    term = TERMS[term] if isinstance(term, str) else term
    if weight < 0.0 and isinstance(term, Stiff):
        raise OptionError(
            f"term {term.name!r} has weight {weight:g}, which would make its stiffness negative; "
            "give a weight of 0 or more"
        )
    return Weighted(term, weight)
