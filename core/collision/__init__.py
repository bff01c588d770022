"""Conservative continuous collision detection: motions of polygons that are proved free of contact."""

from .embedded import check_clear, check_embedded, survives_rounding
from .gap import check_gap, minimal_gap
from .gap import thickness as thickness
from .motion import Contact, FreeMotion, Limit, free_motion, is_free
from .rope import is_rope, rope_motion
