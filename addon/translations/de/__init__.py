"""German, in the manner of Blender's own: infinitives rather than requests, and its words for what Blender has."""

from .labels import LABELS
from .sentences import SENTENCES
from .tooltips import TOOLTIPS

__all__ = ["LABELS", "SENTENCES", "TOOLTIPS"]
