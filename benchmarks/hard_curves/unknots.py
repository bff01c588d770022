"""Unknots that don't look it: closures of long braid words that stand for the trivial knot."""

import numpy as np
from mobius_flow.core import Curve
from mobius_flow.core.knots import braid_closure, braid_word
from mobius_flow.core.knots.braids import Word

from .lattices import lattice_closure

_MOVES_PER_LETTER = 4
_MAX_TRIALS = 500  # insertions tried per letter
_NEARBY = 6  # letters around a new pair that it is braided with


def hard_unknot(crossings: int, seed: int, vertices: int | None = None, *, strands: int | None = None) -> Curve:
    """Make an unknot as the closure of a braid with a given number of crossings, no two of which cancel as they stand.

    Parameters
    ----------
    crossings
        Number of letters of the braid word.
    seed
        The same seed gives the same curve.
    vertices
        Total number of vertices; by default so many that edges are shorter than strands are apart.
    strands
        Number of strands; one more than ``crossings`` must differ from it by an even number.

    Raises
    ------
    ValueError
        If no such braid exists.

    Examples
    --------
    >>> len(hard_unknot(20, seed=7).mesh.component_sizes)
    1
    """
    return braid_closure(unknot_word(crossings, seed, strands=strands), vertices)


def lattice_knot(name: str) -> Curve:
    """A knot or link of the table as a coarse polygon on the cubic lattice."""
    return lattice_closure(braid_word(name))


def lattice_unknot(crossings: int, seed: int) -> Curve:
    """A hard unknot as a coarse polygon on the cubic lattice."""
    return lattice_closure(unknot_word(crossings, seed))


def unknot_word(crossings: int, seed: int, *, strands: int | None = None) -> Word:
    """Give a braid word of ``crossings`` letters whose closure is the unknot, though no two letters cancel.

    It comes from the trivial braid on one strand by Markov's moves alone: stabilisations, insertions of σ σ⁻¹,
    braid relations and conjugations, all of which keep the closure (Markov 1935; Birman, *Braids, Links, and
    Mapping Class Groups*, 1974). See :func:`hard_unknot` for the parameters.
    """
    strands = _strand_count(crossings) if strands is None else strands
    _check(crossings, strands)
    rng = np.random.default_rng(seed)
    word: list[int] = []
    for new in range(1, strands):
        word.insert(int(rng.integers(len(word) + 1)), _signed(new, rng))
        # A little growth at every strand hides its stabilisation, most at the end spreads over all strands.
        length = crossings if new == strands - 1 else min(3 * new, crossings - strands + 1 + new)
        word = _grown(word, length, new, rng)
        _mix(word, rng)
    return tuple(word)


def _strand_count(crossings: int) -> int:
    """A number of strands that fits: 3 and a few more for many crossings, of the right parity."""
    strands = min(3 + max(crossings, 0) // 60, crossings + 1)
    return strands if (crossings - strands) % 2 else strands + 1


def _check(crossings: int, strands: int) -> None:
    if not 1 <= strands <= crossings + 1 or (crossings - strands) % 2 == 0:
        raise ValueError(
            f"no unknot is the closure of a braid of {strands} strands and {crossings} crossings; "
            "strands must be at most one more than crossings, and differ from that by an even number"
        )
    if strands <= 2 and crossings != strands - 1:
        raise ValueError(f"on {strands} strands every trivial word cancels; {crossings} crossings need 3 or more")


def _signed(letter: int, rng: np.random.Generator) -> int:
    return letter if rng.random() < 0.5 else -letter


def _grown(word: list[int], length: int, largest: int, rng: np.random.Generator) -> list[int]:
    """Insert pairs σ σ⁻¹ and braid them in until the word has ``length`` letters, or one less."""
    for _ in range(_MAX_TRIALS * length):
        if len(word) + 2 > length or largest < 2:
            return word
        place = int(rng.integers(len(word) + 1))
        letter = _signed(_rarer(word, rng.integers(1, largest + 1, size=2).tolist()), rng)
        trial = [*word[:place], letter, -letter, *word[place:]]
        for start in (place + rng.integers(-_NEARBY, _NEARBY, size=2 * _NEARBY)).tolist():
            _relate(trial, start)
        if _is_reduced(trial):
            word = trial
    raise ValueError(f"no braid of {length} crossings was found with this seed and these strands; change one of them")


def _rarer(word: list[int], letters: list[int]) -> int:
    """The letter that occurs less often in the word, so that crossings spread over all strands."""
    return min(letters, key=lambda letter: word.count(letter) + word.count(-letter))


def _mix(word: list[int], rng: np.random.Generator) -> None:
    """Apply braid relations all over the word, also across its end, which is conjugation; undo those that cancel."""
    for start in rng.integers(len(word), size=_MOVES_PER_LETTER * len(word)).tolist():
        old = list(word)
        _relate(word, start)
        if word != old and not _is_reduced(word):
            word[:] = old


def _relate(word: list[int], start: int) -> None:
    """Apply a braid relation to the three letters from ``start`` on, if there is one."""
    if len(word) >= 3:
        places = [(start + k) % len(word) for k in range(3)]
        for place, letter in zip(places, _related(*(word[place] for place in places)), strict=True):
            word[place] = letter


def _related(a: int, b: int, c: int) -> tuple[int, int, int]:
    """An equal word of three letters by one braid relation, or the same one if none applies."""
    if abs(abs(a) - abs(b)) >= 2:
        return b, a, c
    if abs(a) != abs(c) or abs(a) == abs(b):
        return a, b, c
    i, j = abs(a), abs(b)
    if a == -c:  # σᵢᵉ σⱼᶠ σᵢ⁻ᵉ = σⱼ⁻ᵉ σᵢᶠ σⱼᵉ
        e, f = a // i, b // j
        return -e * j, f * i, e * j
    if a * b > 0:  # σᵢ σⱼ σᵢ = σⱼ σᵢ σⱼ
        return (j, i, j) if a > 0 else (-j, -i, -j)
    return a, b, c


def _is_reduced(word: list[int]) -> bool:
    """Whether no two letters of the closed braid cancel as they stand."""
    return not any(_cancels(word, place) for place in range(len(word)))


def _cancels(word: list[int], place: int) -> bool:
    """Whether a letter meets its inverse further on, also across the end, past letters it commutes with."""
    letter = word[place]
    for step in range(1, len(word)):
        other = word[(place + step) % len(word)]
        if abs(abs(other) - abs(letter)) < 2:
            return other == -letter
    return False
