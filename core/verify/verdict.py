"""What the check of a trajectory finds."""

from dataclasses import dataclass

import numpy as np

from ..errors import counted
from ..types import IntArray


@dataclass(frozen=True)
class Verdict:
    """What was found; numbers of what failed count from 0, and are None if that is not the reason."""

    accepted: bool  #: whether every leg and every change of stage is proved free of contact
    stages: int  #: how many were checked, including the one that failed
    legs: int
    reason: str = ""  #: why the trajectory is not accepted; empty if it is
    stage: int | None = None  #: that of the failure
    frame: int | None = None  #: with which the leg begins that failed
    edges: tuple[int, ...] | None = None  #: those that meet, or the one that meets an obstacle
    obstacles: int = 0  #: how many there are
    obstacle: int | None = None  #: the one that an edge meets
    pins: int = 0  #: how many vertices are held, in every frame

    def __str__(self) -> str:
        if self.accepted:
            nor = f", nor with {counted(self.obstacles, 'obstacle')}" if self.obstacles else ""
            held = f"; {counted(self.pins, 'pin')} in place" if self.pins else ""
            return f"accepted: no contact on {counted(self.legs, 'leg')} in {counted(self.stages, 'stage')}{nor}{held}"
        place = "" if self.stage is None else f"stage {self.stage}"
        place += "" if self.frame is None else f", frame {self.frame}"
        return f"rejected: {place}: {self.reason}" if place else f"rejected: {self.reason}"


class ContactError(Exception):
    """Edges meet, or one of them an obstacle; the message says so."""

    def __init__(self, message: str, edges: tuple[int, ...], obstacle: int | None = None) -> None:
        super().__init__(message)
        self.edges, self.obstacle = edges, obstacle

    @classmethod
    def between(cls, heads: IntArray, x0: int, x1: int, y0: int, y1: int) -> "ContactError":
        """Two edges, or a vertex x₀ = x₁ of a triangle or at the end of an open polygon and an edge."""
        first, second = _edge_number(heads, x0, x1), _edge_number(heads, y0, y1)
        edges = f"edges {first + 1} and {second + 1} (counted from 1) meet"
        kind = "a triangle" if heads[heads[heads[x0]]] == x0 != heads[x0] else "an open polygon"
        return cls(f"{kind} collapses at vertex {x0 + 1}" if x0 == x1 else edges, (first, second))

    @classmethod
    def with_obstacle(cls, heads: IntArray, x0: int, x1: int, obstacle: int) -> "ContactError":
        """An edge and an obstacle."""
        edge = _edge_number(heads, x0, x1)
        return cls(f"edge {edge + 1} meets obstacle {obstacle + 1} (counted from 1)", (edge,), obstacle)


class UndecidedError(Exception):
    """More edges are within rounding of each other than are worth deciding exactly; the message says so."""


def _edge_number(heads: IntArray, a: int, b: int) -> int:
    """Number of the edge between two vertices, or of one at a vertex given twice; ends of open polygons begin none."""
    tail = b if heads[b] == a != b else a - int(heads[a] == a)
    return int(np.count_nonzero(heads[:tail] != np.arange(tail)))
