"""Different curves of one knot type, from which to look for its minima."""

import numpy as np

from ..core.base.errors import MobiusFlowError
from ..core.curve import Curve
from ..core.driver.moves.hops import MOTIONS
from ..core.driver.options import RelaxOptions
from ..core.driver.prepare import start_problem
from ..core.driver.run import Run
from ..core.knots.braids import braid_diagram
from ..core.knots.diagrams.projection import views
from ..core.knots.names import braid_word, knot, table_name
from ..core.knots.planar import drawn
from ..core.knots.scrambles import scramble
from ..core.knots.shapes import smooth_knot


def start(name: str, number: int, seed: int) -> tuple[str, Curve]:
    """The kind of the start with a number, from 1, for a knot's name, and its curve.

    Knots and links of the table start as the closed braid that :func:`knot` makes ("named"), then "smooth", and on a
    "lattice" again; after that they are by turns "drawn" anew from a random projection and "hopped" out of the smooth
    shape.  All others are "scrambled" from the second start on.  The same ``seed`` gives the same curve.  Raises
    UnknownKnotError, and CurveError for arcs that are to be scrambled.
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
        return "lattice", drawn(braid_diagram(braid_word(name)))
    if number % 2:
        return "hopped", hopped(smooth_knot(name), seed)
    return "drawn", drawn([*views(smooth_knot(name), 2, seed)][-1])


def hopped(curve: Curve, seed: int) -> Curve:
    """A curve after one of the motions that hops begin with."""
    options = RelaxOptions(radius="none")
    point = Run(start_problem(curve, options), curve, options).point
    steps = MOTIONS[seed // 2 % len(MOTIONS)](point, np.random.default_rng(seed))
    path = [leg.end.placed for step in steps for leg in step.legs]
    return curve.with_vertices(path[-1]) if path else curve


def scrambled(curve: Curve, seed: int) -> tuple[str, Curve]:
    """A curve after random moves."""
    # 0.5: between scrambled strands, in mean edge lengths: nearer ones would need thousands of vertices
    return "scrambled", scramble(curve, seed, gap=0.5 * float(curve.edge_lengths.mean()))
