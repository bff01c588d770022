"""Hops out of a minimum: the motions that begin them, the trials, and the run that takes those that lead lower."""

from .hopping import hopping

__all__ = ["hopping"]
