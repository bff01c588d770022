"""``mobius-flow info`` from the terminal's point of view."""

import json
import sys
from importlib.machinery import ModuleSpec
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
from mobius_flow.core.knots import KnotType
from mobius_flow.core.knots.exterior import names_by_census

KEYS = {
    "input", "components", "vertices", "type", "energies", "length", "thickness", "ropelength", "writhe",
    "average_crossing_number", "edges", "gap", "gradient_norm", "at_rest", "index", "smooth", "symmetry", "closures",
}  # fmt: skip
TYPE_KEYS = {
    "name", "names", "proved", "evidence", "crossings", "linking_numbers", "alexander", "determinant", "jones",
    "homfly", "genus", "fibered", "group",
}  # fmt: skip


@pytest.fixture
def trefoil(tmp_path, run):
    run("knot", "3_1", tmp_path / "trefoil.obj")
    return tmp_path / "trefoil.obj"


def test_words(trefoil, run):
    status, text, _ = run("info", trefoil)
    assert status == 0
    assert text.splitlines()[0] == str(trefoil)
    assert "type                    3_1 (proved by the Jones polynomial" in text
    for name in ("moebius energy", "objective", "not at rest", "ropelength", "writhe", "ratio 1"):
        assert name in text


def test_json(trefoil, tmp_path, run):
    assert run("knot", "hopf", tmp_path / "hopf.txt")[0] == 0
    found = json.loads(run("info", trefoil, tmp_path / "hopf.txt", "--json")[1])
    assert [each["type"]["name"] for each in found] == ["3_1", "L2a1"]
    one = json.loads(run("info", trefoil, "--json")[1])
    assert one == found[0]
    assert set(one) == KEYS
    assert set(one["type"]) == TYPE_KEYS
    assert one["type"]["jones"] == [[1, 1], [3, 1], [4, -1]]
    assert one["type"]["homfly"] == [[2, 0, 2], [2, 2, 1], [4, 0, -1]]
    assert one["type"]["determinant"] == 3
    assert found[1]["type"]["linking_numbers"] == [1]
    assert found[1]["components"] == 2
    energy = float(run("energy", trefoil)[1])
    assert one["energies"]["moebius"] == pytest.approx(energy, rel=1e-12)


@pytest.mark.parametrize("form", ["pd", "gauss"])
def test_codes_are_written_and_read(form, tmp_path, run):
    for name in ("8_20", "L7a7"):
        assert run("knot", name, tmp_path / f"a.{form}")[0] == 0
        assert json.loads(run("info", tmp_path / f"a.{form}", "--json")[1])["type"]["names"] == [name]


def test_code_files(tmp_path, run):
    (tmp_path / "a.dt").write_text("# the cinquefoil\n[6 8 10\n2 4]\n")
    status, text, _ = run("info", tmp_path / "a.dt")
    assert status == 0
    assert " 5_1 (proved" in text
    assert run("knot", "3_1", tmp_path / "b.dt")[::2] == (
        2,
        f"mobius-flow: {tmp_path}/b.dt: this format is only read; choose another one to write\n",
    )
    (tmp_path / "empty.dt").write_text("# the cinquefoil\n")
    assert "empty.dt: the code is empty; write such as DT: [4 6 2]" in run("info", tmp_path / "empty.dt")[2]
    (tmp_path / "bad.pd").write_text("PD[X[1,2,3,4]]")
    status, _, said = run("info", tmp_path / "bad.pd")
    assert status == 2
    assert "bad.pd: edge 1 is in the planar diagram code once" in said


@pytest.mark.parametrize(
    ("name", "told"),
    [("DT: [4 6 2]", "3_1"), ("PD[X[1,5,2,4],X[3,1,4,6],X[5,3,6,2]]", "3_1"), ("Gauss: [[1,-2],[2,-1]]", "L2a1")],
)
def test_names_may_be_codes(name, told, tmp_path, run):
    assert run("knot", name, tmp_path / "a.txt", "--vertices", 90)[0] == 0
    found = json.loads(run("info", tmp_path / "a.txt", "--json")[1])
    assert found["type"]["names"] == [told]
    assert sum(found["vertices"]) == 90


@pytest.mark.parametrize("name", ["K99n34", "11a_99999", "L8n99999", "12n999999"])
def test_names_that_no_table_has_are_asked_for_as_codes(name, run):
    status, _, said = run("knot", name, "-")
    assert status == 2
    assert "give its code, such as" in said


def test_refusals(trefoil, tmp_path, run):
    assert run("info", "-", "-")[0] == 2
    assert run("info", trefoil, tmp_path / "missing.txt")[::2] == (
        2,
        f"mobius-flow: {tmp_path}/missing.txt: cannot be read: No such file or directory\n",
    )
    crossed = tmp_path / "crossed.txt"
    crossed.write_text("0 0 0\n1 1 0\n1 0 0\n0 1 0\n")
    assert run("info", crossed)[0] == 2


def test_arcs_have_no_type_until_they_are_closed(tmp_path, run):
    path = tmp_path / "an arc.txt"
    assert run("knot", "overhand", path)[0] == 0
    told = run("info", path)[1]
    assert "type                    none: only closed curves have a knot type, and this one is open\n" in told
    assert told.endswith(f"next                    mobius-flow info '{path}' --close\n")
    told = run("info", path, "--close")[1]
    assert " 3_1 (proved" in told
    assert "HOMFLY polynomial       (2v² − v⁴) + v² z²\n" in told
    assert "next " not in told
    assert "closures                3_1 100 % of 4\n" in run("info", path, "--closures", "4")[1]
    assert json.loads(run("info", path, "--closures", "4", "--seed", "2", "--json")[1])["closures"] == {"3_1": 4}


@pytest.mark.parametrize("installed", [False, True])
def test_larger_knots_are_named_by_snappy(installed, tmp_path, run, monkeypatch):
    """By one that knows a single knot."""
    reversing = SimpleNamespace(cusp_maps=lambda: [np.array([[-1, 0], [0, 1]])])
    exterior = SimpleNamespace(
        num_tetrahedra=lambda: 9,
        identify=lambda: [SimpleNamespace(name=lambda: "K11n34")],
        is_isometric_to=lambda _, return_isometries: [reversing],
    )
    snappy = ModuleType("snappy")
    snappy.__spec__ = ModuleSpec("snappy", None)
    snappy.Link = lambda code: SimpleNamespace(exterior=lambda **_: exterior)
    monkeypatch.setitem(sys.modules, "snappy", snappy if installed else None)
    monkeypatch.setattr(sys.modules[KnotType.__module__], "names_by_exterior", lambda _: ((), ""))
    monkeypatch.setattr(KnotType, "group", None)
    names_by_census.cache_clear()
    assert run("knot", "DT: [4 8 -12 2 16 -6 20 18 10 22 14]", tmp_path / "k.txt")[0] == 0
    told = run("info", tmp_path / "k.txt")[1]
    names_by_census.cache_clear()
    assert (" mK11n34 (not proved; it fits its complement" in told) is installed
    assert ("pip install snappy" in told) is not installed
