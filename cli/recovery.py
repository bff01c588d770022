"""Results that cannot be written where they should be are kept elsewhere."""

import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from ..core import MobiusFlowError

Write = Callable[[str], None]


def kept(path: str, write: Write, rescue: Write | None = None, name: str | None = None) -> list[str]:
    """Write a result; where that fails keep it in a temporary directory, and return the sentences that say so.

    Parameters
    ----------
    path
        Where it should be.
    write
        Writes it to a path.
    rescue, name
        Another way to write it, and a file name, for the temporary directory: a curve instead of a film.
    """
    try:
        write(path)
    except (MobiusFlowError, OSError, MemoryError) as error:
        reason = str(error) if isinstance(error, MobiusFlowError) else f"{path}: {_said(error)}"
    else:
        return []
    try:
        place = Path(tempfile.mkdtemp(prefix="mobius-flow-"), os.path.basename(name or path))
    except OSError:
        return [reason]
    try:
        (rescue or write)(str(place))
    except (MobiusFlowError, OSError, MemoryError):
        shutil.rmtree(place.parent, ignore_errors=True)
        return [reason]
    return [f"{reason} (the result is kept as {place})"]


def _said(error: Exception) -> str:
    if isinstance(error, OSError):
        return f"cannot be written: {error.strerror or error}"
    return "there is not enough memory to write it"
