"""``mobius-flow info``: what kind of knot a curve is, and its measures."""

import argparse
import json
from collections.abc import Iterator, Mapping

from ..core import CurveError
from ..core.curve.io import FORMATS
from ..core.errors import counted
from ..core.info import Info, info
from ..core.knots import KnotType
from . import curves
from .streams import emit

_WIDTH = 24  # columns of names
_EPILOG = """\
examples:
  mobius-flow info knot.txt
  mobius-flow info start.obj relaxed.obj --json
  mobius-flow knot 10_132 - | mobius-flow info -

The type is identified by simplifying a diagram and computing polynomial invariants: 3_1 is the right-handed trefoil,
m3_1 its mirror image, # stands for a sum, and ⊔ separates parts that come apart.  Thickness is the smaller of the least
radius of curvature and half the least distance between strands; ropelength is length over thickness.  A curve is at
rest where the projected gradient is within the default tolerance of relax; pins and obstacles are not known here.  The
index is the number of independent directions downhill, 0 at a minimum.  Knots are numbered as in KnotInfo (see
mobius-flow knot --help).

exit status: 0, or 2 on bad input or bad options
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Describe the subcommand."""
    parser.description, parser.epilog = "Identify the knot type of curves, and measure them.", _EPILOG
    parser.add_argument(
        "inputs", metavar="IN", nargs="+", help=f"curves: {', '.join(FORMATS)}, or - for standard input"
    )
    curves.add_format(parser)
    parser.add_argument("--json", action="store_true", help="print JSON, a list if there are several inputs")


def run(options: argparse.Namespace) -> int:
    """Print what there is to say about each curve."""
    if options.inputs.count(curves.STREAM) > 1:
        raise CurveError("standard input can be read once only; give - once")
    for path in options.inputs:
        curves.format_for(path, options.format)  # before what takes time
    found = [(path, _info(path, options.format)) for path in options.inputs]
    if options.json:
        described = [as_json(path, each) for path, each in found]
        emit(json.dumps(described if len(described) > 1 else described[0]))
    else:
        emit("\n\n".join("\n".join(_lines(path, each)) for path, each in found))
    return 0


def _info(path: str, name: str | None) -> Info:
    file = curves.read(path, name)
    with curves.refusals(file):
        if len(file.curve) > curves.MAX_VERTICES:
            raise CurveError(f"the curve has {len(file.curve)} vertices; at most {curves.MAX_VERTICES} are looked at")
        return info(file.curve)


def as_json(path: str, found: Info) -> Mapping[str, object]:
    """All of it by names that scripts can rely on; null for what is not known."""
    rest = found.rest
    return {
        "input": path,
        "components": len(found.components),
        "vertices": list(found.components),
        "type": _type_as_json(found.type),
        "energies": {**found.energies, "objective": rest and rest.objective},
        "length": found.length,
        "thickness": found.thickness,
        "ropelength": found.ropelength,
        "writhe": found.writhe,
        "average_crossing_number": found.average_crossing_number,
        "edges": {
            "shortest": found.shortest_edge,
            "longest": found.longest_edge,
            "ratio": found.longest_edge / found.shortest_edge,
        },
        "gap": found.gap if found.gap < float("inf") else None,
        "gradient_norm": rest and rest.gradient_norm,
        "at_rest": rest and rest.at_rest,
        "index": rest and rest.index,
    }


def _type_as_json(found: KnotType) -> Mapping[str, object]:
    polynomial, diagram = found.jones, found.diagram
    return {
        "name": str(found),
        "names": list(found.names),
        "proved": found.proved,
        "evidence": list(found.evidence),
        "crossings": None if diagram is None else diagram.crossings,
        "linking_numbers": None if diagram is None else list(diagram.linking_numbers),
        "alexander": None if found.alexander is None else list(found.alexander),
        "determinant": found.determinant,
        "jones": None if polynomial is None else [[power / 2, c] for power, c in polynomial.items()],
    }


def _lines(path: str, found: Info) -> Iterator[str]:
    yield path
    for name, value in _rows(found):
        yield f"  {name:{_WIDTH}}{value}"


def _rows(found: Info) -> Iterator[tuple[str, str]]:
    sizes = f" ({', '.join(map(str, found.components))} vertices)"
    yield "components", f"{counted(len(found.components), 'component')}{sizes}"
    yield "type", found.type.sentence
    if found.type.diagram is not None and len(found.components) > 1:
        yield "linking numbers", ", ".join(map(str, found.type.diagram.linking_numbers))
    for name, value in found.energies.items():
        yield f"{name} energy", _number(value)
    if found.rest is not None:
        yield "objective", _number(found.rest.objective)
        yield "gradient", f"{found.rest.gradient_norm:.3g} ({found.rest.sentence})"
    yield "length", _number(found.length)
    yield "thickness", _number(found.thickness)
    yield "ropelength", _number(found.ropelength)
    yield "writhe", _number(found.writhe)
    yield "average crossing number", _number(found.average_crossing_number)
    longest, shortest = found.longest_edge, found.shortest_edge
    yield "edges", f"{shortest:.6g} to {longest:.6g}, ratio {longest / shortest:.4g}"
    yield "gap between edges", _number(found.gap)


def _number(value: float | None) -> str:
    return "not computed" if value is None else f"{value:.9g}"
