"""Knots from other programs: their objects, and the lists that people download."""

from types import SimpleNamespace

import numpy as np
import pytest
from mobius_flow.cli import main
from mobius_flow.core import Curve, CurveError, CurveFileError, knot_list, read_curve
from mobius_flow.core.knots import knot, knot_type

KNOTINFO = """name|category|pd_notation|dt_notation|braid_notation
Name|Category|PD Notation|DT Notation|Braid Notation
3_1|3|[[1,5,2,4],[3,1,4,6],[5,3,6,2]]|[4, 6, 2]|[1,1,1]
5_2|5|[[1,5,2,4],[3,9,4,8],[5,1,6,10],[7,3,8,2],[9,7,10,6]]|[4, 8, 10, 2, 6]|[1,1,1,2,-1,2]
"""
TREFOIL = "0\t3\t1\t4\t-1\t0\t0\n2\t5\t3\t0\t-1\t0\t0\n4\t1\t5\t2\t-1\t0\t0\n"  # with signs and colours
LISTS = {
    "bars": (KNOTINFO, {"3_1": {"3_1", "m3_1"}, "5_2": {"5_2", "m5_2"}}),
    "DT, tabs": ("Name\tDT Notation\n4_1\t[4, 6, 8, 2]\n\t[4, 6, 2]\n", {"4_1": {"4_1"}, "knot-2": {"3_1", "m3_1"}}),
    "braids": (
        'knot,braid_notation\n"3_1","[-1,-1,-1]"\n"L4a1","{2, {1, 1, 1, 1}}"\n',
        {"3_1": {"m3_1"}, "L4a1": None},
    ),
    "SnapPy": ("DT: [(4, 6, 2)]\nPD: [(4, 2, 5, 1), (6, 4, 1, 3), (2, 6, 3, 5)]\n", {"knot-1": None, "knot-2": None}),
    "names and codes": ("a, DT: [4 6 2]\nb [[1,5,2,4],[3,1,4,6],[5,3,6,2]]\n", {"a": None, "b": None}),
    "LinkInfo": (
        'name,pd_notation_math\nName,PD Notation (KnotTheory)\nL2a1{0},"PD[X[4, 1, 3, 2], X[2, 3, 1, 4]]"\n',
        {"L2a1{0}": {"L2a1", "mL2a1"}},
    ),
    "KnotInfo's unknot has no code": (
        "name|pd_notation\n0_1|\n3_1|[[1,5,2,4],[3,1,4,6],[5,3,6,2]]\n",
        {"0_1": {"0_1"}, "3_1": None},
    ),
    "letters": ("name,dt_code\nDT,DT Code\na,cacbca.001\n", {"a": {"3_1", "m3_1"}}),
    "manifolds": ("3_1(0,0)\nL5a1(0,0)(0,0)\n", {"3_1": {"3_1"}, "L5a1": {"L5a1", "mL5a1"}}),
    "KnotFolio": (
        "PD[Xp[1,5,2,4],Xp[3,1,4,6],Xp[5,3,6,2]]\nLink([(1,5,2,4), (3,1,4,6), (5,3,6,2)])\nPD[P[1,1]]\n",
        {"knot-1": {"3_1"}, "knot-2": {"3_1"}, "knot-3": {"0_1"}},
    ),
    "Knoodle": (
        f"k\ns 1\n{TREFOIL}s 0\n{TREFOIL}k\nu 0\nk\ns\n{TREFOIL}",
        {"knot-1": {"m3_1#m3_1"}, "knot-2": {"0_1"}, "knot-3": {"m3_1"}},
    ),
    "Knoodle, one knot": (TREFOIL, {"knot-1": {"m3_1"}}),
}


@pytest.mark.parametrize("kind", LISTS)
def test_lists_as_people_download_them(kind, tmp_path):
    text, wanted = LISTS[kind]
    (tmp_path / "list.csv").write_text(text)
    found = knot_list(tmp_path / "list.csv")
    assert list(found) == list(wanted)
    for name, names in wanted.items():
        type_of = knot_type(knot(found[name]))
        assert names is None or set(type_of.names) <= names
        assert type_of.names


NO_LISTS = {
    "": "empty",
    "\n\n": "empty",
    "x,y,z\n1,2,3\n": "no code in any line",
    "name,color\na,b\n": "no column named",
}
NO_LISTS['name,pd_notation\n3_1,"' + "1" * 200_000] = "field larger .* quotation mark is not closed"


@pytest.mark.parametrize("text", NO_LISTS, ids=range(len(NO_LISTS)))
def test_what_is_no_list(text, tmp_path):
    (tmp_path / "list.csv").write_text(text)
    with pytest.raises(CurveFileError, match=rf"list\.csv: .*{NO_LISTS[text]}"):
        knot_list(tmp_path / "list.csv")


def test_names_that_differ_by_a_sign_have_files_of_their_own(tmp_path, capsys):
    (tmp_path / "list.csv").write_text("".join(f"{name}, DT: [4 6 2]\n" for name in ("a!", "a?", "A!")))
    assert main(["knot", str(tmp_path / "list.csv"), str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.glob("*.txt")) == ["A_-3.txt", "a_-2.txt", "a_.txt"]
    assert main(["knot", str(tmp_path / "none.csv"), str(tmp_path)]) == 2
    assert "none.csv: cannot be read" in capsys.readouterr().err


def test_a_list_becomes_files(tmp_path, capsys):
    (tmp_path / "list.csv").write_text(KNOTINFO + "odd|1|[[1,2,3,4]]|[2]|[0]\n")
    assert main(["knot", str(tmp_path / "list.csv"), str(tmp_path / "none")]) == 2
    (tmp_path / "out").mkdir()
    assert main(["knot", str(tmp_path / "list.csv"), str(tmp_path / "out"), "--format", "obj"]) == 2
    assert "1 of 3 knots cannot be made: odd: " in capsys.readouterr().err
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["3_1.obj", "5_2.obj"]
    assert main(["knot", str(tmp_path / "list.csv"), str(tmp_path / "out"), "--smooth"]) == 2
    assert "--smooth is for names of the table" in capsys.readouterr().err


def test_links_of_spherogram_and_manifolds_of_snappy():
    spherogram = pytest.importorskip("spherogram")
    assert knot_type(Curve.of(spherogram.Link("8_20"))).names == ("8_20",)
    assert set(knot_type(Curve.of(spherogram.Link(braid_closure=[1, 1, 1]))).names) <= {"3_1", "m3_1"}
    assert len(Curve.of(spherogram.Link("L6a4")).components) == 3
    snappy = pytest.importorskip("snappy")
    assert set(knot_type(Curve.of(snappy.Manifold("K3a1"))).names) <= {"3_1", "m3_1"}
    with pytest.raises(CurveError, match=r"m004.* has no link"):
        Curve.of(snappy.Manifold("m004"))
    assert knot_type(knot(str(snappy.Manifold("8_20")))).names == ("8_20",)


def test_objects_of_others():
    class Diagram:
        def PD_code(self):  # noqa: N802 (SnapPy's name)
            return [[1, 5, 2, 4], [3, 1, 4, 6], [5, 3, 6, 2]]

    assert knot_type(Curve.of(Diagram())).names == knot_type(knot("PD: [[1,5,2,4],[3,1,4,6],[5,3,6,2]]")).names
    assert knot_type(Curve.of(SimpleNamespace(link=Diagram))).names
    circle = SimpleNamespace(PD_code=list, unlinked_unknot_components=2)
    assert len(Curve.of(circle).components) == 2
    curve = knot("3_1")
    assert Curve.of(curve) is curve
    assert len(Curve.of([np.eye(3), 2 + np.eye(3)]).components) == 2
    for odd in (None, "3_1", object()):
        with pytest.raises(CurveError):
            Curve.of(odd)


def test_one_knot_of_knoodles_is_a_curve(tmp_path):
    (tmp_path / "sum.tsv").write_text(f"k\ns\n{TREFOIL}s\n{TREFOIL}")
    assert knot_type(read_curve(tmp_path / "sum.tsv")).names == ("m3_1#m3_1",)
    for text, reason in {
        f"k\n{TREFOIL}k\n{TREFOIL}": "2 knots; mobius-flow knot FILE DIRECTORY",
        TREFOIL + "1 2 3\n": "line 4: 3 columns",
        f"s\n4 1 3 2\n2 3 1 4\ns\n{TREFOIL}": "columns; all crossings have as many",
        "s\n4 1 3 2\n2 3 1 4\ns\n4 1 3 2\n2 3 1 4\n": "a summand is a link",
        TREFOIL.replace("-1", "1"): "line 1: the sign of this crossing",
    }.items():
        (tmp_path / "odd.tsv").write_text(text)
        with pytest.raises(CurveFileError, match=reason):
            read_curve(tmp_path / "odd.tsv")
