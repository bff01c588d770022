"""Morphs: proved motions from one curve to another."""

from .evidence import agreement, difference, type_of
from .morph import NoMotionError, check_alike, morph, morphing

__all__ = ["NoMotionError", "agreement", "check_alike", "difference", "morph", "morphing", "type_of"]
