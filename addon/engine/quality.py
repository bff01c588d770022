"""How good a shape has to be, in three words: each stands for values of the options that cost time."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from ...core import METHODS


@dataclass(frozen=True, kw_only=True)
class Quality:
    """A level of quality."""

    label: str  # its title, and what it is for
    purpose: str
    method: str  # options of a relaxation; the number of vertices is left to the core at all levels
    tolerance: float
    max_iterations: int

    @property
    def values(self) -> dict[str, Any]:
        """The settings that it stands for; 0 vertices are as many as the core thinks right."""
        return {
            "method": self.method,
            "tolerance": self.tolerance,
            "max_iterations": self.max_iterations,
            "vertices": 0,
        }

    @property
    def description(self) -> str:
        """What it is for, and what it means in options."""
        return (
            f"{self.purpose}. Method: {METHODS[self.method].label}, Tolerance: {self.tolerance:g}, "
            f"Max Iterations: {self.max_iterations}, Vertices: as many as the gaps between strands need"
        )

    def fits(self, settings: Any) -> bool:
        """Whether settings have these values, up to what 32-bit numbers tell apart."""
        return all(_same(getattr(settings, name), value) for name, value in self.values.items())


def _same(one: Any, other: Any) -> bool:
    return bool(np.float32(one) == np.float32(other)) if isinstance(other, float) else bool(one == other)


QUALITIES: Mapping[str, Quality] = MappingProxyType(
    {
        "PREVIEW": Quality(
            label="Preview",
            purpose="Untangled and nearly at rest, to look at",
            method="lbfgs",
            tolerance=1e-2,
            max_iterations=300,
        ),
        "GOOD": Quality(
            label="Good",
            purpose="At rest as far as the eye can tell",
            method="lbfgs",
            tolerance=1e-4,
            max_iterations=2000,
        ),
        "EXACT": Quality(
            label="Exact",
            purpose="The shape of least energy to many digits, in two or three times the time",
            method="trust-region",
            tolerance=1e-8,
            max_iterations=2000,
        ),
    }
)
"""The levels by their identifiers, which are in files."""


def quality_of(settings: Any) -> str | None:
    """The level that settings have, or None if they are of nobody's but the user's."""
    return next((name for name, quality in QUALITIES.items() if quality.fits(settings)), None)
