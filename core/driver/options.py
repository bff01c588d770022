"""Options of a relaxation: frozen and checked when they are made."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from numbers import Real
from reprlib import repr as short
from typing import Any

import numpy as np

from ..base import OptionError, declared, is_list
from ..base.arguments import check_options, documented, option
from ..curve.symmetry import IS_NAME
from ..descent import METHODS
from ..energies import ENERGIES, TERMS, Energy, Term, is_weighted, weighted_term
from ..solve.metrics import METRICS, Metric

EDGE_LENGTHS = ("auto", "equal", "keep")
MESHES = ("auto", "fixed", "finer", "adaptive")
RADII = ("keep", "none")
# what "auto" means with the method "paper": nothing that [RS21] does not do
AS_IN_THE_PAPER = {"barrier": "off", "solver": "dense", "mesh": "fixed", "untangle": "never"}


def _are_lengths(value: object) -> bool:
    if not is_list(value):
        return False
    try:
        lengths = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        return False
    return lengths.ndim == 1 and bool(np.isfinite(lengths).all() and (lengths > 0.0).all())


def are_radii(value: object) -> bool:
    numbers = [value] if isinstance(value, Real) and not isinstance(value, bool) else value
    return _are_lengths(numbers) and bool(np.asarray(numbers).size)


def _is_a(protocol: type, value: object) -> bool:
    return isinstance(value, protocol) and not isinstance(value, type)


def radii(text: str, words: Sequence[str] = ()) -> str | float | tuple[float, ...]:
    """One of some words, a number, or numbers with commas between."""
    try:
        if text in words:
            return text
        numbers = tuple(map(float, text.split(",")))
        return numbers if len(numbers) > 1 else numbers[0]
    except ValueError:
        allowed = ", ".join([*words, "a number such as 0.1, or several: 0.1,0.2"])
        raise OptionError(f"radius is {text!r:.40}; give {allowed}") from None


def time_limit() -> Any:
    """A field for the seconds that a run may take."""
    return option(
        None,
        "Time Limit",
        "stop after this many seconds of computing, even in the middle of a step; what was reached so far is kept",
        automatic="no limit",
        low=0,
        metavar="SECONDS",
    )


@documented
@dataclass(frozen=True, kw_only=True)
class RelaxOptions:
    """The options of `relax`; energies, metrics and terms are names, or objects of your own.

    Raises
    ------
    OptionError
        If a value has the wrong type, is out of range or unknown, or two options contradict each other.
    """

    method: str = option("lbfgs", "Method", "how the energy is minimised", choices=METHODS, metavar="M")
    max_iterations: int = option(
        2000, "Max Iterations", "stop after this many accepted steps and changes of mesh", low=0, metavar="K"
    )
    tolerance: float = option(
        1e-4, "Tolerance", "stop when the projected gradient's metric norm is at most this times √E", low=0, metavar="T"
    )
    time_limit: float | None = time_limit()
    vertices: int | None = option(
        None,
        "Vertices",
        "number of vertices to refine to, over all components",
        automatic="enough for edges to be shorter than the gaps between strands",  # Section 6.1.3 of [RS21]
        low=3,
    )
    energy: str | Energy = option(  # noqa: RUF009 (a field, made for this class)
        "moebius",
        "Energy",
        "energy to minimise; a barrier between strands is added to it",
        choices=ENERGIES,
        objects=("an energy", partial(_is_a, Energy)),
    )
    barrier: str = option(
        "auto",
        "Barrier",
        "whether near pairs of edges have their exact energy, infinite at contact, instead of the quadrature rule's; "
        "auto: on, except for the method paper",
        choices=("auto", "on", "off"),
        metavar="B",
    )
    radius: str | float | tuple[float, ...] = option(
        "keep",
        "Radius",
        "radius of the rope that the curve stays, one or one for each component; keep: nine tenths of the thickness at "
        "the start, less only where that leads to a lower minimum; none for what grows, penalty methods and paper",
        choices=RADII,
        objects=("a number above 0, or one for each component", are_radii),
        read=partial(radii, words=RADII),
        metavar="R",
    )
    metric: str | Metric | None = option(  # noqa: RUF009 (a field, made for this class)
        None,
        "Metric",
        "inner product that defines the gradient",
        automatic="the method's own",
        choices=METRICS,
        objects=("a metric", partial(_is_a, Metric)),
    )
    quadrature_points: int | None = option(
        None,
        "Gauss Points",
        "Gauss points per edge for the metric J_C; the cost grows with their square",
        automatic="the energy's own",
        low=1,
        high=16,
        metavar="k",
    )
    terms: tuple[tuple[str | Term, float], ...] = option(
        (),
        "Terms",
        "terms added to the energy, each with its weight",
        choices=TERMS,
        objects=("a pair of a term and its weight, such as ('bending', 0.1)", is_weighted),
        example="(('bending', 0.1),)",
        flag="term",
        metavar="NAME=WEIGHT",
        read=weighted_term,
    )
    penalty: float | None = option(
        None,
        "Length Penalty",
        "weight of length errors in the penalty methods",
        automatic="the method's own",
        low=0,
        metavar="α",
    )
    solver: str = option(
        "auto",
        "Solver",
        "how sums over all pairs of edges are computed: dense, pair by pair; hierarchical, with distant edges in "
        "clusters, for many vertices; auto takes the faster one",
        choices=("auto", "dense", "hierarchical"),
        metavar="S",
    )
    accuracy: float = option(
        1e-4,
        "Accuracy",
        "largest error of the hierarchical solver in the projected gradient's norm, relative to the larger of that "
        "norm and √E; the energy is a hundred times as accurate",
        low=0,
        high=1e-2,
        metavar="A",
    )
    edge_lengths: str | tuple[float, ...] = option(
        "auto",
        "Edge Lengths",
        "target edge lengths: equal within each component, or keep, as in the refined start; auto keeps them among "
        "obstacles, and where the longest edge is over ten times the shortest edge or gap",
        choices=EDGE_LENGTHS,
        objects=("as many numbers above 0 as there are edges", _are_lengths),
        metavar="L",
    )
    mesh: str = option(
        "auto",
        "Mesh",
        "how vertices may change: fixed, not at all; finer, edges are split where strands are too close for the mesh, "
        "once it yields little further improvement; adaptive, edges are split and collapsed along the way to stay "
        "shorter than the gaps between strands; auto, a curve of many vertices starts with fewer, which is faster, "
        "gets them all back, and ends as with finer unless vertices or edge_lengths are given",
        choices=MESHES,
        metavar="M",
    )
    stability: bool = option(
        False,
        "Stability",
        "check whether a converged curve is a minimum: count the negative eigenvalues of the Lagrangian's Hessian",
    )
    escape_saddles: bool = option(
        False, "Escape Saddles", "check whether a converged curve is a minimum, and continue downhill from a saddle"
    )
    balance: bool = option(
        False,
        "Balance",
        "continue from a converged curve to its Möbius image (all have the same energy) that bends least for its "
        "length, and relax that",
    )

    grow: float = option(
        1.0,
        "Grow",
        "multiply all lengths by this factor: at once if nothing is in the way, otherwise step by step as obstacles "
        "and pins leave room; below 1 the curve shrinks",
        low=0.001,  # curves that shrink far more are so small that powers of their size are 0
        high=1000.0,  # well below it, packed curves already need more vertices than there is time for
        metavar="F",
    )
    untangle: str = option(
        "auto",
        "Untangle",
        "whether strands are moved over and under others to remove crossings, every motion proved: auto, where the "
        "flow comes to rest or makes no headway, though a diagram shows that crossings go; always, also before the "
        "flow; these moves change the mesh and do not count as iterations",
        choices=("auto", "always", "never"),
        metavar="U",
        row=True,
    )
    symmetry: str | None = option(
        None,
        "Symmetry",
        "group of rotations and reflections, after Schoenflies (C3, D2, S4, …), that the starting curve has, up to a "
        "tolerance, and keeps exactly; auto: every symmetry of the curve",
        automatic="no symmetry is kept",
        example="C3",
        metavar="GROUP",
    )
    hops: int = option(
        0,
        "Hops",
        "number of attempts to leave a minimum, or a place where the curve is stuck: each makes a random motion, "
        "proved free of contact, then relaxes, and is kept if it ends lower; all iterations count",
        low=0,
        metavar="K",
    )
    seed: int = option(
        0,
        "Seed",
        "seed of the random motions of hops and scrambled starts; the same seed gives the same motions",
        low=0,
        metavar="S",
    )

    def __post_init__(self) -> None:
        check_options(self)
        object.__setattr__(self, "terms", tuple((term, float(weight)) for term, weight in self.terms))
        if not isinstance(self.edge_lengths, str):
            object.__setattr__(self, "edge_lengths", tuple(map(float, self.edge_lengths)))
        if not isinstance(self.radius, str):
            object.__setattr__(self, "radius", tuple(map(float, np.ravel(self.radius))))
        if self.mesh in ("finer", "adaptive") and self.edge_lengths != "auto":
            raise OptionError(f"mesh={self.mesh!r} makes its own edge_lengths; leave one of the two options out")
        if self.untangle == "always" and not self.resolved.may_untangle:
            other = "mesh='fixed'" if self.mesh == "fixed" else "symmetry" if self.symmetry else "edge_lengths"
            raise OptionError(f"untangle='always' changes the mesh; leave it or {other} out")
        if self.symmetry is not None:
            if self.symmetry != "auto" and not IS_NAME.fullmatch(self.symmetry):
                raise OptionError(f"symmetry is {short(self.symmetry)}; give auto, or a group such as C3, D2, S4 or Th")
            if self.mesh == "adaptive":
                raise OptionError(
                    "symmetry keeps orbits of vertices, which mesh='adaptive' does not; take mesh='finer'"
                )
            if not isinstance(self.edge_lengths, str):
                raise OptionError(
                    "symmetry makes its own vertices, to which edge_lengths do not belong; leave one of them out"
                )

    def __repr__(self) -> str:
        values = [(each, getattr(self, each.name)) for each in declared(type(self))]
        changed = [f"{each.name}={short(value)}" for each, value in values if value != each.default]
        return f"RelaxOptions({', '.join(changed)})"

    @property
    def resolved(self) -> "RelaxOptions":
        """The same with what defaults mean to the method: what runs read, and reports tell."""
        meant: dict[str, Any] = {}
        if self.method == "paper":
            meant = {name: value for name, value in AS_IN_THE_PAPER.items() if getattr(self, name) == "auto"}
        other = self.method == "paper" or not METHODS[self.method].geometry.prescribes or self.grow != 1.0
        if self.radius == "keep" and other:
            meant["radius"] = "none"
        return replace(self, **meant) if meant else self

    @property
    def may_untangle(self) -> bool:
        """Whether the mesh may change in the way that strand moves require."""
        free = self.mesh != "fixed" and self.edge_lengths in ("auto", "equal")
        return free and self.symmetry is None

    @property
    def ends_finer(self) -> bool:
        """Whether the final mesh has more vertices where strands are near."""
        free = self.vertices is None and self.edge_lengths == "auto"
        return self.mesh in ("finer", "adaptive") or (self.mesh == "auto" and free)
