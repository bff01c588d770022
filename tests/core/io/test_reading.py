"""What the readers understand, and what they drop with a note."""

import logging

import numpy as np
import pytest
from mobius_flow.core import CurveFileError
from mobius_flow.core.io import read_curve, write_curve
from mobius_flow.core.knots import knot, knot_type

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
SQUARE = [[0, 0, 5], [1, 0, 5], [1, 1, 5], [0, 1, 5]]
SQUARE_V = "".join(f"v {x} {y} {z}\n" for x, y, z in SQUARE)
TRIANGLE_V = "".join(f"v {x} {y} {z}\n" for x, y, z in TRIANGLE)

UNDERSTOOD = {
    "spaces.txt": ("0 0 0\n1 0 0\n0 1 0\n", [TRIANGLE]),
    "commas.txt": ("0,0,0\n 1, 0 ,0 \n0 , 1, 0e0\n", [TRIANGLE]),
    "plane.txt": ("0 0\n1 0\n0 1", [[p[:2] for p in TRIANGLE]]),
    "windows.txt": ("0 0 0\r\n1 0 0\r\n0 1 0\r\n\r\n", [TRIANGLE]),
    "comments.txt": ("# head\n\n\n0 0 0 # first\n# between\n1 0 0\n0 1 0\n\n # tail\n", [TRIANGLE]),
    "mark.txt": ("\ufeff0 0 0\n1 0 0\n0 1 0\n", [TRIANGLE]),
    "two.txt": ("0 0 0\n1 0 0\n0 1 0\n\n\n0 0 5\n1 0 5\n1 1 5\n0 1 5", [TRIANGLE, SQUARE]),
    "head.csv": ("x,y,z\n0,0,0\n1,0,0\n0,1,0\n", [TRIANGLE]),
    "more.csv": ('# by pandas\n,"Y",part,"X","Z"\n0,0,a,0,0\n1,0,a,1,0\n2,1,a,0,0\n', [TRIANGLE]),
    "semicolons.csv": ("x;y;z\n0;0;0\n1;0;0\n0;1;0\n\n0;0;5\n1;0;5\n1;1;5\n0;1;5\n", [TRIANGLE, SQUARE]),
    "columns.tsv": ("0\t0\t0\n1\t0\t0\n0\t1\t0\n", [TRIANGLE]),
    "one_line.obj": (SQUARE_V + "l 1 2 3 4 1\n", [SQUARE]),
    "texture.obj": (SQUARE_V + "vt 0 0\nl 1/1 2/1 3/1 4/1 1/1\n", [SQUARE]),
    "mixed_directions.obj": (SQUARE_V + "l 3 2\nl 1 2\nl 4 1\nl 3 4\n", [SQUARE]),
    "backwards.obj": (SQUARE_V + "l 4 3 2 1 4\n", [[SQUARE[0], *SQUARE[:0:-1]]]),
    "chains.obj": (SQUARE_V + "l 3 4 1\nl 1 2 3\n", [SQUARE]),
    "unused.obj": ("v 9 9 9\n" + SQUARE_V + "v 8 8 8\nl 2 3 4 5 2\n", [SQUARE]),
    "two.obj": (TRIANGLE_V + SQUARE_V + "g a\nl 4 5 6 7 4\no b\nl 1 2 3 1\n", [TRIANGLE, SQUARE]),
    "late.obj": ("l 1 2 3 1\n" + TRIANGLE_V, [TRIANGLE]),
    "continued.obj": (TRIANGLE_V + "l 1 2 \\\n 3 1 # end\n", [TRIANGLE]),
    "colours.obj": (TRIANGLE_V.replace("\n", " .5 .5 .5\n") + "l 1 2 3 1\n", [TRIANGLE]),
    "closed.vect": ("VECT\n1 3 0\n-3\n0\n0 0 0 1 0 0\n0 1 0\n", [TRIANGLE]),
    "commented.vect": (
        "VECT # Geomview\n1 3 1 # counts\n-3\n1\n# points\n0 0 0\n1 0 0\n0 1 0\n1 0 0 1 # red\n",
        [TRIANGLE],
    ),
    "two.vect": ("VECT 2 7 0 -3 -4 0 0 0 0 0 1 0 0 0 1 0  0 0 5 1 0 5 1 1 5 0 1 5", [TRIANGLE, SQUARE]),
    "object.json": (f'{{"name": "x", "components": [{TRIANGLE}, {SQUARE}]}}', [TRIANGLE, SQUARE]),
    "components.json": (f"[{TRIANGLE}, {SQUARE}]", [TRIANGLE, SQUARE]),
    "points.json": (f"{TRIANGLE}", [TRIANGLE]),
    "object_points.json": (f'{{"components": {TRIANGLE}}}', [TRIANGLE]),
}


def _write(tmp_path, name, text):
    path = tmp_path / name
    path.write_bytes(text.encode())
    return path


OPEN = {
    "marked.txt": ("# open\n0 0 0\n1 0 0\n0 1 0\n", (False,)),
    "second.txt": ("0 0 0\n1 0 0\n0 1 0\n\n#  open \n0 0 5\n1 0 5\n1 1 5\n0 1 5\n", (True, False)),
    "first.txt": ("# open\n# of course\n0 0 0\n1 0 0\n0 1 0\n\n0 0 5\n1 0 5\n1 1 5\n0 1 5\n", (False, True)),
    "marked.csv": ("x,y,z\n# open\n0,0,0\n1,0,0\n0,1,0\n", (False,)),
    "path.obj": (TRIANGLE_V + "l 2 3\nl 1 2\n", (False,)),
    "both.obj": (TRIANGLE_V + SQUARE_V + "l 1 2 3 1\nl 7 6 5 4\n", (True, False)),
    "path.vect": ("VECT 1 3 0 3 0 0 0 0 1 0 0 0 1 0", (False,)),
    "both.vect": ("VECT 2 7 0 -3 4 0 0 0 0 0 1 0 0 0 1 0  0 0 5 1 0 5 1 1 5 0 1 5", (True, False)),
    "path.json": (f'{{"components": [{TRIANGLE}], "closed": [false]}}', (False,)),
    "points.json": (f'{{"closed": [false], "components": {TRIANGLE}}}', (False,)),
    "both.json": (f'{{"components": [{TRIANGLE}, {SQUARE}], "closed": [true, false]}}', (True, False)),
}
NOTED = {
    "closing.txt": ("0 0 0\n1 0 0\n0 1 0\n0 0 0\n", "repeats its first"),
    "closing.obj": (TRIANGLE_V + "v 0 0 0\nl 1 2 3 4\n", "repeats its first"),
    "vertices_only.obj": (TRIANGLE_V, "no polyline"),
    "faces.obj": (TRIANGLE_V + "l 1 2 3 1\nf 1 2 3\n", "1 faces"),
}
READ = {name: (text, expected, (True,) * len(expected), "") for name, (text, expected) in UNDERSTOOD.items()}
READ |= {f"open_{name}": (text, [TRIANGLE, SQUARE][: len(closed)], closed, "") for name, (text, closed) in OPEN.items()}
READ |= {f"noted_{name}": (text, [TRIANGLE], (True,), note) for name, (text, note) in NOTED.items()}


@pytest.mark.parametrize("name", READ)
def test_what_is_understood_and_what_is_noted(tmp_path, name, caplog):
    text, expected, closed, note = READ[name]
    with caplog.at_level(logging.WARNING):
        curve = read_curve(_write(tmp_path, name, text))
    assert len(caplog.records) == bool(note)
    assert note in caplog.text
    assert curve.mesh.component_sizes == tuple(map(len, expected))
    assert curve.mesh.closed == closed
    assert np.array_equal(curve.vertices, np.concatenate(expected))


def _atom(serial, residue, point, chain="A", name=" CA ", also=" "):
    place = "".join(f"{coordinate:8.3f}" for coordinate in point)
    return f"ATOM  {serial:5d} {name}{also}GLY {chain}{residue:4d}    {place}  1.00  0.00           C\n"


CHAIN = [_atom(2 * k, k, [3 * c for c in point]) for k, point in enumerate(TRIANGLE, start=1)]
SIDE = [_atom(2 * k + 1, k, [9, 9, 9], name=" CB ") for k in range(1, 4)]
OTHER = [_atom(20 + k, k, [3 * c for c in point], "B") for k, point in enumerate(SQUARE, start=1)]
PROTEINS = {
    "one.pdb": ("HEADER    KNOT\n" + "".join(map("".join, zip(CHAIN, SIDE, strict=True))) + "END\n", 1),
    "two.pdb": ("".join([*CHAIN, "TER\n", *OTHER]), 2),
    "ligand.pdb": ("".join(CHAIN) + _atom(9, 9, [9, 9, 9], name="CA  ").replace("ATOM  ", "HETATM"), 1),
    "after.pdb": ("".join([*CHAIN, "TER\n", _atom(9, 9, [9, 9, 9]).replace("ATOM  ", "HETATM")]), 1),
    "either.pdb": (CHAIN[0] + CHAIN[0].replace("GLY", "ALA") + "".join(CHAIN[1:]), 1),
    "places.pdb": (CHAIN[0] + _atom(3, 1, [9, 9, 9], also="B") + "".join(CHAIN[1:]), 1),
    "models.pdb": ("MODEL        1\n" + "".join(CHAIN) + "ENDMDL\n" + "".join(OTHER) + "ENDMDL\n", 1),
    "modified.pdb": (CHAIN[0] + CHAIN[1].replace("ATOM  ", "HETATM") + CHAIN[2], 1),
}


@pytest.mark.parametrize("name", PROTEINS)
def test_chains_of_proteins_are_arcs_of_alpha_carbons(tmp_path, name, caplog):
    text, chains = PROTEINS[name]
    with caplog.at_level(logging.WARNING):
        curve = read_curve(_write(tmp_path, name, text))
    assert not caplog.records
    assert curve.mesh.closed == (False,) * chains
    assert np.array_equal(curve.vertices, 3.0 * np.concatenate([TRIANGLE, SQUARE][:chains]))


def test_missing_residues_are_noted(tmp_path, caplog):
    text = CHAIN[0] + _atom(7, 7, [9, 0, 0])
    with caplog.at_level(logging.WARNING):
        assert len(read_curve(_write(tmp_path, "gap.pdb", text))) == 2
    assert "residues may be missing from GLY A 1 to GLY A 7; joined straight" in caplog.text


FEW = "data_X\nloop_\n_atom_site.id\n_atom_site.label_atom_id\n1 CA\n"
CIF = """data_KNOT
_entry.id KNOT
loop_
_atom_site.group_PDB
_atom_site.type_symbol
_atom_site.label_atom_id
_atom_site.label_comp_id
_atom_site.label_asym_id
_atom_site.label_seq_id
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
_atom_site.auth_asym_id
_atom_site.auth_seq_id
_atom_site.pdbx_PDB_model_num
ATOM N N GLY A 1 9 9 9 A 5 1
ATOM C CA GLY A 1 0 0 0 A 5 1
ATOM O "O5'" GLY A 1 9 9 9 A 5 1
ATOM C CA GLY A 1 0 0 1 A 5 1
ATOM C CA GLY A 2 3 0 0 A 6 1
HETATM C CA MSE A 3 0 3 0 A 7 1
HETATM CA CA CA C . 9 9 9 A 101 1
ATOM C CA GLY B 1 0 0 9 B 5 1
ATOM C CA GLY B 2 3 0 9 B 6 1
{more}#
loop_
_atom_type.symbol
C
"""


def test_chains_of_cif_files(tmp_path, caplog):
    with caplog.at_level(logging.WARNING):
        curve = read_curve(_write(tmp_path, "one.cif", CIF.format(more="")))
    assert not caplog.records
    assert curve.mesh.component_sizes == (3, 2)
    assert curve.mesh.closed == (False, False)
    assert curve.vertices[:3].tolist() == [[0, 0, 0], [3, 0, 0], [0, 3, 0]]
    again = "ATOM C CA GLY A 1 0 0 0 A 5 2\n"
    with caplog.at_level(logging.WARNING):
        curve = read_curve(_write(tmp_path, "two.cif", CIF.format(more="ATOM C CA GLY B 9 8 8 8 B 9 1\n" + again)))
    assert [record.message.partition(": ")[2] for record in caplog.records] == [
        "of 2 models the first is read",
        "residues may be missing from GLY B6 to GLY B9; joined straight",
    ]
    assert curve.mesh.component_sizes == (3, 3)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("data_X\n", "no alpha carbon"),
        (CIF.format(more="ATOM C\n"), "2 values"),
        (CIF.format(more=""), ""),
        (FEW, "has no Cartn_x, Cartn_y, Cartn_z"),
    ],
)
def test_cif_files_that_are_none(tmp_path, text, reason):
    text = text if reason else text.replace("3 0 0 A", "x 0 0 A")
    with pytest.raises(CurveFileError, match=reason or "not a number"):
        read_curve(_write(tmp_path, "odd.cif", text))


CODES = {
    "trefoil.pd": "# of the table\nPD[X[1,5,2,4],\n X[3,1,4,6], X[5,3,6,2]] # right-handed\n",
    "trefoil.dt": "DT[cacbca.001]",
    "trefoil.gauss": "1 -2 3 -1 2 -3\n",
    "trefoil.tsv": "0\t4\t1\t3\t1\n2\t0\t3\t5\t1\n4\t2\t5\t1\t1\n",
    "unsigned.tsv": "1\t5\t2\t4\n3\t1\t4\t6\n5\t3\t6\t2\n",
}


@pytest.mark.parametrize("name", CODES)
def test_codes_are_read_as_drawings(tmp_path, name):
    curve = read_curve(_write(tmp_path, name, CODES[name]))
    assert str(knot_type(curve)) == "3_1"


@pytest.mark.parametrize("suffix", [".pd", ".gauss"])
@pytest.mark.parametrize("name", ["3_1", "L5a1"])
def test_codes_that_are_written_are_of_the_same_knot(tmp_path, suffix, name):
    write_curve(tmp_path / f"k{suffix}", knot(name))
    assert knot_type(read_curve(tmp_path / f"k{suffix}")).names == knot_type(knot(name)).names
