"""Errors that a user can act on: one sentence saying what, where, and what to do."""

import difflib
import os
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Place:
    """Where on a curve something is the matter, for those who can point at it."""

    vertices: tuple[int, ...]  # from 0, for edges their ends; none of a refined curve, whose vertices nobody has seen
    position: tuple[float, ...]  # coordinates in the curve's units; shape (m,)


class MobiusFlowError(ValueError):
    """Base of every error that is the input's fault rather than the program's."""


class CurveError(MobiusFlowError):
    """A curve that cannot be used: too few points, not finite, touching itself, ...

    ``place`` is where on the curve, if it is somewhere; the message says so too, in words.
    """

    def __init__(self, message: str, place: Place | None = None) -> None:
        super().__init__(message)
        self.place = place


class OptionError(MobiusFlowError):
    """An option outside its range; the message names the option and what is allowed."""


class CurveOptionError(OptionError, CurveError):
    """An option that does not fit a curve: both are named."""


class CurveFileError(CurveError):
    """A curve file that cannot be read; the message names the file, the line and the reason."""

    def __init__(self, path: Path | str, reason: str, line: int | None = None) -> None:
        place = f"{path}" if line is None else f"{path}, line {line}"
        super().__init__(f"{place}: {reason}")
        self.path, self.line, self.reason = Path(path), line, reason


class OutputError(MobiusFlowError):
    """A file that cannot be written; the message names it and the reason."""

    def __init__(self, path: Path | str, error: Exception) -> None:
        super().__init__(f"{path}: cannot be written: {reason_of(error)}")


def reason_of(error: Exception) -> str:
    """Why a path cannot be opened: the system's words without its number, or those about a null character."""
    return getattr(error, "strerror", None) or str(error).strip()


def shown(value: object) -> str:
    """What a value looks like in a message: on one line, and cut where it is long."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else f"{text[:57]}…"


def counted(number: int, noun: str) -> str:
    """Say how many things there are, one or several.

    >>> counted(1, "stage"), counted(56, "leg")
    ('1 stage', '56 legs')
    """
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def choice(name: str, known: Iterable[str]) -> str:
    """Say what can be chosen instead of an unknown name, the likeliest first.

    >>> choice("lbgfs", ["lbfgs", "cg"])
    'did you mean lbfgs? choose one of lbfgs, cg'
    """
    known = list(known)
    return f"{likeliest(name, known)}choose one of {', '.join(known)}"


def likeliest(name: str, known: Iterable[str]) -> str:
    """Ask whether a known name was meant, one that begins so before one that is alike; empty if there is none."""
    by_lower = {key.lower(): key for key in known}
    begun = [key for key in by_lower if name and key.startswith(name.lower())]
    close = begun or difflib.get_close_matches(name.lower(), by_lower, n=1)
    return f"did you mean {by_lower[close[0]]}? " if close else ""


def wrong_suffix(path: Path | str, known: Collection[str], kind: str) -> str:
    """Say why the suffix of a path does not tell what a file of some kind ("curve files") holds."""
    if os.path.isdir(path):
        return "is a directory; name a file"
    suffix = Path(path).suffix
    found = f"unknown suffix {suffix!r}" if suffix else "no suffix"
    return f"{found}; {likeliest(suffix, known)}{kind} end in {', '.join(known)}"
