"""Sparse symmetric matrices in factors."""

import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu


def factorised(matrix: sp.csc_array) -> SuperLU:
    """The factors of a sparse symmetric matrix; its pivots are those on the diagonal wherever these are not 0.

    Then they have the signs of its eigenvalues.  Raises RuntimeError if it is singular.
    """
    return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
