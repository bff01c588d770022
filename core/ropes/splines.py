"""Closed polygons inscribed in uniform cubic B-splines."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp


def cubic_splines(controls: Sequence[int], per: int) -> sp.csr_array:
    """What makes vertices of control points, ``per`` for each; closed curves with such numbers of ``controls``."""
    t = np.arange(per)[:, None] / per
    weights = (1.0 - t) ** 3, (3.0 * t - 6.0) * t**2 + 4.0, ((3.0 - 3.0 * t) * t + 3.0) * t + 1.0, t**3
    ones = [sp.eye_array(n, format="csr") for n in controls]
    turns = [sp.block_diag([one[(np.arange(one.shape[0]) + k - 1) % one.shape[0]] for one in ones]) for k in range(4)]
    return sp.csr_array(sum(sp.kron(turn, weight / 6.0) for turn, weight in zip(turns, weights, strict=True)))
