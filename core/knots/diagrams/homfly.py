"""The HOMFLY polynomial P(v, z) of oriented links, 1 for the unknot, by its skein relation

    P(L₊) / v − v P(L₋) = z P(L₀)

(Freyd, Yetter, Hoste, Lickorish, Millett, Ocneanu, *Bull. AMS* 12, 1985; signs and letters are those of KnotInfo).
Crossings that the curve first passes below are changed one by one; a diagram that is passed above first everywhere is
of circles that come apart.  Whatever makes a diagram smaller is done before.
"""

from collections.abc import Mapping
from functools import lru_cache

from .diagram import Diagram
from .rerouting import simplified

Polynomial = Mapping[tuple[int, int], int]  # powers of v and z to coefficients, which are not 0
MAX_CROSSINGS = 24  # a second or two


def homfly(diagram: Diagram) -> Polynomial | None:
    """The HOMFLY polynomial, v² (2 − v² + z²) for the right-handed trefoil; None for too many crossings."""
    return _homfly(simplified(diagram)) if diagram.crossings <= MAX_CROSSINGS else None


def homfly_text(polynomial: Polynomial) -> str:
    """The polynomial as people write it, by powers of z: (2v² − v⁴) + v² z²."""

    def raised(letter: str, power: int) -> str:
        digits = str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        return "" if not power else letter if power == 1 else letter + digits

    def joined(terms: list[tuple[int, str]]) -> str:
        text = " ".join(f"{'−' if sign < 0 else '+'} {term}" for sign, term in terms)
        return text.removeprefix("+ ").replace("− ", "−", text.startswith("−"))

    parts = []
    for z in sorted({z for _, z in polynomial}):
        own = [(polynomial[v, z], raised("v", v)) for v in sorted(v for v, power in polynomial if power == z)]
        terms = [(c, f"{'' if abs(c) == 1 and (v or (z and len(own) == 1)) else abs(c)}{v}") for c, v in own]
        sign, text = terms[0] if len(terms) == 1 else (1, f"({joined(terms)})")
        parts.append((sign, f"{text} {raised('z', z)}".strip()))
    return joined(parts)


@lru_cache(maxsize=20_000)
def _homfly(diagram: Diagram) -> Polynomial:
    """That of a diagram that no strand's move simplifies."""
    pieces = diagram.pieces()
    apart = {(-1, -1): 1, (1, -1): -1}  # the factor between parts, (1/v − v) / z
    if len(pieces) > 1:
        found = _homfly(pieces[0])
        for piece in pieces[1:]:
            found = _times(_times(found, apart), _homfly(piece))
        return found
    reached = set[int]()
    for crossing, over in diagram.sequence:
        if crossing not in reached and not over:
            break
        reached.add(crossing)
    else:  # one circle of any shape, or several
        found = {(0, 0): 1}
        for _ in diagram.passes[1:]:
            found = _times(found, apart)
        return found
    sign = diagram.signs[crossing]
    flipped = tuple(tuple((c, over != (c == crossing)) for c, over in part) for part in diagram.passes)
    changed = Diagram(flipped, tuple(-s if c == crossing else s for c, s in enumerate(diagram.signs)))
    # its strands turned into each other as their orientations let them
    (k, i), (m, j) = (
        (k, i) for k, part in enumerate(diagram.passes) for i, each in enumerate(part) if each[0] == crossing
    )
    here, there = diagram.passes[k], diagram.passes[m]
    parts = [part for n, part in enumerate(diagram.passes) if n not in (k, m)]
    if k == m:
        parts += [here[:i] + here[j + 1 :], here[i + 1 : j]]
    else:
        parts.append(here[:i] + there[j + 1 :] + there[:j] + here[i + 1 :])
    smoothed = Diagram(tuple(parts), diagram.signs).without({crossing})
    one, other = _homfly(simplified(changed)), _homfly(simplified(smoothed))
    both = {(v + 2 * sign, z): value for (v, z), value in one.items()}
    for (v, z), value in other.items():
        both[v + sign, z + 1] = both.get((v + sign, z + 1), 0) + sign * value
    return {powers: value for powers, value in both.items() if value}


def _times(a: Polynomial, b: Polynomial) -> Polynomial:
    found: dict[tuple[int, int], int] = {}
    for (v, z), x in a.items():
        for (w, y), value in b.items():
            found[v + w, z + y] = found.get((v + w, z + y), 0) + x * value
    return {powers: value for powers, value in found.items() if value}
