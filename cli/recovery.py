"""Results that cannot be written where they should be are kept elsewhere."""

import os
import shutil
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

from ..core import MobiusFlowError

Write = Callable[[str], None]


def kept(path: str, write: Write, rescue: Write | None = None, name: str | None = None) -> list[str]:
    """Write a result; where that fails keep it in a temporary directory, and return the sentences that say so.

    So it is where it is interrupted; the sentence is then that of the KeyboardInterrupt, which goes on.

    Parameters
    ----------
    path
        Where it should be.
    write
        Writes it to a path.
    rescue, name
        Another way to write it, and a file name, for the temporary directory: a curve instead of a film.
    """
    keep = partial(_elsewhere, rescue or write, os.path.basename(name or path))
    try:
        write(path)
    except KeyboardInterrupt as interrupt:
        raise KeyboardInterrupt(keep(f"{path} is not written")) from interrupt
    except (MobiusFlowError, OSError, MemoryError) as error:
        return [keep(str(error) if isinstance(error, MobiusFlowError) else f"{path}: {_said(error)}")]
    return []


def _elsewhere(write: Write, name: str, reason: str) -> str:
    """Write to a temporary directory; return the reason for that, and the place if it could be done."""
    try:
        place = Path(tempfile.mkdtemp(prefix="mobius-flow-"), name)
    except OSError:
        return reason
    try:
        write(str(place))
    except (MobiusFlowError, OSError, MemoryError):
        shutil.rmtree(place.parent, ignore_errors=True)
        return reason
    return f"{reason} (the result is kept as {place})"


def _said(error: Exception) -> str:
    if isinstance(error, OSError):
        return f"cannot be written: {error.strerror or error}"
    return "there is not enough memory to write it"
