"""``mobius-flow audit``: which chains of a trajectory passed through each other."""

import argparse
import json
import os
import sys
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..core import Audit, audit
from ..core.base import OptionError, counted
from ..core.io.snapshots import READERS
from ..core.knots import KnotType
from .progress import live
from .terminal import GREEN, YELLOW, Item, emit, report, table

Rows = Sequence[dict[str, Any]]
_EPILOG = """\
examples:
  mobius-flow audit melt.lammpstrj
  mobius-flow audit melt.xtc --chains 50x200 --json > passings.json
  mobius-flow audit brush.xyz --chains 100 --open --box 20,20,35

Between frames all beads are taken to go straight at constant speed, in a time from 0 to 1.  What happens on that way is
decided exactly; what happened in the simulation may be something else if frames are far apart.  Frames are counted from
0, chains from 1, and beads as in the file.

exit status:
  0    the trajectory was audited to its end, whatever was found
  1    it broke off, or beads came or went: the report is about what came before, and says why it ends
  2    bad input or bad options, so that there is nothing to report; one line says what and where
  130  interrupted by Ctrl-C, SIGTERM or SIGHUP; what was found is printed
"""


def add_audit(parser: argparse.ArgumentParser) -> None:
    parser.description, parser.epilog = "Tell which chains of a trajectory passed through each other.", _EPILOG
    parser.add_argument("trajectory", metavar="FOREIGN", help=f"of another program: {', '.join(READERS)}")
    text = "beads of chains, such as 50x200 or 20x100,5x400, or 200 if all have as many (default: bonds or molecules)"
    parser.add_argument("--chains", metavar="KxN,…", help=text)
    text = "chains are open (default: rings, unless the file has bonds)"
    parser.add_argument("--open", action="store_true", help=text)
    text = "the periodic box, if not as in the file: LX,LY,LZ, with XY,XZ,YZ behind if it is tilted; 0 where it is open"
    parser.add_argument("--box", metavar="L,L,L", help=text)
    text = "rings, and pairs of rings, that passed through each other whose types are identified at most (default: 100)"
    parser.add_argument("--types", metavar="K", type=int, default=100, help=text)
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    """Audit, and print what is known, also of a part."""
    chains: int | list[int] | None = None
    try:
        if options.chains is not None:
            pairs = [part.rpartition("x") for part in options.chains.split(",")]
            if sum(int(number or 1) for number, _, _ in pairs) > 1e7:
                raise ValueError
            sizes = [int(size) for number, _, size in pairs for _ in range(int(number or 1))]
            chains = sizes[0] if pairs[0][:2] == ("", "") and len(pairs) == 1 else sizes
    except ValueError:
        raise OptionError(f"chains are {options.chains!r:.40}; give numbers and sizes, such as 50x200") from None
    try:
        box = None if options.box is None else [float(word) for word in options.box.split(",")]
    except ValueError:
        raise OptionError(f"box is {options.box!r:.40}; give three lengths, such as 20,20,35") from None
    reports: list[Audit] = []
    interrupted: KeyboardInterrupt | None = None
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    try:
        with live() as show:

            def note(report: Audit) -> None:
                reports[:] = [report]
                show(f"{counted(len(report.found), 'leg')} audited")

            audit(options.trajectory, chains, closed=not options.open, box=box, processes=cores, callback=note)
    except KeyboardInterrupt as error:
        if not reports:
            raise
        reports[0].problem, interrupted = "interrupted", error
    (found,) = reports
    contacts = _contacts(found)
    meetings = [vars(each) | {"chains": [k + 1 for k in each.chains]} for each in found.meetings(options.types)]
    emit(_as_json(found, meetings, contacts) if options.json else _as_text(found, meetings, contacts))
    if interrupted is not None:
        raise interrupted
    return 1 if found.problem else 0


def _contacts(found: Audit) -> list[dict[str, Any]]:
    """All contacts as users count: frames from 0, chains from 1, beads as in the file."""
    shape, each = found.topology, found.passings
    tails = shape.tails[each["edges"]]
    columns = {
        "frames": np.stack([each["leg"], each["leg"] + 1], axis=1),
        "time": each["time"],
        "chains": shape.chain[tails] + 1,
        "beads": found.names[shape.beads[np.stack([tails, tails + 1], axis=2)]],
        "image": each["image"],
        "place": each["place"],
        "sign": each["sign"],
        "kind": np.where(each["sign"] == 0, "touch", "passing"),
    }
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return [dict(zip(columns, row, strict=True)) for row in rows]


def _as_json(found: Audit, meetings: Rows, contacts: Rows) -> str:
    """All that is known, under names that scripts can rely on."""

    def plain(kind: KnotType) -> object:
        return {"name": str(kind), "names": kind.names, "proved": kind.proved}

    described = {
        "legs": len(found.found),
        "problem": found.problem or None,
        "chains": [len(beads) for beads in found.topology.chains],
        "closed": found.topology.closed,
        "steps": found.steps,
        "meetings": meetings,
        "contacts": contacts,
    }
    return json.dumps(described, default=plain)


def _as_text(found: Audit, meetings: Rows, contacts: Rows) -> str:
    """A headline, what happened between which chains, and every contact."""
    rings, total = sum(found.topology.closed), len(found.topology.closed)
    parts = [(len(found.found), "leg"), (rings, "ring"), (total - rings, "open chain")]
    parts.append((len(found.names) - sum(map(len, found.topology.chains)), "other bead"))
    head = "✗ broken off" if found.problem else "✓ audited", " · ".join(counted(n, noun) for n, noun in parts if n)
    passed = [each for each in contacts if each["sign"]]
    own = sum(first == second for first, second in (each["chains"] for each in passed))
    rows: list[tuple[str, Item]] = [
        ("reason", found.problem),
        ("passings", f"{len(passed):,}" + (f", {own:,} of them of chains through themselves" if own else "")),
        ("touches", f"{len(contacts) - len(passed):,}" if len(contacts) > len(passed) else ""),
    ]
    rows += [
        ("changed", f"{_label(each)}: {each['before']} → {each['after']}")
        for each in meetings
        if str(each["before"]) != str(each["after"])
    ]
    blocks = [report(head, rows, sys.stdout, YELLOW if found.problem else GREEN)]
    columns = "passings", "touches", "linking", "before", "after"
    between = [[_label(each), *(str(each[name] or "") for name in columns)] for each in meetings]
    single = [
        [
            "–".join(map(str, each["frames"])),
            f"{each['time']:.6f}",
            _label(each),
            ", ".join("–".join(map(str, ends)) for ends in each["beads"]),
            " ".join(f"{x:.4g}" for x in each["place"]),
            each["kind"],
        ]
        for each in contacts
    ]
    if contacts:
        blocks.append(table(("chains", *columns), between, sys.stdout))
        blocks.append(table(("frames", "time", "chains", "beads", "place", "kind"), single, sys.stdout))
    return "\n\n".join(blocks)


def _label(each: Mapping[str, Any]) -> str:
    """Two chains, or one that met itself, and whole boxes by which the second is moved."""
    numbers = [str(k) for k in each["chains"]]
    if any(each["image"]):
        return f"{', '.join(numbers)} ({' '.join(map(str, each['image']))})"
    return ", ".join(dict.fromkeys(numbers))
