"""Conservative continuous collision detection: motions of polygons that are proved free of contact."""

from .boxes import BoxTree, nearer_than, still_triangles
from .embedded import check_clear, check_embedded, survives_rounding
from .gap import check_gap, minimal_gap, near_edges, scaled_points, thickness, written
from .motion import Contact, FreeMotion, free_motion, is_free, walk
from .rope import is_rope, rope_motion
