"""Where a result comes from: enough to make it again, bit for bit with the same libraries and BLAS threads."""

import platform

import numpy
import scipy

from .. import __version__
from ..core import RelaxOptions, Task
from ..core.curve.io import CurveFile
from ..core.system.threads import THREADS


def provenance(options: RelaxOptions, task: Task, file: CurveFile) -> dict[str, object]:
    """The version, the options as used, the input and its hash, the BLAS threads and the libraries, as plain values."""
    return {
        "options": plain(options, task),
        "input": {"name": str(file.source.path), "sha256": file.source.sha256},
        **environment(),
    }


def plain(options: RelaxOptions, task: Task) -> dict[str, object]:
    """The options as plain values, with the pins of a task and the names of its obstacles."""
    respected = {"pins": task.pins, "pin_tangents": task.pin_tangents}
    return vars(options) | respected | {"avoid": [each.name for each in task.obstacles]}


def environment() -> dict[str, object]:
    """The version, the BLAS threads and the libraries, as plain values."""
    return {
        "version": __version__,
        "blas_threads": THREADS,
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
    }
