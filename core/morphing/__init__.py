"""Morphs: proved motions from one curve to another."""

from .evidence import DifferentError, NoMotionError, compare
from .morph import morph, morphing, moving

__all__ = ["DifferentError", "NoMotionError", "compare", "morph", "morphing", "moving"]
