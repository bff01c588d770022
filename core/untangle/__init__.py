"""Strand moves of diagrams made in space: curves are untangled by straight motions that are all proved."""

from .moving import Stage
from .untangle import Untangled, untangled, worth
