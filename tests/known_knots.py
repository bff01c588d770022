"""Invariants of the table's knots, computed by other programs."""

from pathlib import Path
from typing import NamedTuple

from jones import Laurent


class KnownKnot(NamedTuple):
    """Invariants of a knot, for the handedness of the table; the Jones polynomial by powers of √t."""

    genus: int
    fibered: bool
    tau: int
    alexander: tuple[int, ...]
    jones: Laurent


def _read(genus: str, fibered: str, tau: str, alexander: str, lowest: str, coefficients: str) -> KnownKnot:
    jones = {2 * (int(lowest) + k): int(c) for k, c in enumerate(coefficients.split(",")) if c != "0"}
    return KnownKnot(int(genus), fibered == "yes", int(tau), tuple(map(int, alexander.split(","))), jones)


_LINES = (Path(__file__).parent / "core/knots/known_knots.txt").read_text(encoding="utf-8").splitlines()
KNOWN = {name: _read(*rest) for name, *rest in (line.split() for line in _LINES if not line.startswith("#"))}
