"""Strand moves of diagrams, made by a rope that lies on a table: all its motions are proved."""

from .untangle import Legs, untangled, worth
