"""Signatures of knots from the Goeritz matrix of a diagram."""

import numpy as np

from ..types import BoolArray
from .diagram import Diagram
from .faces import Faces


def knot_signature(knot: Diagram) -> int:
    """The signature, −2 for the right-handed trefoil (Gordon and Litherland, *Inventiones* 47, 1978).

    It is that of the Goeritz matrix of the white regions of a chessboard colouring, corrected by the crossings at which
    both strands run the same way along the black surface.
    """
    if not knot.crossings:
        return 0
    faces = Faces(knot)
    white = _white(faces)
    goeritz, correction = np.zeros((faces.count, faces.count)), 0
    for (lower, _), sign in zip(knot.strands, knot.signs, strict=True):
        before = knot.previous[lower]
        corners = (faces.right[before], faces.left[lower])  # lower right and upper left, the lower strand going up
        turn = 1 if white[corners[0]] else -1
        a, b = corners if turn > 0 else (faces.left[before], faces.right[lower])
        correction += turn * (turn == sign)
        goeritz[[a, b], [a, b]] += turn
        goeritz[[a, b], [b, a]] -= turn
    kept = np.flatnonzero(white)[1:]
    eigenvalues = np.linalg.eigvalsh(goeritz[np.ix_(kept, kept)])  # none is 0: the determinant of a knot is odd
    return int(np.sign(eigenvalues).sum()) - correction


def _white(faces: Faces) -> BoolArray:
    """Whether each region is white, where regions on both sides of an edge have different colours."""
    colours: dict[int, bool] = {0: True}
    waiting = [0]
    while waiting:
        here = waiting.pop()
        for _, _, there in faces.borders[here]:
            if there not in colours:
                colours[there] = not colours[here]
                waiting.append(there)
    return np.array([colours[k] for k in range(faces.count)])
