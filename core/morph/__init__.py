"""Morphs: proved motions from one curve to another."""

from .evidence import DifferentError, NoMotionError, compare
from .morph import morph, morphing, moving
