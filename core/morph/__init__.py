"""Morphs: proved motions from one curve to another."""

from .morph import DifferentError, NoMotionError, compare, morph, morphing, moving
