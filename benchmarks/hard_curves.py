"""Curves that are each hard in their own way, for benchmarks and tests."""

import math

import numpy as np
from mobius_flow.core import Curve
from mobius_flow.core.knots import braid_closure, braid_word, torus_knot
from mobius_flow.core.knots.braids import Word, checked_word, columns, cycles


def bent_trefoil(vertices: int) -> Curve:
    """A torus knot T(2, 3) after three shears of space, which preserve its type."""
    x, y, z = torus_knot(2, 3, vertices).vertices.T
    bend = 0.3  # the knot is 3 wide and its edges still differ by less than 20:1, so that they are made equal
    x = x + bend * np.sin(2.0 * z + 1.0)
    z = z + bend * np.sin(2.0 * y)
    y = y + bend * np.sin(2.0 * x)
    return Curve(np.stack([x, y, z], axis=1))


def uneven(curve: Curve, ratio: float, seed: int) -> Curve:
    """The same polygon with vertices added on its edges so that edge lengths differ by ``ratio``."""
    rng = np.random.default_rng(seed)
    pieces = []
    for vertex, edge in zip(curve.vertices, curve.edge_vectors, strict=True):
        cuts = np.array([0.0]) if rng.random() > 0.1 else np.array([0.0, 1.0 / ratio])
        pieces.append(vertex + cuts[:, None] * edge)
    return Curve(np.concatenate(pieces))


def graded_trefoil(n: int, ratio: float) -> Curve:
    """The trefoil with edges ``ratio`` times shorter at three places than halfway between them."""
    density = np.sqrt(ratio) ** np.cos(6 * np.pi * np.arange(n) / n)
    t = 2 * np.pi * np.cumsum(density) / density.sum()
    radius = 2 + np.cos(3 * t)
    return Curve(np.stack([radius * np.cos(2 * t), radius * np.sin(2 * t), np.sin(3 * t)], axis=1))


def chain_of_rings(count: int, sizes: tuple[int, ...]) -> Curve:
    """Round rings, each linked with the next, with the given numbers of vertices in turn."""
    rings = []
    for k in range(count):
        t = 2 * np.pi * np.arange(sizes[k % len(sizes)]) / sizes[k % len(sizes)]
        ring = np.stack([np.cos(t), np.sin(t), np.zeros(len(t))], axis=1)
        rings.append((ring if k % 2 else ring[:, [0, 2, 1]]) + np.array([1.3 * k, 0.0, 0.0]))
    return Curve.from_components(rings)


def spiral(turns: float) -> Curve:
    """An unknot in the plane: two Archimedean spirals r = aθ opposite each other, joined in the middle and outside.

    Each goes round ``turns`` times; the radius is 1, so strands are 1 / (2 ``turns`` + 1) apart, and edges are shorter.
    """
    end = 2 * math.pi * turns
    a = 1 / (end + math.pi)
    # equal steps of θ² are about equal steps of length
    theta = np.sqrt(np.linspace(0.0, (end + math.pi) ** 2, math.ceil(64 * (turns + 1)) * 8))
    outwards = a * theta * np.exp(1j * theta)
    inner = np.append(theta[theta < end], end)[::-1]
    inwards = -a * inner * np.exp(1j * inner)
    middle, radius = (outwards[-1] + inwards[0]) / 2, (outwards[-1] - inwards[0]) / 2
    cap = middle + radius * np.exp(1j * np.linspace(0.0, math.pi, 64))
    smooth = np.concatenate([outwards, cap[1:-1], inwards])
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(smooth)))])
    # An edge of length h leaves a curve of curvature κ by at most κh²/8; here κ is at most 2π/gap, in the middle, and
    # strands cannot meet while that is below gap/2, as for h = 0.6 gap.
    vertices = max(60, math.ceil(along[-1] / (0.6 / (2 * turns + 1))))
    marks = np.linspace(0.0, along[-1], vertices + 1)[:-1]
    flat = [np.interp(marks, along, coordinate) for coordinate in (smooth.real, smooth.imag)]
    return Curve(np.stack([*flat, np.zeros(vertices)], axis=1))


def rope(twists: float, gap: float, vertices: int = 200) -> Curve:
    """An unknot twisted into a rope of length 2: two strands at a distance that may be far below an edge.

    The strands turn around each other ``twists`` times, negative for the left-handed rope; ``vertices`` is even.
    Raises ValueError if they are fewer than 8 per twist.
    """
    steps = (vertices - 4) // 2
    # Cross-sections of the two strands are opposite each other, so they cannot meet while an edge turns by less than
    # half a turn; a quarter leaves them a good part of the gap.
    if vertices % 2 or abs(twists) > steps / 4:
        raise ValueError(f"vertices is {vertices}; a rope of {twists} twists takes an even number, 8 per twist")
    x = np.linspace(-1.0, 1.0, steps + 1)
    angle = math.pi * twists * x
    strand = np.stack([x, gap / 2 * np.cos(angle), gap / 2 * np.sin(angle)], axis=1)
    tip = 1.0 + 2.0 / steps
    return Curve(np.concatenate([strand, [[tip, 0, 0]], (strand * [1, -1, -1])[::-1], [[-tip, 0, 0]]]))


def lattice_closure(word: Word) -> Curve:
    """The closure of a braid as a polygon with corners on the integer lattice and edges along its axes.

    It is coarse, with parallel edges that hide each other. Strands run along y at x = 0, 1, …, one step below those
    that cross over them, and return in the plane z = 0; a crossing is 3 long.
    """
    letters, count = checked_word(word)
    places, width = columns(letters)
    crossings = {}  # by column and place: where the strand goes, and whether it passes over
    for letter, column in zip(letters, places, strict=True):
        left, over = abs(letter) - 1, letter > 0
        crossings[column, left] = 1, over
        crossings[column, left + 1] = -1, not over
    components = []
    for cycle in cycles(letters, count):
        path: list[tuple[int, int, int]] = []
        for place in cycle:
            path.append((place, 0, 0))
            for column in range(width):
                step, over = crossings.get((column, place), (0, False))
                y, beyond = 3 * column, place + step
                if over:
                    path += [(place, y, 0), (place, y, 1), (place, y + 2, 1), (beyond, y + 2, 1), (beyond, y + 2, 0)]
                elif step:
                    path += [(place, y + 1, 0), (beyond, y + 1, 0)]
                place = beyond
            outward = count - place  # the way back to where the next strand starts
            top, side = 3 * width + outward, count - 1 + outward
            path += [(place, top, 0), (side, top, 0), (side, -outward, 0), (place, -outward, 0)]
        points = np.array(path)
        points = points[np.any(points != np.roll(points, -1, axis=0), axis=1)]
        before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
        components.append(points[np.any(np.sign(before) != np.sign(after), axis=1)])  # where it turns
    return Curve.from_components(components)


def lattice_knot(name: str) -> Curve:
    """A knot or link of the table as a coarse polygon on the cubic lattice."""
    return lattice_closure(braid_word(name))


def lattice_unknot(crossings: int, seed: int) -> Curve:
    """A hard unknot as a coarse polygon on the cubic lattice."""
    return lattice_closure(unknot_word(crossings, seed))


def hard_unknot(crossings: int, seed: int, vertices: int | None = None) -> Curve:
    """An unknot as the closure of a braid with a given number of crossings, no two of which cancel as they stand.

    By default it has so many vertices that edges are shorter than strands are apart.

    >>> len(hard_unknot(20, seed=7).mesh.component_sizes)
    1
    """
    return braid_closure(unknot_word(crossings, seed), vertices)


def unknot_word(crossings: int, seed: int) -> Word:
    """Give a braid word of ``crossings`` letters whose closure is the unknot, though no two letters cancel.

    It comes from the trivial braid on one strand by Markov's moves alone: stabilisations, insertions of σ σ⁻¹,
    braid relations and conjugations, all of which keep the closure (Markov 1935; Birman, *Braids, Links, and
    Mapping Class Groups*, 1974).
    """
    strands = min(3 + max(crossings, 0) // 60, crossings + 1)
    strands += (crossings - strands) % 2 == 0  # a knot of n strands has a number of crossings of the other parity
    rng = np.random.default_rng(seed)
    word: list[int] = []
    for new in range(1, strands):
        word.insert(int(rng.integers(len(word) + 1)), new if rng.random() < 0.5 else -new)
        # a little growth at every strand hides its stabilisation, most at the end spreads over all strands
        length = crossings if new == strands - 1 else min(3 * new, crossings - strands + 1 + new)
        while len(word) + 2 <= length and new > 1:  # pairs σ σ⁻¹ of a rarer letter, braided with 6 letters around
            place = int(rng.integers(len(word) + 1))
            letters = rng.integers(1, new + 1, size=2).tolist()
            letter = min(letters, key=lambda each: word.count(each) + word.count(-each))
            letter = letter if rng.random() < 0.5 else -letter
            trial = [*word[:place], letter, -letter, *word[place:]]
            for start in (place + rng.integers(-6, 6, size=12)).tolist():
                _relate(trial, start)
            word = trial if _is_reduced(trial) else word
        # relations all over the word, also across its end, which is conjugation
        for start in rng.integers(len(word), size=4 * len(word)).tolist():
            trial = list(word)
            _relate(trial, start)
            word = trial if trial == word or _is_reduced(trial) else word
    return tuple(word)


def _relate(word: list[int], start: int) -> None:
    """Apply a braid relation to the three letters from ``start`` on, if there is one."""
    if len(word) < 3:
        return
    first, second, third = places = [(start + k) % len(word) for k in range(3)]
    a, b, c = (word[place] for place in places)
    i, j = abs(a), abs(b)
    if abs(i - j) >= 2:
        word[first], word[second] = b, a
    elif i != abs(c) or i == j:
        return
    elif a == -c:  # σᵢᵉ σⱼᶠ σᵢ⁻ᵉ = σⱼ⁻ᵉ σᵢᶠ σⱼᵉ
        e, f = a // i, b // j
        word[first], word[second], word[third] = -e * j, f * i, e * j
    elif a * b > 0:  # σᵢ σⱼ σᵢ = σⱼ σᵢ σⱼ
        word[first], word[second], word[third] = b, a, b


def _is_reduced(word: list[int]) -> bool:
    """Whether no letter meets its inverse further on, also across the end, past letters that it commutes with."""
    for place, letter in enumerate(word):
        others = (word[(place + step) % len(word)] for step in range(1, len(word)))
        if next((other for other in others if abs(abs(other) - abs(letter)) < 2), None) == -letter:
            return False
    return True
