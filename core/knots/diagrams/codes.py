"""Diagrams from codes as people write them: PD, DT and Gauss codes with any brackets.

    PD[X[1,5,2,4], X[3,1,4,6], X[5,3,6,2]]     DT: [4 6 2]     DT: cacbca     DT[cacbca.001]
    Gauss: 1 -2 3 -1 2 -3                      Gauss: O1+U2+O3+U1+O2+U3+

Lists in brackets need no word before them, as SnapPy and KnotInfo write them: [[1,5,2,4], …] with every number twice is
a PD code, with signs a Gauss code, and [4, 6, 2] or [(6, 8), (2, 4)] with every number once a DT code.

PD codes, Gauss codes with signs and DT codes with SnapPy's flips, a 0 or 1 for each crossing, say everything; other DT
and Gauss codes leave mirror images open, of which that one is taken whose first crossing is positive.  Components of
Gauss codes of either kind stand in brackets, on lines of their own, or with /, | or ; between them; [] is a circle that
crosses nothing.
"""

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from itertools import islice
from typing import Any, NamedTuple, cast

from ...base import CurveError, check_known
from .diagram import Diagram, Pass, diagram_of
from .realization import in_the_plane, realized

Nested = Sequence["int | str | Nested"]
_PLAIN = r"(?P<open>[\[({])|(?P<close>[\])}])|(?P<number>[+-]?\d+)|(?P<blank>[,;]|\s+)|(?P<other>[A-Za-z]+|.)"
_SIGNED = r"(?P<signed>[OU]\d{1,9}[+-])"


class CodeError(CurveError):
    """Something in a code that cannot be read, and where: ``position`` counts characters from 0."""

    def __init__(self, reason: str, position: int) -> None:
        super().__init__(f"character {position + 1} of the code: {reason}")
        self.position = position


def nested(text: str, between: str | None = None) -> Nested:
    """Whole numbers, between blanks, commas or semicolons, in lists for their brackets.

    ``between`` is a pattern of what ends one list and begins the next, like ``],[``, with brackets around it all;
    signed passes such as O1+ are then read like numbers, as strings.  Raises CodeError if there is anything else, or
    brackets do not match.
    """
    pattern = f"(?P<between>{between})|{_SIGNED}|{_PLAIN}" if between else _PLAIN
    stack: list[list[object]] = [[], []]
    opened: list[int] = []
    for match in re.finditer(pattern, text, re.ASCII | re.IGNORECASE | re.DOTALL):
        kind, token, at = match.lastgroup, match[0], match.start()
        if kind == "open":
            opened.append(at)
            if len(opened) > 8:
                raise CodeError("brackets are nested more than 8 deep", at)
            stack.append([])
        elif kind == "close":
            if not opened:
                raise CodeError("a closing bracket too many", at)
            opened.pop()
            _close(stack)
        elif kind == "between":
            _close(stack, empty=at)
            stack.append([])
        elif kind == "signed":
            stack[-1].append(token.upper())
        elif kind == "number" and len(token) <= 9:
            stack[-1].append(int(token))
        elif kind != "blank":
            reason = f"{token[:30]!a} is neither a bracket nor a whole number of at most 9 digits"
            raise CodeError(reason, at)
    if opened:
        raise CodeError("this bracket has no closing one", opened[-1])
    _close(stack, empty=len(text) - 1 if stack[0] else None)
    return cast(Nested, stack[0] if between else stack[0][0])


def _close(stack: list[list[object]], empty: int | None = None) -> None:
    done = stack.pop()
    if not done and empty is not None:
        raise CodeError("a component is empty; write [] for a circle that crosses nothing", empty)
    stack[-1].append(done)


def unwrapped(rows: Nested) -> Nested:
    """What is within brackets around it all."""
    while len(rows) == 1 and not isinstance(rows[0], int | str):
        if _is_flat(rows[0]) and rows[0]:
            return rows[0]
        rows = rows[0]
    return rows


def components(rows: Nested) -> list[list[Any]]:
    """Numbers, or signed passes, in lists for each component or crossing; CurveError for lists deeper down."""
    rows = unwrapped(rows)
    parts = [rows] if _is_flat(rows) else [[row] if isinstance(row, int | str) else unwrapped(row) for row in rows]
    if not all(map(_is_flat, parts)):
        raise CurveError("brackets of the code are not where they should be: write numbers, or lists of numbers")
    return list(map(list, parts))


def _is_flat(rows: Nested) -> bool:
    return all(isinstance(each, int | str) for each in rows)


MAX_CROSSINGS = 1000  # of a code; relaxing takes minutes
_SPELLING = re.compile(r"[\s\[({\"']*([A-Za-z]+)(?:\.([01]+))?[\s\])}\"']*")
_CROSSING = re.compile(r"(?<![A-Za-z])X[pm]?(?=\s*[\[({])")
_CIRCLE = re.compile(r"\bP\s*\[\s*(\d+)\s*,\s*\1\s*\]")  # one that crosses nothing, as KnotFolio writes it
_BRACKETS = ("[", "(", "{")


class Notation(NamedTuple):
    """A way to write diagrams: the words that may stand before it, an example, and what reads it."""

    words: str
    example: str
    read: Callable[[str], Diagram]


def is_code(text: str) -> bool:
    """Whether a text begins as codes do: with PD, DT or Gauss, or a bracket."""
    return _begun(text) is not None or text.lstrip().startswith(_BRACKETS)


def diagram_from_code(text: str, kind: str | None = None) -> Diagram:
    """The diagram of a code as described above; ``kind``, a key of `NOTATIONS`, is for texts that do not say theirs.

    Raises CurveError if it is no such code, of no diagram in the plane, or too long; a `CodeError` knows where.
    """
    if len(text) > 100_000:
        raise CurveError(f"the code has {len(text)} characters; at most 100000 are read")
    kind, start = _begun(text) or (kind, len(text) - len(text.lstrip(" \t\n,;")))
    text = " " * start + text[start:].rstrip()  # so that errors count characters from where the text begins
    if not kind:  # a list without words before it
        if not text.lstrip().startswith(_BRACKETS):
            raise CurveError("the code does not say what it is; begin it with PD:, DT: or Gauss:")
        parts = components(_without_flips(unwrapped(nested(text)))[0])
        numbers = [number for part in parts for number in part]
        if len(set(map(abs, numbers))) == len(numbers):
            kind = "dt"
        elif len(parts) > 1 and min(numbers) >= 0:
            kind = "pd"
        elif Counter(numbers) == Counter(-number for number in numbers):
            kind = "gauss"
        else:
            advice = "begin it with PD:, DT: or Gauss:, or write braids as {1,1,1}"
            raise CurveError(f"the code does not say what it is; {advice}")
    check_known("kind", kind, NOTATIONS)
    if not text.strip(" \t\n,;"):
        raise CurveError(f"the code is empty; write such as {NOTATIONS[kind].example}")
    diagram = NOTATIONS[kind].read(text)
    check_count(diagram.crossings)
    return diagram


def _begun(text: str) -> tuple[str, int] | None:
    """The notation whose words a text begins with, and where the code begins."""
    for kind, notation in NOTATIONS.items():
        if match := re.match(rf"\s*{notation.words}\b\s*(?:code\b\s*)?[:=]?\s*", text, re.IGNORECASE):
            return kind, match.end()
    return None


def check_count(crossings: int) -> None:
    """Raise a CurveError if there are too many crossings to be relaxed in minutes."""
    if crossings > MAX_CROSSINGS:
        raise CurveError(f"the code has {crossings} crossings; at most {MAX_CROSSINGS} are allowed")


def _planar(text: str) -> Diagram:
    text, circles = _CIRCLE.subn(" ", text)
    rows = components(nested(_CROSSING.sub(" ", text)))
    if len(rows) == 1:
        rows = [rows[0][k : k + 4] for k in range(0, len(rows[0]), 4)]
    check_count(len(rows) + circles)
    diagram = diagram_of(rows)
    return Diagram((*diagram.passes, *((),) * (circles or not rows)), diagram.signs)


def _dowker_thistlethwaite(text: str) -> Diagram:
    if spelling := _SPELLING.fullmatch(text):
        # letters count crossings, components and the crossings of each; then comes the code
        values = [ord(letter.lower()) - 96 if letter.islower() else 64 - ord(letter) for letter in spelling[1]]
        crossings, count = (*values, 0, 0)[:2]
        sizes, code = values[2 : 2 + count], values[2 + max(count, 0) :]
        if min(sizes, default=0) < 1 or len(code) != crossings or sum(sizes) != crossings:
            raise CurveError(
                "letters of a DT code count its crossings, its components and the crossings of each, and give then a "
                "letter for each crossing, such as DT: cacbca; flips may follow, such as DT: cacbca.001"
            )
        evens = iter(2 * value for value in code)
        parts, flips = [[next(evens) for _ in range(size)] for size in sizes], list(map(int, spelling[2] or ""))
    else:
        rows, flips = _without_flips(unwrapped(nested(text)))
        parts = components(rows)
    numbers = [number for part in parts for number in part]
    check_count(len(numbers))
    seen: set[int] = set()
    for place, number in enumerate(numbers, start=1):
        if number % 2 or not 0 < abs(number) <= 2 * len(numbers) or abs(number) in seen:
            raise CurveError(
                f"a DT code of {len(numbers)} numbers has each of 2, 4, … {2 * len(numbers)} once, with any sign, and "
                f"its number {place} is {number}{' again' if abs(number) in seen else ''}"
            )
        seen.add(abs(number))
    sequence: list[Pass] = [(0, False)] * (2 * len(numbers))
    for k, number in enumerate(numbers):
        sequence[2 * k], sequence[abs(number) - 1] = (k, number > 0), (k, number < 0)
    rest = iter(sequence)
    passes = tuple(tuple(islice(rest, 2 * len(part))) for part in parts)
    if not flips:
        return realized(passes)
    if len(flips) != len(numbers):
        raise CurveError(f"the DT code has {len(numbers)} crossings and {len(flips)} flips")
    # SnapPy: from where the curve first comes to a crossing, the other strand comes from the right, or from the left if
    # flipped.
    first = dict(reversed(sequence))
    signs = tuple(1 if first[crossing] != bool(flip) else -1 for crossing, flip in enumerate(flips))
    return in_the_plane(Diagram(passes, signs), "the DT code with these flips")


def _without_flips(rows: Nested) -> tuple[Nested, list[int]]:
    """A DT code, and the list of a 0 or 1 for each crossing that may come after it."""
    if len(rows) != 2:
        return rows, []
    code, flips = rows
    if isinstance(code, int | str) or isinstance(flips, int | str) or not flips or any(k not in (0, 1) for k in flips):
        return rows, []
    return code, [k == 1 for k in flips]


def _gauss(text: str) -> Diagram:
    between = r"\s*[/|;]\s*" if any(bracket in text for bracket in _BRACKETS) else r"\s*[/|;]\s*|\s*\n\s*"
    parts = components(nested(text, between))  # within brackets lines may end anywhere
    check_count(sum(map(len, parts)) // 2)
    signed = any(isinstance(each, str) for part in parts for each in part)
    number: dict[int, int] = {}  # from 0, of each crossing
    levels: dict[int, list[bool]] = {}
    signs: dict[int, int] = {}
    passes: list[list[Pass]] = []
    for part in parts:
        passes.append([])
        for each in part:
            if isinstance(each, str):
                crossing, over, sign = int(each[1:-1]), each[0] == "O", 1 if each[-1] == "+" else -1
            elif signed:
                raise CurveError(f"{each} is not a term of a signed Gauss code such as O1+U2+O3+U1+O2+U3+")
            else:
                crossing, over, sign = abs(each), each > 0, 1
            if signs.setdefault(crossing, sign) != sign:
                raise CurveError(f"crossing {crossing} of the Gauss code has both signs")
            levels.setdefault(crossing, []).append(over)
            passes[-1].append((number.setdefault(crossing, len(number)), over))
    for crossing, found in levels.items():
        if sorted(found) != [False, True]:
            told = f"crossing {crossing} of the Gauss code must be there once above (positive) and once below"
            raise CurveError(told)
    if not signed:
        return realized(passes)
    return in_the_plane(Diagram(tuple(map(tuple, passes)), tuple(signs.values())), "the Gauss code with these signs")


def joined(diagrams: Sequence[Diagram]) -> Diagram:
    """The connected sum of diagrams of knots, or one diagram; raises CurveError if one of several is of a link."""
    if len(diagrams) == 1:
        return diagrams[0] if diagrams[0].passes else Diagram(((),), ())
    passes: list[Pass] = []
    signs: list[int] = []
    for diagram in diagrams:
        if len(diagram.passes) > 1:
            raise CurveError("a summand is a link, and the code does not say which components are joined")
        passes += [(crossing + len(signs), over) for part in diagram.passes for crossing, over in part]
        signs += diagram.signs
    return Diagram((tuple(passes),), tuple(signs))


def planar_text(diagram: Diagram) -> str:
    """PD code, edges numbered from 1; raises CurveError for components without crossings, which it does not have."""
    if not all(diagram.passes):
        raise CurveError("PD codes have no components without crossings; use .gauss")
    crossings = (f"X[{','.join(str(edge + 1) for edge in edges)}]" for edges in diagram.planar_code)
    return f"PD[{', '.join(crossings)}]"


def gauss_text(diagram: Diagram) -> str:
    """Gauss code with signs, crossings numbered from 1."""
    signs = ["+" if sign > 0 else "-" for sign in diagram.signs]
    parts = ("".join(f"{'UO'[over]}{c + 1}{signs[c]}" for c, over in part) or "[]" for part in diagram.passes)
    return f"Gauss: {' / '.join(parts)}"


NOTATIONS: Mapping[str, Notation] = {
    "pd": Notation(r"(?:PD|Link(?=\())", "PD[X[1,5,2,4], X[3,1,4,6], X[5,3,6,2]]", _planar),
    "dt": Notation("DT", "DT: [4 6 2]", _dowker_thistlethwaite),
    "gauss": Notation(r"Gauss(?:\s?code)?", "Gauss: 1 -2 3 -1 2 -3", _gauss),
}
"""How codes may be written."""
