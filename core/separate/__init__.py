"""Separate: curves that are nearer than their radii become ropes that keep clear."""

from .separate import Separated, SeparateOptions, separate, separating
