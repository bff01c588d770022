"""``mobius-flow same``: whether two curves are the same knot or link, in one line."""

import argparse

from ..core import Iterate, Status
from ..core.driver import finish
from ..core.errors import counted
from ..core.morphing import DifferentError, NoMotionError, compare, moving
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
    tasks = [task for _, task in read_pair(options, wanted)]
    iterates = moving(tasks, wanted, NAMES)
    way: list[Iterate] = []
    try:
        agreed = compare([each.curve for each in tasks], NAMES)
        if agreed and not options.avoid:
            emit(f"same: {agreed}")
            return 0
        result = finish(iterates, tasks[0], wanted, way.append)
    except NoMotionError as error:
        emit(f"{'different' if isinstance(error, DifferentError) else 'not known'}: {error}")
        return NOT_FOUND
    if not (result.outcome.converged and result.certified):
        emit(f"not known: {result.message}")
        return INTERRUPTED if result.status is Status.INTERRUPTED else NOT_FOUND
    legs = counted(sum(len(iterate.path) for iterate in way), "leg")
    emit(f"same: a motion of {legs}, proved free of contact, leads from one to the other")
    return 0
