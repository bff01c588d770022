"""Dense or hierarchical: how sums over all pairs of edges are computed, in energies and in metrics."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

from ..base import VERTEX_COUNT, CurveError, Message, OptionError
from ..curve import Curve, Obstacle
from ..descent import METHODS, Method
from ..energies import ENERGIES, TERMS, Energy, MoebiusEnergy, Objective, Rule, Stiff, Weighted
from ..energies.hierarchy import HierarchicalMoebiusEnergy
from ..solve.hierarchical import CompressedMetric, block_list, compressed
from ..solve.metrics import METRICS, Metric
from ..solve.saddle.iterative import Tolerances
from .options import RelaxOptions


@dataclass(frozen=True)
class Solver:
    """The energy and the metrics of a relaxation; an OptionError says which of its options contradict each other."""

    options: RelaxOptions
    hierarchical: bool = False  # whether distant pairs of edges are summed cluster by cluster
    # vertices up to which dense iterations are faster on any curve, and from which hierarchical ones are
    dense_up_to: ClassVar[int] = 1000
    hierarchical_from: ClassVar[int] = 5000

    def on(self, curve: Curve) -> "Solver":
        """The solver for a curve: the requested one, or the faster one; a CurveError if it has too many vertices."""
        self.check_size(curve)
        wanted = self.options.resolved.solver == "hierarchical"
        return Solver(self.options, self._may_be_hierarchical and (wanted or _pays(curve)))

    def objective(self, obstacles: Iterable[Obstacle] = ()) -> Objective:
        """The objective to minimise among obstacles, which are in the units of curves."""
        energy = self._energy
        if self.hierarchical and type(energy) is MoebiusEnergy:
            energy = HierarchicalMoebiusEnergy(without=energy.without)
        terms = []
        for given, weight in self.options.terms:
            term = TERMS[given] if isinstance(given, str) else given
            if weight < 0.0 and isinstance(term, Stiff):
                raise OptionError(
                    f"term {term.name!r} has weight {weight:g}, which would make its stiffness negative; "
                    "give a weight of 0 or more"
                )
            terms.append(Weighted(term, weight))
        return Objective.of(energy, obstacles, terms, barrier=self.options.resolved.barrier != "off")

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
        metric, solver = self._metric, self.options.resolved.solver
        largest = max(len(curve), wanted or 0)
        if self._may_be_hierarchical and (solver == "hierarchical" or largest > self.hierarchical_from):
            given = isinstance(self.options.metric, Metric)
            most = CompressedMetric.most_vertices
            most = min(most, compressed(metric, Tolerances()).most_vertices) if given else most
        else:
            most = min(each.most_vertices for each in (metric, *self._method.rule.other_metrics))
        if wanted is not None and wanted > most:
            raise OptionError(f"vertices is {wanted!s:.40}; {name} has room and time for {most}")
        if len(curve) > most:
            large = (
                "the curve has {vertices}; {method} has room and time for {most}; thin it out or relax its parts "
                "separately"
            )
            raise CurveError(Message(large, vertices=Message(VERTEX_COUNT, count=len(curve)), method=name, most=most))

    @property
    def _may_be_hierarchical(self) -> bool:
        solver, points = self.options.resolved.solver, self.options.quadrature_points
        rule, name, obstacle = self._method.rule, self._method.name, ""
        if solver == "dense":
            return False
        if rule.second_order:
            obstacle = f"{name} needs exact second derivatives"
        elif rule.other_metrics:
            obstacle = f"{name} needs a sum of metrics"
        elif not isinstance(self._energy, MoebiusEnergy):
            obstacle = f"energy {self._energy.name!r} needs all pairs of edges one by one"
        elif points not in (None, 1):
            obstacle = f"{points} Gauss points need all pairs of edges one by one"
        if obstacle and solver == "hierarchical":
            raise OptionError(f"{obstacle}; solver={solver!r} does without: leave it out")
        return not obstacle

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
    """Whether hierarchical iterations are likely to be faster, judged by counts that are the same on all machines.

    In between these are all n² pairs of edges and the blocks of the inner product, whose number stands for the work of
    conjugate gradients, as both blocks and iterations are many where strands are near.
    """
    n = len(curve)
    if not Solver.dense_up_to < n <= Solver.hierarchical_from:
        return n > Solver.hierarchical_from
    # pairs take as long, by `benchmarks/speed.py` on knots and tangles
    return 1700 * len(block_list(curve).first) < n * n
