"""Chains of proteins (.pdb, .cif): the alpha carbons of each, one after the other, as an open arc.

Of several models the first is read, of several atoms at one place in the chain the first, and chains are the
authors' own.  Columns of .pdb files are those of the format's version 3.3, sections "ATOM" and "TER"; modified residues
(HETATM) have alpha carbons too, and anything after the end of a chain is not part of it.  Of .cif files (PDBx/mmCIF)
the loop of ``_atom_site`` is read, one atom per line.
"""

import logging
import re
from collections.abc import Iterable
from itertools import pairwise
from math import dist
from typing import NamedTuple

from .source import Polygon, Source

_WORD = re.compile(r"""'(?:[^']|'(?=\S))*'|"(?:[^"]|"(?=\S))*"|\S+""")
_log = logging.getLogger(__name__)


class _Atom(NamedTuple):
    """An alpha carbon: its chain, the residue's name and number, and where it was read."""

    chain: str
    residue: str
    line: int
    point: tuple[float, ...]


def read(source: Source) -> list[Polygon]:
    """Read the chains of a .pdb file; raises CurveFileError naming the line."""
    chain, ended, atoms = "", set[str](), list[_Atom]()
    for number, line in enumerate(source.lines, start=1):
        record = line[:6].rstrip()
        if record == "ENDMDL":
            break
        if record == "TER":
            ended.add(chain)
        is_part = record == "ATOM" or (record == "HETATM" and line[21:22] not in ended)
        if is_part and line[12:16] == " CA ":  # an alpha carbon; calcium begins one column before
            chain = line[21]
            point = tuple(source.number(line[k : k + 8].strip(), number) for k in (30, 38, 46))
            atoms.append(_Atom(chain, line[17:27], number, point))
    return _arcs(source, atoms, len({line for line in source.lines if line.startswith("MODEL ")}))


def read_cif(source: Source) -> list[Polygon]:
    """Read the chains of an mmCIF file; raises CurveFileError naming the line."""
    names, rows = list[str](), list[tuple[int, dict[str, str]]]()  # of the loop of atoms; rows with their lines
    for number, line in enumerate(source.lines, start=1):
        if line.startswith("_atom_site."):
            names.append(line.split()[0].partition(".")[2])
        elif names and line.strip():
            if line.startswith(("#", "_", "loop_", "data_")):
                break
            words = [word[1:-1] if word[0] in "'\"" else word for word in _WORD.findall(line)]
            if len(words) != len(names):
                raise source.error(f"{len(words)} values where the loop of atoms has {len(names)} columns", number)
            rows.append((number, dict(zip(names, words, strict=True))))
    if rows and (missing := {f"Cartn_{axis}" for axis in "xyz"}.difference(names)):
        raise source.error(f"the loop of atoms, _atom_site, has no {', '.join(sorted(missing))}")
    models = list(dict.fromkeys(row.get("pdbx_PDB_model_num", "1") for _, row in rows))
    atoms = []
    for number, row in rows:
        is_carbon = row.get("label_atom_id") == "CA" and row.get("type_symbol", "C") == "C"
        if not is_carbon or row.get("label_seq_id") == "." or row.get("pdbx_PDB_model_num", "1") != models[0]:
            continue  # residues of a chain have a sequence number, and other molecules have none
        chain, place = (row.get(f"auth_{key}", row.get(f"label_{key}", "")) for key in ("asym_id", "seq_id"))
        residue = f"{row.get('label_comp_id', '')} {chain}{place}{row.get('pdbx_PDB_ins_code', '').strip('?.')}"
        point = tuple(source.number(row[f"Cartn_{axis}"], number) for axis in "xyz")
        atoms.append(_Atom(chain, residue, number, point))
    return _arcs(source, atoms, len(models))


def _arcs(source: Source, atoms: Iterable[_Atom], models: int) -> list[Polygon]:
    """One polygon for each chain."""
    chains: dict[str, dict[str, _Atom]] = {}
    for atom in atoms:
        chains.setdefault(atom.chain, {}).setdefault(atom.residue.partition(" ")[2], atom)
    if not chains:
        raise source.error("no alpha carbon found: there must be ATOM records of atoms named CA")
    if models > 1:
        _log.warning("%s: of %d models the first is read", source.path, models)
    every = [list(each.values()) for each in chains.values()]
    for a, b in (pair for each in every for pair in pairwise(each)):
        if dist(a.point, b.point) > 4.5:  # Å; neighbours are 3.8 apart, so residues are missing in between
            what = "residues may be missing from %s to %s; joined straight"
            _log.warning(f"%s: {what}", source.path, *(" ".join(each.residue.split()) for each in (a, b)))
    return [
        Polygon([atom.point for atom in each], [atom.line for atom in each].__getitem__, closed=False) for each in every
    ]
