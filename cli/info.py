"""``mobius-flow info`` and ``mobius-flow energy``: what kind of knot a curve is, its measures, and its energies."""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping
from importlib.util import find_spec

from ..core.base import CurveError, check_known, counted
from ..core.driver.info import Info, info, measure
from ..core.energies import ENERGIES
from ..core.knots.closures import closed_far_away, closures
from ..core.knots.diagrams.homfly import homfly_text
from ..core.knots.exterior import FLOER
from . import curves
from .terminal import Item, command, emit, report

_MEASURES = ("length", "thickness", "ropelength", "writhe", "average_crossing_number")
_ENERGY_EPILOG = """\
examples:
  mobius-flow energy knot.txt
  mobius-flow knot figure-eight - | mobius-flow energy - --json

exit status: 0, or 2 on bad input or bad options
"""
_INFO_EPILOG = """\
examples:
  mobius-flow info knot.txt
  mobius-flow info start.obj relaxed.obj --json
  mobius-flow knot 10_132 - | mobius-flow info -
  mobius-flow info protein.pdb --closures 100

The type is identified by simplifying a diagram and computing polynomial invariants: 3_1 is the right-handed trefoil,
m3_1 its mirror image, # stands for a sum, and ⊔ separates parts that come apart.  Thickness is the smaller of the least
radius of curvature and half the least distance between strands; ropelength is length over thickness.  A curve is at
rest where the projected gradient is within the default tolerance of relax; pins and obstacles are not known here.  The
index is the number of independent directions downhill, 0 at a minimum.  Of curves at rest the energy of the smooth
curve is told that finer meshes lead to, beside the least known one of its type.  Symmetry, after Schoenflies, is that
of the curve as it lies, if it misses by at most 2 % of the curve's size, the root mean square distance of its points
from their centre; Möbius images of symmetric curves have it when they are balanced (see relax --balance).  Knots are
numbered as in KnotInfo (see mobius-flow knot --help).

exit status: 0, or 2 on bad input or bad options
"""


def add_energy(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Print the energy of a curve.", _ENERGY_EPILOG
    curves.add_input(parser, "curve")
    parser.add_argument("--energy", default="moebius", metavar="NAME", help=f"one of {', '.join(ENERGIES)}")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.set_defaults(run=_energy)


def _energy(options: argparse.Namespace) -> int:
    check_known("energy", options.energy, ENERGIES)  # before a large file is read
    with curves.measured(options.input, options.format) as curve:
        value = measure(curve, options.energy)
    emit(json.dumps({"name": options.energy, "energy": value}) if options.json else repr(value))
    return 0


def add_info(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Identify the knot type of curves, and measure them.", _INFO_EPILOG
    curves.add_input(parser, "curves", "inputs", "+")
    text = "close open components: their ends go straight away from the centre and are joined far out"
    parser.add_argument("--close", action="store_true", help=text)
    text = "also close open components in N random directions, and tell how often each type comes out"
    parser.add_argument("--closures", type=int, metavar="N", help=text)
    parser.add_argument(
        "--seed", type=int, default=0, metavar="S", help="seed of the directions of --closures (default: 0)"
    )
    parser.add_argument("--json", action="store_true", help="print JSON, a list if there are several inputs")
    parser.set_defaults(run=_info)


def _info(options: argparse.Namespace) -> int:
    if options.inputs.count(curves.STREAM) > 1:
        raise CurveError("standard input can be read once only; give - once")
    for path in options.inputs:
        curves.format_for(path, options.format)  # before anything that takes time
    found = []
    for path in options.inputs:
        with curves.measured(path, options.format) as curve:
            types = (
                {} if options.closures is None else dict(closures(curve, options.closures, options.seed).most_common())
            )
            found.append((path, info(closed_far_away(curve) if options.close else curve), types))
    if options.json:
        described = [{**_as_json(path, each), "closures": types or None} for path, each, types in found]
        emit(json.dumps(described if len(described) > 1 else described[0]))
    else:
        rows = ((path, _rows(path, each, options.close, types)) for path, each, types in found)
        emit("\n\n".join(report((path, ""), each, sys.stdout, 1) for path, each in rows))
    return 0


def _as_json(path: str, found: Info) -> Mapping[str, object]:
    """All results under names that scripts can rely on; null for unknown values."""
    rest, kind = found.rest, found.type
    return {
        "input": path,
        "components": len(found.components),
        "vertices": list(found.components),
        "type": {
            "name": str(kind),
            "names": list(kind.names),
            "proved": kind.proved,
            "evidence": list(kind.evidence),
            "crossings": kind.diagram and kind.diagram.crossings,
            "linking_numbers": kind.diagram and list(kind.diagram.linking_numbers),
            "alexander": None if kind.alexander is None else list(kind.alexander),
            "determinant": kind.determinant,
            "genus": kind.floer and kind.floer.genus,
            "fibered": kind.floer and kind.floer.fibered,
            "group": kind.group and kind.group._asdict(),
            "homfly": None if kind.homfly is None else [[*powers, c] for powers, c in sorted(kind.homfly.items())],
            "jones": None if kind.jones is None else [[power / 2, c] for power, c in kind.jones.items()],
        },
        "energies": {**found.energies, "objective": rest and rest.objective},
        **{name: getattr(found, name) for name in _MEASURES},
        "edges": {
            "shortest": found.shortest_edge,
            "longest": found.longest_edge,
            "ratio": found.longest_edge / found.shortest_edge,
        },
        "symmetry": found.symmetry and {"group": found.symmetry.name, "distance": found.symmetry.distance},
        "gap": found.gap if found.gap < float("inf") else None,
        "gradient_norm": rest and rest.gradient_norm,
        "at_rest": rest and rest.at_rest,
        "index": rest and rest.index,
        "smooth": found.smooth
        and {
            "energy": found.smooth.energy,
            "error": found.smooth.error,
            "least_known": found.smooth.least and found.smooth.least[0],
        },
    }


def _rows(path: str, found: Info, closed: bool, types: Mapping[str, int]) -> Iterator[tuple[str, Item]]:
    """What is known of a curve, and in the end what tells more about it."""
    sizes = f" ({', '.join(map(str, found.components))} vertices)"
    yield "components", f"{counted(len(found.components), 'component')}{sizes}"
    yield "type", found.type.sentence
    if types:
        count = sum(types.values())
        shares = ", ".join(f"{name} {100 * number / count:.3g} %" for name, number in types.items())
        yield "closures", f"{shares} of {count}"
    if found.type.homfly:
        text = homfly_text(found.type.homfly)
        yield "HOMFLY polynomial", text if len(text) < 100 else "long; see --json"
    if found.type.floer is not None:
        yield "genus", f"{found.type.floer.genus}{', fibered' * found.type.floer.fibered} (by {FLOER})"
    if found.type.group is not None:
        yield "group", f"{found.type.group if len(str(found.type.group)) < 100 else 'long; see --json'} (by SnapPy)"
    if found.type.diagram is not None and len(found.components) > 1:
        yield "linking numbers", ", ".join(map(str, found.type.diagram.linking_numbers))
    for name, value in found.energies.items():
        yield f"{name} energy", _number(value)
    if found.rest is not None:
        yield "objective", _number(found.rest.objective)
        yield "gradient", f"{found.rest.gradient_norm:.3g} ({found.rest.sentence})"
    if found.smooth is not None:
        yield "smooth curve's energy", found.smooth.sentence
    for name in _MEASURES:
        yield name.replace("_", " "), _number(getattr(found, name))
    longest, shortest = found.longest_edge, found.shortest_edge
    yield "edges", f"{shortest:.6g} to {longest:.6g}, ratio {longest / shortest:.4g}"
    # 0.05 of the mean edge: gaps that vertices were not meant to resolve
    near = found.gap < 0.05 * found.length / sum(found.components)
    more = ": far below the edges, so that noise of this size may have changed the type" if near else ""
    yield "gap between edges", _number(found.gap) + more
    if found.symmetry is not None and found.symmetry.name != "C1":
        yield "symmetry", f"{found.symmetry.name} (misses by {100 * found.symmetry.distance:.2g} % of the curve's size)"
    diagram = found.type.diagram
    if found.open and found.dimension == 3 and not closed:
        yield "next", [command("info", path, "--close")]
    elif diagram is not None and not found.type.names and len(diagram.passes) == 1 and find_spec("snappy") is None:
        yield "next", "pip install snappy (the extra knots), which names knots of up to 15 crossings"


def _number(value: float | None) -> str:
    return "not computed" if value is None else f"{value:.9g}"
