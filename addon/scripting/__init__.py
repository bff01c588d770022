"""What scripts use: relaxations of curve objects without a selection, a scene's settings or reports."""

from .relaxation import Relaxation

__all__ = ["Relaxation"]
