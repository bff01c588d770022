"""Figures by matplotlib, where it is installed."""

import os
from typing import TYPE_CHECKING

from ..core import MobiusFlowError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def figure_class(instead: str = "") -> "type[Figure]":
    """Matplotlib's figure, which needs no window; a MobiusFlowError tells where it is missing."""
    backend = os.environ.pop("MPLBACKEND", None)  # for windows, of which there are none here; it may be nonsense
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        advice = "try pip install matplotlib" + (f", {instead}" if instead else "")
        raise MobiusFlowError(f"figures need matplotlib, which is not installed; {advice}") from error
    finally:
        if backend is not None:
            os.environ["MPLBACKEND"] = backend
    return Figure
