"""The names that Schoenflies gave to finite groups of isometries: C3, D2, S4, Td, …"""

import re

import numpy as np

from ..types import FloatArray, IntArray

IS_NAME = re.compile(r"C[1-9]\d*[vh]?|S[1-9]\d*|D[2-9][dh]?|D[1-9]\d+[dh]?|C[si]|T[dh]?|Oh?|Ih?")
_POLYHEDRAL = {(12, 3): "T", (24, 4): "O", (60, 5): "I"}  # by the number of rotations and their largest order


def multiplication(matrices: FloatArray) -> IntArray:
    """The elements g·h of a group by the numbers of g and h, of approximate matrices, shape (k, 3, 3); shape (k, k)."""
    products = np.einsum("gij,hjk->ghik", matrices, matrices)
    return np.asarray(np.einsum("ghij,kij->ghk", products, matrices).argmax(axis=2))  # ⟨A, B⟩ is 3 where they agree


def schoenflies(matrices: FloatArray) -> str:
    """The name of a group of orthogonal matrices, approximate ones, the identity first; shape (k, 3, 3).

    Its rotations are one of C_n, D_n, T, O and I, and how many mirror planes there are tells the rest.
    """
    table = multiplication(matrices)
    proper = np.linalg.det(matrices) > 0.0
    count, n = int(np.count_nonzero(proper)), max(order_of(table, g) for g in np.flatnonzero(proper).tolist())
    improper = zip(np.flatnonzero(~proper).tolist(), np.trace(matrices[~proper], axis1=1, axis2=2), strict=True)
    mirrors = sum(trace > 0.0 and order_of(table, g) == 2 for g, trace in improper)  # an inversion has -3
    if (count, n) in _POLYHEDRAL:
        more = "" if proper.all() else "h" if (count, mirrors) != (12, 6) else "d"
        return _POLYHEDRAL[count, n] + more
    if count == 2 * n:
        return f"D{n}" + ("" if proper.all() else "h" if mirrors > n else "d")
    if proper.all():
        return f"C{n}"
    if n == 1:
        return "Cs" if mirrors else "Ci"
    return f"C{n}v" if mirrors == n else f"C{n}h" if mirrors else f"S{2 * n}"


def order_of(table: IntArray, element: int) -> int:
    power, order = element, 1
    while power:
        power, order = int(table[power, element]), order + 1
    return order
