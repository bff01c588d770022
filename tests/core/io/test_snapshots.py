"""Trajectories of other programs: what they hold is read, and what is damaged is refused with file, line and reason."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core import CurveFileError, MobiusFlowError, audit
from mobius_flow.core.io.snapshots import Snapshot, snapshots
from motions import Array

Writer = Callable[[Path, list[Array], float], None]
POINTS = np.array([[0.25, 1.0, 3.5], [1.25, 1.5, 0.5], [0.5, 2.0, 1.0]])


def dump(*frames, box="BOX BOUNDS pp pp ff\n0 2\n0 4\n1 9", atoms="id mol x y z"):
    text = ""
    for k, points in enumerate(frames):
        text += f"ITEM: TIMESTEP\n{100 * k}\nITEM: NUMBER OF ATOMS\n{len(points)}\nITEM: {box}\nITEM: ATOMS {atoms}\n"
        rows = [f"{i + 1} 7 {' '.join(map(str, point))}\n" for i, point in enumerate(points.tolist())]
        text += "".join(reversed(rows))
    return text


def read(path, text):
    path.write_text(text, encoding="utf-8")
    return list(snapshots(path))


def test_lammps_dumps(tmp_path):
    path = tmp_path / "a.lammpstrj"
    first, second = read(path, dump(POINTS, POINTS + 1.0))
    assert np.array_equal(second.points, POINTS + 1.0)
    assert first.cell.tolist() == [[2, 0, 0], [0, 4, 0], [0, 0, 0]]
    assert (first.step, second.step, first.images) == (0, 100, None)
    assert (first.names.tolist(), first.molecules.tolist()) == ([1, 2, 3], [7, 7, 7])
    (scaled,) = read(path, "ITEM: UNITS\nlj\n" + dump(POINTS, atoms="id mol xs ys zs"))
    assert np.array_equal(scaled.points, POINTS * [2, 4, 8] + [0, 0, 1])
    (unwrapped,) = read(path, dump(POINTS, atoms="id mol xu yu zu"))
    assert not unwrapped.images.any()
    (flagged,) = read(path, dump(np.hstack([POINTS, [[1, 0, -2]] * 3]), atoms="id mol x y z ix iy iz"))
    assert flagged.images.tolist() == [[1, 0, -2]] * 3
    (tilted,) = read(path, dump(POINTS, box="BOX BOUNDS xy xz yz pp pp pp\n-1 5 1\n0 6 -2\n0 5 0.5"))
    assert tilted.cell.tolist() == [[3, 0, 0], [1, 5.5, 0], [-2, 0.5, 5]]


def test_xyz_plain_and_extended(tmp_path):
    rows = "".join(f"C {' '.join(map(str, point))}\n" for point in POINTS.tolist())
    plain, other = read(tmp_path / "a.xyz", f"3\n\n{rows}3\nanother\n{rows}\n")
    assert np.array_equal(plain.points, POINTS)
    assert not other.cell.any()
    more = "".join(f"{k} C {' '.join(map(str, point))}\n" for k, point in enumerate(POINTS.tolist()))
    comment = 'Lattice="2 0 0 0.5 4 0 0 0 8" Properties=id:I:1:species:S:1:pos:R:3 pbc="T T F"'
    (extended,) = read(tmp_path / "a.extxyz", f"3\n{comment}\n{more}")
    assert np.array_equal(extended.points, POINTS)
    assert extended.cell.tolist() == [[2, 0, 0], [0.5, 4, 0], [0, 0, 0]]


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.lammpstrj", dump(POINTS)[:-4], "line 12: the file is cut off in a table of 3 lines"),
        ("a.lammpstrj", dump(POINTS, POINTS)[:150], "cut off"),
        (
            "a.lammpstrj",
            dump(POINTS, box="BOX BOUNDS\n0 99\n0 99\n0 99") + "ITEM: TIMESTEP\n100\n",
            "the file is cut off within a snapshot",
        ),
        ("a.lammpstrj", dump(POINTS).replace("3.5", "x"), "line 9: the table below this line is damaged: could not"),
        ("a.lammpstrj", dump(POINTS, atoms="id mol a b c"), "line 9: atoms need the columns id, x, y and z"),
        ("a.lammpstrj", dump(POINTS).replace("0 4", "4 4"), "line 8: the box has no extent along y"),
        ("a.lammpstrj", dump(POINTS).replace("2 7", "3 7"), "line 12: the id 3 is there twice"),
        ("a.xyz", '1\nLattice="1 0 0 0 0 0 0 0 1"\nC 1 2 3\n', "line 2: the lattice has no extent along an axis"),
        ("a.lammpstrj", dump(POINTS, box="BOX BOUNDS abc origin\n1\n2\n3"), "line 5: 'ITEM: BOX BOUNDS abc origin'"),
        ("a.lammpstrj", "1 2 3\n", "line 1: '1 2 3' is not expected here in a LAMMPS dump"),
        ("a.xyz", "three\n", "line 1: 'three' is not a number of atoms"),
        ("a.xyz", "2\n\nC 0 0 0\nC 1 1\n", "line 2: the table below this line is damaged"),
        ("a.xyz", '1\nLattice="1 0 0"\nC 0 0 0\n', "line 2: the lattice"),
        ("a.xyz", '1\nLattice="1 0 0 0 1 0 0 0 1" pbc="T T"\nC 0 0 0\n', "line 2: the lattice"),
        ("a.xyz", "1\nProperties=species:S:x:pos:R:3\nC 0 0 0\n", "line 2: the lattice"),
        ("a.xyz", "\x00\xff", "cannot be read: 'utf-8' codec"),
        ("a.pdf", "", "unknown suffix '.pdf'"),
        ("a.xyz", "", "there are no frames"),
    ],
)
def test_damage_is_told(name, text, said, tmp_path):
    (tmp_path / name).write_bytes(text.encode("latin1"))
    with pytest.raises(MobiusFlowError, match=f"^{re.escape(str(tmp_path / name))}.*{re.escape(said)}"):
        audit(tmp_path / name, 3)


def test_a_missing_file_is_told(tmp_path):
    for name in ("a.xyz", "a.lammpstrj"):
        with pytest.raises(CurveFileError, match="cannot be read: No such file"):
            list(snapshots(tmp_path / name))


def write_gsd(path, frames, box):
    gsd = pytest.importorskip("gsd.hoomd")
    with gsd.open(path, "w") as file:
        for step, points in enumerate(frames):
            frame = gsd.Frame()
            frame.configuration.step, frame.configuration.box = step, [box, box, box, 0.0, 0.0, 0.0]
            frame.particles.N, frame.particles.position = len(points), points
            ring = np.arange(len(points) - 1)  # the last bead is alone
            frame.bonds.N, frame.bonds.group = len(ring), np.stack([ring, np.roll(ring, -1)], axis=1)
            file.append(frame)


def write_by_mdanalysis(path, frames, box):
    MDAnalysis = pytest.importorskip("MDAnalysis")
    universe = MDAnalysis.Universe.empty(len(frames[0]), trajectory=True)
    with MDAnalysis.Writer(str(path), len(frames[0])) as file:
        for points in frames:
            universe.atoms.positions, universe.dimensions = points, [box, box, box, 90.0, 90.0, 90.0]
            file.write(universe.atoms)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("name", "write", "unit"),
    [("a.gsd", write_gsd, 1.0), ("a.xtc", write_by_mdanalysis, 10.0), ("a.dcd", write_by_mdanalysis, 1.0)],
)
def test_binary_trajectories(name, write, unit, tmp_path):
    path, frames = tmp_path / name, [np.vstack([POINTS, POINTS[0] + 0.5]), np.vstack([POINTS, POINTS[1]]) + 0.25]
    write(path, frames, 8.0)
    found = list(snapshots(path))
    assert len(found) == 2
    assert [each.name for each in tmp_path.iterdir()] == [name]
    for each, points in zip(found, frames, strict=True):
        assert np.allclose(each.points * unit, points, atol=1e-5)
        assert np.allclose(each.cell * unit, np.diag([8.0] * 3))
    report = audit(path, None if name == "a.gsd" else [3])
    assert (len(report.topology.chains), report.topology.closed) == (1, [True])
    data = path.read_bytes()
    for part in (data[:10], data[: len(data) // 2], b"something else\n" * 99):
        path.write_bytes(part)
        with pytest.raises(MobiusFlowError, match=name):
            audit(path, [3])
    for cut in (1, 24):  # within the last record, and before it
        path.write_bytes(data[:-cut])
        with pytest.raises(MobiusFlowError, match="cut off within its last frame" if name == "a.dcd" else name):
            list(snapshots(path))


def test_bonds_make_chains_and_rings(tmp_path):
    from mobius_flow.core.io.chains import Topology

    def of(*bonds):
        frame = Snapshot(np.zeros((9, 3)), np.zeros((3, 3)), bonds=np.array(bonds))
        found = Topology.of(frame, None, closed=True)
        return [(chain.tolist(), ring) for chain, ring in zip(found.chains, found.closed, strict=True)]

    assert of((3, 1), (1, 2), (0, 3)) == [([0, 3, 1, 2], False)]
    (ends, is_open), (ring, closed) = of((4, 5), (5, 6), (6, 4), (0, 1))
    assert (ends, is_open, sorted(ring), closed) == ([0, 1], False, [4, 5, 6], True)
    with pytest.raises(MobiusFlowError, match="bead 1 has 3 bonds; only chains and rings"):
        of((0, 1), (0, 2), (0, 3))
    with pytest.raises(MobiusFlowError, match="a bond of bead 10, and there are 9 beads"):
        of((0, 9))
