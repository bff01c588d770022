"""Conservative continuous collision detection: motions of polygons that are proved free of contact."""

from .embedded import check_embedded
from .gap import check_gap, minimal_gap
from .motion import FreeMotion, Limit, free_motion, is_free
from .rounding import survives_rounding

__all__ = [
    "FreeMotion",
    "Limit",
    "check_embedded",
    "check_gap",
    "free_motion",
    "is_free",
    "minimal_gap",
    "survives_rounding",
]
