"""How good a shape has to be, in three words: each stands for values of the options that cost time."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core import METHODS


@dataclass(frozen=True)
class Quality:
    """A level of quality: its title, what it is for, and options of a relaxation."""

    label: str
    purpose: str
    method: str
    tolerance: float
    max_iterations: int

    @property
    def values(self) -> dict[str, Any]:
        """The settings that it stands for; 0 vertices leaves the number to the core."""
        return {name: getattr(self, name) for name in ("method", "tolerance", "max_iterations")} | {"vertices": 0}

    @property
    def description(self) -> str:
        """What it is for, and what it means in options."""
        return (
            f"{self.purpose}. Method: {METHODS[self.method].label}, Tolerance: {self.tolerance:g}, "
            f"Max Iterations: {self.max_iterations}, Vertices: as many as the gaps between strands need"
        )

    def fits(self, settings: Any) -> bool:
        """Whether settings have these values, to the precision of 32-bit numbers."""
        return all(_same(getattr(settings, name), value) for name, value in self.values.items())


def _same(one: Any, other: Any) -> bool:
    return bool(np.float32(one) == np.float32(other)) if isinstance(other, float) else bool(one == other)


_EXACT = "The shape of least energy to many digits, in two or three times the time"
QUALITIES: Mapping[str, Quality] = {
    "PREVIEW": Quality("Preview", "Untangled and nearly at rest, to look at", "lbfgs", 1e-2, 300),
    "GOOD": Quality("Good", "At rest as far as the eye can tell", "lbfgs", 1e-4, 2000),
    "EXACT": Quality("Exact", _EXACT, "trust-region", 1e-8, 2000),
}
"""The levels by their identifiers, which are in files."""


def quality_of(settings: Any) -> str | None:
    """The level that settings match, or None if they are the user's own."""
    return next((name for name, quality in QUALITIES.items() if quality.fits(settings)), None)
