"""``mobius-flow same``: whether two curves are the same knot or link, in one line."""

import argparse

from ..core import Iterate, Status
from ..core.driver import finish
from ..core.errors import counted
from ..core.morphing import NoMotionError, agreement, check_alike, difference, morphing, type_of
from . import options as relax_options
from .morph import NAMES, NOT_FOUND, add_pair, read_pair
from .signals import INTERRUPTED
from .streams import emit

_EPILOG = """\
examples:
  mobius-flow same a.txt b.txt
  mobius-flow same a.txt b.txt --hops 20

Invariants decide where they can; otherwise a motion is looked for, as mobius-flow morph does. Directions and the order
of components do not matter; mirror images do.

exit status:
  0    the same, with proof: a common type was identified, or a motion leads from one to the other
  1    different, with the invariant that says so, or not known
  2    bad input or bad options
  130  interrupted
"""


def add_same(parser: argparse.ArgumentParser) -> None:
    """Describe ``same``."""
    parser.description, parser.epilog = "Tell whether two curves are the same knot or link.", _EPILOG
    add_pair(parser)
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    wanted = relax_options.from_arguments(options)
    task, goal = (task for _, task in read_pair(options, wanted))
    check_alike((task.curve, goal.curve), NAMES)
    a, b = type_of(task.curve), type_of(goal.curve)
    if a and b and not task.obstacles and (agreed := agreement(a, b)):
        emit(f"same: {agreed}")
        return 0
    if a and b and (different := difference(a, b, NAMES)):
        emit(f"different: {different}")
        return NOT_FOUND
    way: list[Iterate] = []
    try:
        result = finish(morphing((task, goal), wanted, NAMES), task, wanted, way.append)
    except NoMotionError as error:
        emit(f"not known: {error}")
        return NOT_FOUND
    if not (result.outcome.converged and result.certified):
        emit(f"not known: {result.message}")
        return INTERRUPTED if result.status is Status.INTERRUPTED else NOT_FOUND
    legs = counted(sum(len(iterate.path) for iterate in way), "leg")
    emit(f"same: a motion of {legs}, proved free of contact, leads from one to the other")
    return 0
