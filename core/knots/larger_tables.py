"""Knots and links of larger tables by their names there, where spherogram is installed, which has them all.

Hoste and Thistlethwaite number alternating and other ones apart, to fourteen crossings; which mirror image is meant is
spherogram's (and SnapPy's) choice.
"""

import re

from ..errors import MobiusFlowError
from .braids import Word

_NAME = re.compile(r"(?P<kind>[kl]?)(?P<crossings>[1-9]\d?)_?(?P<sort>[an])_?0*(?P<number>[1-9]\d{0,5})", re.ASCII)
_OTHERWISE = 'give its code, such as "DT: [4 6 2]", "PD[X[1,5,2,4], ...]" or "Gauss: 1 -2 3 -1 2 -3"'


def larger_name(name: str) -> str | None:
    """The name, such as K11n34, that is meant by one in small letters (``11n_34``); None if it is none of this form.

    Examples
    --------
    >>> larger_name("12a_0003"), larger_name("l10a100"), larger_name("3_1")
    ('K12a3', 'L10a100', None)
    """
    match = _NAME.fullmatch(name)
    if match is None:
        return None
    kind, crossings, sort, number = match.groups()
    return f"{(kind or 'k').upper()}{crossings}{sort}{number}"


def larger_word(name: str) -> Word:
    """A braid word of a knot or link that `larger_name` names; raises MobiusFlowError if there is none, or no table."""
    try:
        from spherogram import Link
    except ImportError as error:
        advice = f'try pip install spherogram (the extra "knots"), or {_OTHERWISE}'
        raise MobiusFlowError(f"{name} is in larger tables than the one here; {advice}") from error
    try:
        link = Link(name)
    except ValueError as error:
        raise MobiusFlowError(f"no knot or link is called {name} in spherogram's tables; {_OTHERWISE}") from error
    return tuple(map(int, link.braid_word()))
