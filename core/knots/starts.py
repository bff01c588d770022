"""Different curves of one knot type, to look for its minima from."""

from ..curve import Curve
from ..diagrams.projection import views
from ..errors import MobiusFlowError
from .lattice import lattice_closure
from .names import braid_word, knot, table_name
from .planar import drawn
from .scrambles import scramble
from .shapes import smooth_knot

GAP = 0.5  # of the mean edge length that scrambled strands keep: nearer ones would need thousands of vertices


def start(name: str, number: int, seed: int) -> tuple[str, Curve]:
    """The start of a number, from 1, for a knot's name, and of which kind it is.

    Knots and links of the table begin as what :func:`knot` makes ("named"), "smooth", and on the cubic "lattice"; from
    then on, and all others from the second one on, they are "drawn" anew from a random projection or "scrambled" in
    turn.  The same ``seed`` gives the same curve.  Raises UnknownKnotError, and CurveError for arcs that are to be
    scrambled.
    """
    given = knot(name)
    if number == 1:
        return "named", given
    try:
        table_name(name)
    except MobiusFlowError:
        return scrambled(given, seed)
    if number == 2:
        return "smooth", smooth_knot(name)
    if number == 3:
        return "lattice", lattice_closure(braid_word(name))
    return scrambled(given, seed) if number % 2 else ("drawn", drawn([*views(smooth_knot(name), 2, seed)][-1]))


def scrambled(curve: Curve, seed: int) -> tuple[str, Curve]:
    """A curve after random moves."""
    return "scrambled", scramble(curve, seed, gap=GAP * float(curve.edge_lengths.mean()))
