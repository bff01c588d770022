"""Polygons in R^m, closed or open: the value that everything else takes and returns."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np
import numpy.typing as npt

from ..base import CurveError, FloatArray, Place, counted, dot, frozen, is_list, real
from .mesh import Mesh

MAKERS: list[Callable[[object], "Curve | None"]] = []
"""Of curves, from objects of other programs: None for all others.  Rooms above append what they can read."""


@dataclass(frozen=True, eq=False)
class Curve:
    """One or more polygons, closed or open: an immutable array of vertices and its connectivity.

    Parameters
    ----------
    vertices
        Positions P, shape (n, m) with m ≥ 2, in the user's units; copied and made read-only.
    mesh
        Connectivity; by default all vertices form one closed component.

    Raises
    ------
    CurveError
        If these are not numbers, the shape is wrong or a coordinate is not finite; the message names the vertex.
    """

    vertices: FloatArray
    mesh: Mesh

    def __init__(self, vertices: npt.ArrayLike, mesh: Mesh | None = None) -> None:
        points = frozen(_numbers(vertices, "vertices"))
        if points.ndim != 2 or points.shape[1] < 2:
            raise CurveError(f"vertices have shape {points.shape}; they must be an array (n, m) with m at least 2")
        mesh = Mesh((len(points),)) if mesh is None else mesh
        if not isinstance(mesh, Mesh):
            raise CurveError(f"mesh is of type {type(mesh).__name__}; give a Mesh, such as Mesh(({len(points)},))")
        if mesh.size != len(points):
            raise CurveError(f"the components have {mesh.size} vertices together but {len(points)} are given")
        bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
        if bad.size:
            raise CurveError(f"vertex {bad[0] + 1} is not finite: {points[bad[0]].tolist()}; remove or repair it")
        object.__setattr__(self, "vertices", points)
        object.__setattr__(self, "mesh", mesh)

    @classmethod
    def from_components(cls, components: Sequence[npt.ArrayLike], closed: Sequence[bool] = ()) -> "Curve":
        """Join polygons, arrays (n_k, m) of one common m, into one curve (a link); ``closed`` is as for `Mesh`."""
        if not is_list(components):
            raise CurveError(f"components are of type {type(components).__name__}; give a list of arrays")
        arrays = [_numbers(component, f"component {k + 1}") for k, component in enumerate(components)]
        for k, array in enumerate(arrays):
            if array.ndim != 2 or array.shape[1] != arrays[0].shape[-1]:
                told = f"component {k + 1} has shape {array.shape}; all components must be arrays (n, m) with one m"
                raise CurveError(told)
        mesh = Mesh(tuple(len(array) for array in arrays), cast(tuple[bool, ...], closed))  # which checks it
        return cls(np.concatenate(arrays), mesh)

    @classmethod
    def of(cls, other: object) -> "Curve":
        """A curve from objects of other programs: a link of SnapPy or spherogram, or arrays of vertices.

        Links, and whatever else has a ``PD_code()``, are drawn from above as `mobius_flow.core.knots.knot` draws codes.
        Raises CurveError for objects that are none of these.

        >>> Curve.of([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
        <Curve: 1 closed polygon, 3 vertices in R^3>
        """
        for make in MAKERS:
            if (made := make(other)) is not None:
                return made
        if isinstance(other, Curve):
            return other
        if isinstance(other, list | tuple) and other and np.ndim(other[0]) == 2:
            return cls.from_components(other)
        return cls(cast(npt.ArrayLike, other))

    def __reduce__(self) -> tuple[type["Curve"], tuple[FloatArray, Mesh]]:
        # made anew, because arrays come out of pickles and deep copies writable
        return Curve, (self.vertices, self.mesh)

    def __repr__(self) -> str:
        closed = "closed" if self.mesh.all_closed else "open" if not any(self.mesh.closed) else "closed and open"
        parts = counted(len(self.mesh.component_sizes), f"{closed} polygon")
        return f"<Curve: {parts}, {len(self)} vertices in R^{self.dimension}>"

    @property
    def components(self) -> tuple[FloatArray, ...]:
        """The vertices of each component, as read-only views."""
        return tuple(self.vertices[s] for s in self.mesh.slices)

    @property
    def dimension(self) -> int:
        """Dimension m of the ambient space."""
        return int(self.vertices.shape[1])

    def __len__(self) -> int:
        return self.mesh.size

    def with_vertices(self, vertices: npt.ArrayLike) -> "Curve":
        """Return the same polygon with other vertices; shape (n, m)."""
        return Curve(vertices, self.mesh)

    @cached_property
    def edge_vectors(self) -> FloatArray:
        """Edge vectors e_I = P(I↑) − P(I↓); shape (edges, m)."""
        return frozen(self.mesh.changes(self.vertices))

    @cached_property
    def edge_lengths(self) -> FloatArray:
        """Edge lengths ℓ_I = |e_I|; shape (edges,)."""
        return frozen(np.sqrt(dot(self.edge_vectors, self.edge_vectors)))

    @cached_property
    def midpoints(self) -> FloatArray:
        """Edge midpoints m_I; shape (edges, m)."""
        return frozen(0.5 * (self.vertices[self.mesh.heads] + self.vertices[self.mesh.tails]))

    @property
    def length(self) -> float:
        """Total length of all components."""
        return float(self.edge_lengths.sum())

    @property
    def moments(self) -> FloatArray:
        """ℓ_I m_I as columns, so that sums over edges are pairwise ones; shape (m, edges)."""
        return np.ascontiguousarray((self.edge_lengths[:, None] * self.midpoints).T)

    @property
    def barycenter(self) -> FloatArray:
        """Σ ℓ_I m_I / Σ ℓ_I; shape (m,)."""
        return np.asarray(np.sum(self.moments, axis=1) / self.length)

    @cached_property
    def arc_starts(self) -> FloatArray:
        """Arc length from its component's first vertex to the tail of every edge; shape (edges,)."""
        each = [self.edge_lengths[s] for s in self.mesh.edge_slices]
        return frozen(np.concatenate([np.cumsum(ell) - ell for ell in each]))

    @cached_property
    def component_lengths(self) -> FloatArray:
        """Length of each component; shape (components,)."""
        return frozen(np.array([self.edge_lengths[s].sum() for s in self.mesh.edge_slices]))


def check_closed(curve: Curve, what: str) -> None:
    """Raise a CurveError, naming the feature that needs closed components, if one is open."""
    if not curve.mesh.all_closed:
        number = curve.mesh.closed.index(False) + 1
        raise CurveError(f"component {number} is open; {what} are for closed components")


def at_vertices(curve: Curve, *vertices: int) -> Place:
    """The place of some vertices, seen from the first."""
    return Place(vertices, tuple(curve.vertices[vertices[0]].tolist()))


def at_edges(curve: Curve, edges: tuple[int, ...], position: FloatArray | None = None) -> Place:
    """The place of some edges, by their ends, seen from ``position``, (m,), or the middle of all."""
    tails = list(edges)
    where = curve.midpoints[tails].mean(axis=0) if position is None else position
    ends = np.stack([curve.mesh.tails[tails], curve.mesh.heads[tails]], axis=1)
    return Place(tuple(dict.fromkeys(ends.ravel().tolist())), tuple(where.tolist()))


def _numbers(values: npt.ArrayLike, name: str) -> FloatArray:
    try:
        return real(values)
    except (TypeError, ValueError, OverflowError) as error:
        reason = str(error).splitlines()[0]
        raise CurveError(f"{name} cannot be made an array (n, m) of real numbers: {reason}") from error
