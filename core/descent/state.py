"""What a method remembers from step to step: a value that is passed in and out."""

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True, eq=False)
class State:
    """Where a method stands: its own memory (None at the start) and the last accepted step size."""

    memory: Any = None
    last_step: float = np.inf
