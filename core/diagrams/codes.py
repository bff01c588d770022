"""Diagrams from codes as people write them: PD, DT and Gauss codes with any brackets.

    PD[X[1,5,2,4], X[3,1,4,6], X[5,3,6,2]]     DT: [4 6 2]     DT: cacbca
    Gauss: 1 -2 3 -1 2 -3                      Gauss: O1+U2+O3+U1+O2+U3+

PD codes and Gauss codes with signs say everything; DT codes and Gauss codes without signs leave mirror images open, of
which that one is taken whose first crossing is positive.  Components of Gauss codes of either kind stand in brackets,
on lines of their own, or with /, | or ; between them; [] is a circle that crosses nothing.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from itertools import count
from types import MappingProxyType
from typing import cast

from ..checks import check_known
from ..errors import CurveError
from .diagram import Diagram, Pass
from .faces import Faces
from .planar_codes import diagram_of
from .realize import realized

MAX_CROSSINGS = 1000  # seconds to draw
_MAX_LENGTH = 100_000  # characters
_TOKEN = re.compile(r"[\[({]|[\])}]|[+-]?\d+|[\s,;]+|.", re.ASCII | re.DOTALL)
_MAX_DIGITS = 9
_LETTERS = re.compile(r"[A-Za-z]+")
_SIGNED = re.compile(r"([OU])(\d{1,9})([+-])", re.ASCII | re.IGNORECASE)
_PREFIX = re.compile(r"\s*(PD|DT|Gauss(?:\s?code)?)\b\s*(?:code\b\s*)?[:=]?\s*", re.IGNORECASE)
_BETWEEN = re.compile(r"\s*[/|;]\s*|\s*\n\s*")
_FOREIGN = re.compile(r"[^\s\[\](){}|/;,]+")
_EXAMPLES = {"pd": "PD[X[1,5,2,4], X[3,1,4,6], X[5,3,6,2]]", "dt": "DT: [4 6 2]", "gauss": "Gauss: 1 -2 3 -1 2 -3"}

Nested = Sequence["int | Nested"]


def is_code(text: str) -> bool:
    """Whether a text begins as codes do, with PD, DT or Gauss."""
    return _PREFIX.match(text) is not None


def diagram_from_code(text: str, kind: str | None = None) -> Diagram:
    """The diagram that a code describes.

    Parameters
    ----------
    text
        The code; see the module.
    kind
        PD, DT or Gauss, if the text need not say so.

    Raises
    ------
    CurveError
        If it is no such code, of no diagram in the plane, or too long.
    """
    if len(text) > _MAX_LENGTH:
        raise CurveError(f"the code has {len(text)} characters; at most {_MAX_LENGTH} are read")
    match = _PREFIX.match(text)
    if match is not None:
        kind, text = match[1].split()[0], text[match.end() :]
    if kind is None:
        raise CurveError("the code does not say what it is; begin it with PD:, DT: or Gauss:")
    kind = kind.lower().removesuffix("code")
    check_known("kind", kind, _READERS)
    if not text.strip(" \t\n,;"):
        raise CurveError(f"the code is empty; write such as {_EXAMPLES[kind]}")
    diagram = _READERS[kind](text.strip())
    _check_count(diagram.crossings)
    return diagram


def _check_count(crossings: int) -> None:
    if crossings > MAX_CROSSINGS:
        raise CurveError(f"the code has {crossings} crossings; at most {MAX_CROSSINGS} are allowed")


def _planar(text: str) -> Diagram:
    rows = _unwrapped(_nested(re.sub(r"(?<![A-Za-z])X\s*(?=[\[({])", "", text)))
    if rows and all(isinstance(each, int) for each in rows):
        rows = [rows[k : k + 4] for k in range(0, len(rows), 4)]
    _check_count(len(rows))
    if not rows:
        return Diagram(((),), ())
    return diagram_of([_integers([row] if isinstance(row, int) else row) for row in rows])


def _dowker_thistlethwaite(text: str) -> Diagram:
    bare = text.strip("[](){}\"' ")
    parts = _spelled(bare) if _LETTERS.fullmatch(bare) else _components(text)
    numbers = [number for part in parts for number in part]
    _check_count(len(numbers))
    if sorted(map(abs, numbers)) != list(range(2, 2 * len(numbers) + 1, 2)):
        raise CurveError(
            f"a DT code of {len(numbers)} numbers has each of 2, 4, … {2 * len(numbers)} once, with any sign"
        )
    sequence: list[Pass] = [(0, False)] * (2 * len(numbers))
    for k, number in enumerate(numbers):
        sequence[2 * k], sequence[abs(number) - 1] = (k, number > 0), (k, number < 0)
    passes, start = [], 0
    for part in parts:
        passes.append(sequence[start : start + 2 * len(part)])
        start += 2 * len(part)
    return realized(passes)


def _spelled(word: str) -> list[list[int]]:
    """Numbers of the spelling in letters: counts of crossings, components, their crossings, and then the code."""
    values = [ord(letter.lower()) - 96 if letter.islower() else 64 - ord(letter) for letter in word]
    crossings, components = (*values, 0, 0)[:2]
    sizes, code = values[2 : 2 + components], values[2 + max(components, 0) :]
    if min(sizes, default=0) < 1 or len(code) != crossings or sum(sizes) != crossings:
        raise CurveError(
            "letters of a DT code count its crossings, its components and the crossings of each, and give then a "
            "letter for each crossing, such as DT: cacbca"
        )
    numbers = iter(2 * value for value in code)
    return [[next(numbers) for _ in range(size)] for size in sizes]


def _gauss(text: str) -> Diagram:
    if _SIGNED.search(text):
        return _signed_gauss(text)
    parts = _gauss_components(text)
    _check_count(sum(map(len, parts)) // 2)
    return realized(_numbered([[(abs(number), number > 0) for number in part] for part in parts])[0])


def _signed_gauss(text: str) -> Diagram:
    if foreign := _FOREIGN.search(_SIGNED.sub("", text)):
        raise CurveError(f"{foreign[0][:30]!a} is no part of a Gauss code such as O1+U2+O3+U1+O2+U3+")
    found, signs = _SIGNED.findall(text), dict[int, str]()
    for _, number, sign in found:
        if signs.setdefault(int(number), sign) != sign:
            raise CurveError(f"crossing {number} of the Gauss code has both signs")
    place = count()
    places = _gauss_components(_SIGNED.sub(lambda _: f"{next(place)} ", text))
    passes, numbers = _numbered([[(int(found[k][1]), found[k][0] in "Oo") for k in part] for part in places])
    _check_count(len(numbers))
    diagram = Diagram(tuple(map(tuple, passes)), tuple(1 if signs[number] == "+" else -1 for number in numbers))
    if not Faces(diagram).is_planar:
        raise CurveError("the Gauss code with these signs is of no diagram in the plane")
    return diagram


def _gauss_components(text: str) -> list[list[int]]:
    """Lists of numbers, one per component."""
    if any(bracket in text for bracket in "[({"):
        text = text.replace("\n", " ")  # lines may end anywhere within brackets
    if not all(_BETWEEN.split(text)):
        raise CurveError("a component of the Gauss code is empty; write [] for a circle that crosses nothing")
    return _components(f"[{_BETWEEN.sub('],[', text)}]")


def _numbered(parts: Sequence[Sequence[Pass]]) -> tuple[list[list[Pass]], list[int]]:
    """Passes with crossings numbered from 0, and the numbers that they had; each must be passed above and below."""
    levels: dict[int, list[bool]] = {}
    for old, over in (each for part in parts for each in part):
        levels.setdefault(old, []).append(over)
    for old, found in levels.items():
        if sorted(found) != [False, True]:
            raise CurveError(f"crossing {old} of the Gauss code must be there once above (positive) and once below")
    number = {old: k for k, old in enumerate(levels)}
    return [[(number[old], over) for old, over in part] for part in parts], list(number)


def _components(text: str) -> list[list[int]]:
    """Lists of numbers, one per component."""
    rows = _unwrapped(_nested(text))
    if all(isinstance(each, int) for each in rows):
        return [_integers(rows)]
    return [_integers(row if isinstance(row, int) else _unwrapped(row)) for row in rows]


def _integers(row: "int | Nested") -> list[int]:
    if isinstance(row, int) or not all(isinstance(each, int) for each in row):
        raise CurveError("brackets of the code are not where they should be: write numbers, or lists of numbers")
    return list(cast(Sequence[int], row))


def _unwrapped(rows: Nested) -> Nested:
    """What is within brackets around it all."""
    while len(rows) == 1 and not isinstance(rows[0], int):
        if rows[0] and all(isinstance(each, int) for each in rows[0]):
            return rows[0]
        rows = rows[0]
    return rows


def _nested(text: str) -> Nested:
    """Numbers in brackets of any kind as lists."""
    stack: list[list[object]] = [[]]
    for token in _TOKEN.findall(text):
        if token in "[({":
            stack.append([])
        elif token in "])}":
            if len(stack) < 2:
                raise CurveError("the code has a closing bracket too many")
            done = stack.pop()
            stack[-1].append(done)
        elif token.lstrip("+-").isdigit() and len(token) <= _MAX_DIGITS:
            stack[-1].append(int(token))
        elif not re.fullmatch(r"[\s,;]+", token):
            raise CurveError(f"{token[:30]!a} in the code is neither a bracket nor a whole number of at most 9 digits")
    if len(stack) > 1:
        raise CurveError("the code has no closing bracket")
    return cast(Nested, stack[0])


_READERS: Mapping[str, Callable[[str], Diagram]] = MappingProxyType(
    {"pd": _planar, "dt": _dowker_thistlethwaite, "gauss": _gauss}
)
