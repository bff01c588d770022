"""What the check of a trajectory finds."""

from dataclasses import dataclass

from ..errors import counted


@dataclass(frozen=True)
class Verdict:
    """What was found.

    Attributes
    ----------
    accepted
        True if every leg and every change of stage is proved free of contact.
    stages, legs
        How many were checked, including the one that failed.
    reason
        Why the trajectory is not accepted; empty if it is.
    stage, frame
        Place of the failure: number of the stage and of the frame that the leg begins with, from 0.
    edges
        The edges that meet, or the one that meets an obstacle, from 0; None if that is not the reason.
    obstacles
        How many there are.
    obstacle
        The one that an edge meets, from 0; None if that is not the reason.
    """

    accepted: bool
    stages: int
    legs: int
    reason: str = ""
    stage: int | None = None
    frame: int | None = None
    edges: tuple[int, ...] | None = None
    obstacles: int = 0
    obstacle: int | None = None

    def __str__(self) -> str:
        if self.accepted:
            nor = f", nor with {counted(self.obstacles, 'obstacle')}" if self.obstacles else ""
            return f"accepted: no contact on {counted(self.legs, 'leg')} in {counted(self.stages, 'stage')}{nor}"
        place = "" if self.stage is None else f"stage {self.stage}"
        place += "" if self.frame is None else f", frame {self.frame}"
        return f"rejected: {place}: {self.reason}" if place else f"rejected: {self.reason}"


class ContactError(Exception):
    """Edges, given by the numbers of their tails, meet, or one of them an obstacle; the message says so."""

    def __init__(self, message: str, edges: tuple[int, ...], obstacle: int | None = None) -> None:
        super().__init__(message)
        self.edges, self.obstacle = edges, obstacle

    @classmethod
    def between(cls, x0: int, x1: int, y0: int, _y1: int) -> "ContactError":
        """Two edges, or a vertex x₀ = x₁ of a triangle and the opposite edge."""
        edges = f"edges {x0 + 1} and {y0 + 1} (counted from 1) meet"
        return cls(f"a triangle collapses at vertex {x0 + 1}" if x0 == x1 else edges, (x0, y0))

    @classmethod
    def with_obstacle(cls, x0: int, obstacle: int) -> "ContactError":
        """An edge and an obstacle."""
        return cls(f"edge {x0 + 1} meets obstacle {obstacle + 1} (counted from 1)", (x0,), obstacle)
