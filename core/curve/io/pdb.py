"""Protein Data Bank files (.pdb): the alpha carbons of each chain, one after the other, as an open arc.

Of several models the first is read, of several atoms at one place in the chain the first one.  Columns are those of the
format's version 3.3, sections "ATOM" and "TER"; modified residues (HETATM) have alpha carbons too, and what comes after
the end of a chain is no part of it.
"""

import logging
from itertools import pairwise
from math import dist

from .source import Polygon, Source

_ALPHA_CARBON = " CA "  # in columns 13 to 16; calcium begins one column before
_APART = 4.5  # Å; neighbours are 3.8 apart, so that residues are missing in between
_log = logging.getLogger(__name__)


def read(source: Source) -> list[Polygon]:
    """Read the chains; raises CurveFileError naming the line."""
    chains: list[list[tuple[str, int, tuple[float, ...]]]] = []
    chain, seen, ended = "", set[str](), set[str]()
    for number, line in enumerate(source.lines, start=1):
        record = line[:6].rstrip()
        if record == "ENDMDL":
            break
        if record == "TER":
            ended.add(chain)
            chain = ""
        is_part = record == "ATOM" or (record == "HETATM" and line[21:22] not in ended)
        if not is_part or line[12:16] != _ALPHA_CARBON or line[21:27] in seen:
            continue
        point = tuple(source.number(line[k : k + 8].strip(), number) for k in (30, 38, 46))
        if line[21] != chain:
            chain = line[21]
            chains.append([])
        chains[-1].append((line[17:27], number, point))
        seen.add(line[21:27])
    if not chains:
        raise source.error("no alpha carbon found: there must be ATOM records of atoms named CA")
    for (one, _, a), (other, _, b) in (pair for each in chains for pair in pairwise(each)):
        if dist(a, b) > _APART:
            _log.warning("%s: residues may be missing from %s to %s; joined straight", source.path, one, other)
    return [
        Polygon([point for _, _, point in each], [number for _, number, _ in each].__getitem__, closed=False)
        for each in chains
    ]
