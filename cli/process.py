"""The command line as a process of its own, with its streams, signals and warnings."""

import sys
import warnings

from . import signals, streams
from .main import main


def run() -> int:
    """Run the command line and return the exit status."""
    signals.leave_at_once()
    streams.mend()
    if not sys.warnoptions:
        warnings.simplefilter("ignore")  # they are for programmers; what users should know is logged
    try:
        return main()
    finally:
        signals.hold()  # all is written: a signal now changes nothing
