"""Trajectories of other programs, a snapshot at a time: LAMMPS dumps and XYZ, and others by the extra "audit"."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import NoReturn, TextIO

import numpy as np

from ..base import BoolArray, CurveFileError, FloatArray, IntArray, reason_of, wrong_suffix


@dataclass(frozen=True, eq=False)
class Snapshot:
    """All beads at one time."""

    points: FloatArray  # (n, 3)
    cell: FloatArray  # edges of the periodic box as rows, zero along axes that are not periodic; (3, 3)
    images: IntArray | None = None  # whole boxes by which each bead is moved, (n, 3); None where that is not known
    step: int | None = None  # the number that the other program gives it
    names: IntArray | None = None  # numbers of the beads, (n,); from 1 on if None
    molecules: IntArray | None = None  # the molecule of each, 0 for none; (n,)
    bonds: IntArray | None = None  # indices of beads, (k, 2)


def snapshots(path: Path | str) -> Iterator[Snapshot]:
    """Read the snapshots of a trajectory one after the other; the suffix tells the format (see :data:`READERS`).

    Raises CurveFileError, also later, when it comes to what is damaged or cut off.
    """
    path = Path(path)
    if path.suffix.lower() not in READERS:
        raise CurveFileError(path, wrong_suffix(path, READERS, "trajectories"))
    try:
        yield from READERS[path.suffix.lower()](path)
    except CurveFileError:
        raise
    except ImportError as error:
        needed = f"{path.suffix} needs the Python module {error.name}: pip install MDAnalysis gsd (the extra audit)"
        raise CurveFileError(path, needed) from error
    except (OSError, ValueError, RuntimeError, LookupError) as error:  # whatever libraries raise for damaged files
        raise CurveFileError(path, f"cannot be read: {reason_of(error)}") from error


class _Lines:
    """The lines of a text file, counted."""

    def __init__(self, path: Path, stream: TextIO) -> None:
        self.path, self.stream, self.number = path, stream, 0

    def fail(self, reason: str) -> NoReturn:
        raise CurveFileError(self.path, reason, self.number)

    def next(self) -> str:
        """The next line, empty at the end."""
        self.number += 1
        return self.stream.readline(1 << 16)

    def count(self, line: str) -> int:
        """The number of atoms that a line, the last one read, gives."""
        if not re.fullmatch(r"\s*[1-9][0-9]{0,8}\s*", line):
            self.fail(f"{line.strip()[:30]!r} is not a number of atoms")
        return int(line)

    def table(self, rows: int, columns: Sequence[int]) -> FloatArray:
        """Some columns of the next lines; shape (rows, columns)."""
        lines = list(islice(self.stream, rows))
        if len(lines) < rows or not lines[-1].endswith("\n"):
            self.number += len(lines)
            self.fail(f"the file is cut off in a table of {rows} lines")
        try:
            table = np.loadtxt(lines, usecols=columns, ndmin=2, comments=None)
        except ValueError as error:
            self.fail(f"the table below this line is damaged: {str(error).splitlines()[0]}")
        if len(table) < rows:
            self.fail("the table below this line has empty lines")
        self.number += rows
        return table


def _read_dump(path: Path) -> Iterator[Snapshot]:
    """A text dump of LAMMPS: ids, coordinates of any kind, and image flags and molecules where they are there."""
    kinds = [[axis + kind for axis in "xyz"] for kind in ("u", "su", "", "s")]
    with path.open(encoding="utf-8") as stream:
        lines, step, count = _Lines(path, stream), None, None
        box: tuple[FloatArray, FloatArray, BoolArray] | None = None  # edges as rows, corner, along which it is periodic
        while line := lines.next():
            item, words = line[:17].rstrip(), line.split()[2:]
            if item == "ITEM: TIMESTEP":
                step, count, box = int(lines.table(1, [0])[0, 0]), None, None
            elif item == "ITEM: NUMBER OF A":
                count = lines.count(lines.next())
            elif item == "ITEM: BOX BOUNDS" and "abc" not in words:
                bounds = lines.table(3, range(3 if "xy" in words else 2))
                xy, xz, yz = bounds[:, 2] if "xy" in words else np.zeros(3)
                # bounds are those of a box with axes of its own around the one that may be tilted
                low = bounds[:, 0] - [min(0.0, xy, xz, xy + xz), min(0.0, yz), 0.0]
                high = bounds[:, 1] - [max(0.0, xy, xz, xy + xz), max(0.0, yz), 0.0]
                sides = np.diag(high - low)
                sides[1, 0], sides[2, 0], sides[2, 1] = xy, xz, yz
                marks = [word for word in words[1:] if word not in ("xy", "xz", "yz")]
                periodic = np.array(["p" in mark for mark in marks] if len(marks) == 3 else [True] * 3)
                if (flat := np.flatnonzero(periodic & (sides.diagonal() <= 0.0))).size:
                    lines.fail(f"the box has no extent along {'xyz'[flat[0]]}")
                box = sides, low, periodic
            elif item.startswith("ITEM: ATOMS") and count is not None and box is not None:
                axes = next((names for names in kinds if set(names) <= set(words)), None)
                if axes is None or "id" not in words:
                    lines.fail("atoms need the columns id, x, y and z (or xu, xs, xsu, …)")
                flags = [name for name in ("ix", "iy", "iz") if name in words]
                others = ["id", *(["mol"] if "mol" in words else []), *(flags if len(flags) == 3 else [])]
                table = lines.table(count, [words.index(name) for name in (*axes, *others)])
                table = table[np.argsort(table[:, 3], kind="stable")]
                (sides, low, periodic), points = box, table[:, :3]
                images = np.zeros((count, 3), dtype=np.intp) if "u" in axes[0] else None
                if images is None and len(flags) == 3:
                    images = table[:, -3:].astype(np.intp)
                if "s" in axes[0]:
                    points = points @ sides + low
                molecules = table[:, 4].astype(np.intp) if "mol" in words else None
                names = table[:, 3].astype(np.intp)
                if (twice := names[1:][np.diff(names) == 0]).size:
                    lines.fail(f"the id {twice[0]} is there twice in the table that ends here")
                yield Snapshot(points, sides * periodic[:, None], images, step, names, molecules)
                step = None
            elif item in ("ITEM: UNITS", "ITEM: TIME"):
                lines.next()
            else:
                lines.fail(f"{line.strip()[:40]!r} is not expected here in a LAMMPS dump")
        if step is not None:
            lines.fail("the file is cut off within a snapshot")


def _read_xyz(path: Path) -> Iterator[Snapshot]:
    """XYZ: a number of atoms, a comment, in extended XYZ with lattice and columns, and a line for each atom."""
    with path.open(encoding="utf-8") as stream:
        lines = _Lines(path, stream)
        while (line := lines.next()).strip():
            count, comment = lines.count(line), lines.next()
            said = dict(re.findall(r'(\w+)="?((?<=")[^"]*|[^\s"]+)', comment))
            first, columns = 1, said.get("Properties", "").split(":")
            cell, periodic = np.zeros((3, 3)), np.zeros(3, dtype=bool)
            try:
                if "pos" in columns:
                    first = sum(map(int, columns[2 : columns.index("pos") : 3]))
                if "Lattice" in said:
                    cell = np.array(said["Lattice"].split(), dtype=np.float64).reshape(3, 3)
                    periodic = np.reshape([mark[0] in "Tt1" for mark in said.get("pbc", "T T T").split()], 3)
            except ValueError:
                lines.fail("the lattice is not nine numbers, pbc are not three letters, or properties not in threes")
            if (periodic > cell.any(axis=1)).any():
                lines.fail("the lattice has no extent along an axis that is periodic")
            yield Snapshot(lines.table(count, range(first, first + 3)), cell * periodic[:, None])
        if stream.read(1 << 16).strip():
            lines.fail("a number of atoms is expected here")


def _read_gsd(path: Path) -> Iterator[Snapshot]:
    """GSD, as HOOMD-blue writes it, with its bonds."""
    import gsd.hoomd

    with gsd.hoomd.open(str(path), "r") as frames:
        for frame in frames:
            x, y, z, xy, xz, yz = map(float, frame.configuration.box)
            cell = np.array([[x, 0.0, 0.0], [xy * y, y, 0.0], [xz * z, yz * z, z]])
            images = np.array(frame.particles.image, dtype=np.intp)
            yield Snapshot(
                np.array(frame.particles.position, dtype=np.float64),
                cell,
                images if images.any() else None,  # which is what a file without them gives
                int(frame.configuration.step),
                bonds=np.array(frame.bonds.group, dtype=np.intp).reshape(-1, 2) if frame.bonds.N else None,
            )


def _read_xtc(path: Path) -> Iterator[Snapshot]:
    """XTC of Gromacs, in nanometres; it leaves no file of offsets behind, as MDAnalysis' own reader does."""
    from MDAnalysis.lib.formats.libmdaxdr import XTCFile

    with XTCFile(str(path)) as frames:
        for frame in frames:
            yield Snapshot(frame.x.astype(np.float64), frame.box.astype(np.float64), step=int(frame.step))


def _read_dcd(path: Path) -> Iterator[Snapshot]:
    """DCD of CHARMM, NAMD and LAMMPS, in the units that it has."""
    from MDAnalysis.coordinates.DCD import DCDReader
    from MDAnalysis.lib.formats.libdcd import DCDFile

    DCDFile(str(path)).close()  # refuses what is no such file, on which the reader would print a traceback
    with DCDReader(str(path), convert_units=False) as frames:
        for frame in frames:
            sides = frame.triclinic_dimensions
            cell = np.zeros((3, 3)) if sides is None else np.array(sides, dtype=np.float64)
            yield Snapshot(frame.positions.astype(np.float64), cell)
    with path.open("rb") as stream:  # the reader leaves out a frame that is cut off
        begin, size, at, records = stream.read(8), path.stat().st_size, 0, -3  # but for those of the header
        while begin[4:] == b"CORD" and at < size:  # else its marks of records' sizes have more than four bytes
            stream.seek(at)
            at += 8 + int.from_bytes(stream.read(4), "little" if begin[0] else "big")
            records += 1
        if at > size or records % (3 if sides is None else 4):
            raise CurveFileError(path, "the file is cut off within its last frame")


READERS: Mapping[str, Callable[[Path], Iterator[Snapshot]]] = {
    **dict.fromkeys((".lammpstrj", ".lammpsdump", ".dump"), _read_dump),
    **dict.fromkeys((".xyz", ".extxyz"), _read_xyz),
    ".gsd": _read_gsd,
    ".xtc": _read_xtc,
    ".dcd": _read_dcd,
}
"""What reads the snapshots of a trajectory, by suffix."""
