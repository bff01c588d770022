"""Every bad file gives one sentence that names the file, the line and the reason; never a traceback."""

import json

import numpy as np
import pytest
from families import crossed
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from mobius_flow.core.base.errors import CurveError, CurveFileError, Place
from mobius_flow.core.io import FORMATS, load_curve, read_curve
from mobius_flow.core.io.source import Source

V = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

ALPHA = "ATOM      2  CA  GLY A   1       1.000   2.000   3.000  1.00  0.00           C\n"

REFUSED: dict[str, tuple[str, int | None, str]] = {
    "word.txt": ("0 0 0\n1 x 0\n0 1 0\n", 2, "'x' is not a number"),
    "underscore.txt": ("0 0 0\n1_0 0 0\n", 2, "not a number"),
    "empty_field.txt": ("0,0,0\n1,,0\n", 2, "'' is not a number"),
    "four_columns.txt": ("0 0 0 0\n", 1, "4 columns"),
    "ragged.txt": ("# c\n0 0 0\n1 0\n", 3, "2 columns where the lines before have 3"),
    "two_points.txt": ("0 0 0\n1 0 0\n0 1 0\n\n1 1 1\n2 2 2\n", 5, "component 2 has 2 vertices"),
    "one_point.txt": ("1 1 1\n", 1, "component 1 has 1 vertex;"),
    "nan.txt": ("0 0 0\n1 0 0\n0 nan 0\n", 3, "component 1, vertex 3 is not finite"),
    "inf.xyz": ("0 0 0\n1 0 0\n0 1 0\n\n0 0 0\n0 1e999 0\n", 6, "component 2, vertex 2 is not finite"),
    "empty.txt": ("", None, "empty"),
    "blank.obj": (" \n\n", None, "empty"),
    "comments.txt": ("# nothing\n", None, "no vertex"),
    "comments.vect": ("# nothing\n", None, "comments only"),
    "chemistry.xyz": ("3\nwater\nO 0 0 0\n", 1, "1 column"),
    "word.csv": ("x,y,z\n0,0,0\n1,x,0\n", 3, "'x' is not a number"),
    "names.csv": ("a,b,c\n0,0,0\n", 1, "'a' is not a number"),
    "head.csv": ("x,y,z\n", None, "no vertex"),
    "decimal.csv": ("0,5;1,5;2,5\n", 1, "6 columns where x y z"),
    "eight.tsv": ("0\t0\t0\t0\t0\t0\t0\t0\n", 1, "8 columns"),
    "real.tsv": ("1\t5\t2\t4\n3\t1.5\t4\t6\n", 2, "'1.5' is not a whole number"),
    "ragged.tsv": ("0\t4\t1\t3\t1\n2\t0\t3\t5\n", 2, "4 columns; all crossings have as many"),
    "sign.tsv": ("0\t4\t1\t3\t1\n2\t0\t3\t5\t-1\n4\t2\t5\t1\t1\n", 2, "sign of this crossing is -1"),
    "many.tsv": ("0\t0\t1\t1\n" * 1001, None, "1001 crossings; at most 1000"),
    "edge.tsv": ("0\t4\t1\t3\n2\t0\t3\t5\n", None, "edge 4 is in the planar diagram code once"),
    "empty.pdb": ("HEADER    NOTHING\nEND\n", None, "no alpha carbon found"),
    "one.pdb": (ALPHA, 1, "an open polygon needs at least 2"),
    "number.pdb": (
        ALPHA + ALPHA.replace("   1    ", "   2    ").replace("2.000", "2.0x0"),
        2,
        "'2.0x0' is not a number",
    ),
    "cut.pdb": (ALPHA[:40] + "\n", 1, "is not a number"),
    "word.pd": ("# a trefoil\nPD[X[1,5,2,4],\nX[3,1,4,six],X[5,3,6,2]]", 3, "'six' is neither a bracket nor"),
    "open.dt": ("DT:\n[4 6\n2", 2, "this bracket has no closing one"),
    "part.gauss": ("1 -2\n/\n/ 2 -1", 3, "a component is empty"),
    "branch.obj": (V + "v 1 1 1\nl 1 2 3 1\nl 1 4\n", 6, "third edge meets vertex 1"),
    "loop.obj": (V + "l 1 2 2 3 1\n", 4, "vertex 2 to itself"),
    "twice.obj": (V + "l 1 2\nl 2 1\n", 1, "component 1 has 2 vertices"),
    "zero.obj": (V + "l 0 1 2\n", 4, "vertex 0 does not exist"),
    "too_negative.obj": (V + "l -1 -2 -4 -1\n", 4, "vertex -4 does not exist"),
    "short.obj": ("v 0 0\n", 1, "needs x y z"),
    "bad_number.obj": ("v 0 0 zero\n", 1, "'zero' is not a number"),
    "huge_index.obj": (V + f"l 1 2 {'9' * 5000}\n", 4, "not a whole number"),
    "short_line.obj": (V + "l 1\n", 4, "at least two"),
    "faces.obj": (V + "f 1 2 3\n", None, "no polylines"),
    "nurbs.obj": (V + "cstype bspline\ncurv 0 1 1 2 3\n", 5, "convert"),
    "columns.obj": ("0 0 0\n1 0 0\n", 1, "'0' is not an OBJ statement"),
    "no_vertex.obj": ("o thing\n", None, "no vertex"),
    "magic.vect": ("1 3 0\n", 1, "starts with the word VECT"),
    "binary.vect": ("VECT BINARY\n", 1, "binary"),
    "header_only.vect": ("VECT\n", 1, "truncated"),
    "counts.vect": ("VECT\n1 x 0\n", 2, "'x' is not a whole number"),
    "below_zero.vect": ("VECT\n-1 3 0\n", 2, "negative"),
    "billion.vect": ("VECT\n1 1000000000 0\n-1000000000\n0\n0 0 0\n", 5, "3000000000 coordinates announced, 3 found"),
    "colours.vect": ("VECT\n1 3 1000000000\n-3\n1000000000\n0 0 0\n1 0 0\n0 1 0\n", 7, "colour values announced"),
    "sum.vect": ("VECT\n1 4 0\n-3\n0\n", 4, "3 vertices together, the header says 4"),
    "hollow.vect": ("VECT\n2 3 0\n3 0\n0 0\n0 0 0 1 0 0 0 1 0", 4, "polyline 2 has no vertices"),
    "one_point.vect": ("VECT\n1 1 0\n1\n0\n0 0 0", 5, "an open polygon needs at least 2 different vertices"),
    "one_open_point.txt": ("# open\n1 1 1\n", 2, "an open polygon needs at least 2"),
    "tree.obj": (V + "v 1 1 1\nl 1 2 3\nl 2 4\n", 6, "third edge meets vertex 2"),
    "cut.vect": ("VECT\n1 3 0\n-3\n0\n0 0 0 1 0 0\n 0 1", 6, "9 coordinates announced, 8 found"),
    "more.vect": ("VECT\n1 3 0\n-3\n0\n0 0 0 1 0 0 0 1 0\n7", 6, "more words"),
    "none.vect": ("VECT\n0 0 0\n", None, "no vertex"),
    "nan.vect": ("VECT\n1 3 0\n-3\n0\n0 0 0\n1 nan 0\n0 1 0", 6, "component 1, vertex 2"),
    "syntax.json": ('{"components":\n [[0, 0 0]]}', 2, "not JSON"),
    "key.json": ('{"points": []}', 1, '"components"'),
    "nan.json": ('{"n": [1],\n"components": [[[0,0,0],\n[1,0,0],[0,NaN,0]]]}', 3, "component 1, vertex 3"),
    "huge.json": (f"[[0,0,0],\n[1,0,0],\n[0,1{'0' * 400},0]]", 3, "component 1, vertex 3"),
    "digits.json": (f"[[0,0,1{'0' * 9000}]]", None, "not a curve"),
    "pointer.txt": ("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n", None, "git lfs pull"),
    "deep.json": ("[" * 100_000, None, "nested too deeply"),
    "garbage.json": ("[[[0,0,0],\n[1,[2],0],[0,1,0]]]", 2, "a list where a coordinate"),
    "null.json": ('{"components":\n null}', 2, "null where a list of components"),
    "object.json": ('[[[0,0,0],\n{"x": 1}, [0,1,0]]]', 2, "an object where a point"),
    "hollow.json": ('{"components": [[[0,0,0],[1,0,0],[0,1,0]],\n[]]}', 2, "an empty list where a list of points"),
    "flags.json": ('{"components": [[[0,0,0],[1,0,0]]],\n"closed": [false, true]}', 2, "of which there are 1"),
    "words.json": ('{"closed": "no",\n"components": [[[0,0,0],[1,0,0]]]}', 1, '"closed" must be a list'),
    "thin.json": ("[[[0],[1],[2]]]", 1, "at least 2"),
    "wide.json": (json.dumps(np.eye(17).tolist()), 1, "vertices have 17 coordinates; there may be at most 16"),
    "ragged.json": ("[[[0,0,0],[1,0,0],\n[0,1]]]", 2, "component 1, vertex 3 has 2 coordinates"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_with_file_line_and_reason(tmp_path, name):
    text, line, reason = REFUSED[name]
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(CurveFileError) as caught:
        read_curve(path)
    message = str(caught.value)
    assert reason in message
    assert message.startswith(f"{path}, line {line}: " if line else f"{path}: ")
    assert caught.value.line == line
    assert "\n" not in message


@pytest.mark.parametrize("data", [b"\x89PNG\r\n\x1a\n\x00\x00", b"0 0 0\n1 \xff 0\n", "0 0 0".encode("utf-16")])
@pytest.mark.parametrize("suffix", FORMATS)
def test_binary_files(tmp_path, suffix, data):
    path = tmp_path / f"curve{suffix}"
    path.write_bytes(data)
    with pytest.raises(CurveFileError, match=r"line [123]: not a text file in UTF-8"):
        read_curve(path)


@pytest.mark.parametrize("suffix", FORMATS)
def test_missing_directory_and_impossible_paths(tmp_path, suffix):
    for name in ("missing", "dir", "a\0b", "x" * 300):
        path = tmp_path / f"{name}{suffix}"
        if name == "dir":
            path.mkdir()
        with pytest.raises(CurveFileError, match="cannot be read"):
            read_curve(path)


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("curve.stl", r"unknown suffix '\.stl'.*txt, .xyz, .obj, .vect, .json"),
        ("curve", "no suffix.*txt, .xyz, .obj, .vect, .json"),
        ("a.vct", r"did you mean \.vect\?"),
    ],
)
def test_unknown_suffixes_list_the_known(tmp_path, name, found):
    with pytest.raises(CurveFileError, match=found):
        read_curve(tmp_path / name)


@pytest.mark.parametrize(("suffix", "end"), crossed(FORMATS, ["\n", "\r", "\r\n"]))
def test_files_longer_than_any_curve(tmp_path, suffix, end):
    path = tmp_path / f"long{suffix}"
    for data, said in (
        (b"0 0 0\n" * (Source.max_bytes // 6 + 1), "longer than 16 MB"),
        (f"0 0 0{end}".encode() * (Source.max_lines + 1), "more than 500000 lines"),
    ):
        path.write_bytes(data)
        with pytest.raises(CurveFileError, match=said):
            read_curve(path)


PIECES = [*"0123456789", *" \n\t\r", *'[]{}:,;"\\#-+.eE/', "v ", "\nv 0 0 1", "\nl ", "f ", "VECT", "BINARY", "-3 "]
PIECES += ['{"components":', "NaN", "Infinity", "true", "null", "1e999", "\n0 1 2", "[[0,1,2],[3,4,5],[6,7,9]]", "\0"]
GRAMMAR = st.lists(st.sampled_from(PIECES), max_size=60).map(lambda pieces: "".join(pieces).encode())


@pytest.mark.parametrize("suffix", FORMATS)
@given(
    data=st.one_of(st.binary(max_size=200), st.text(max_size=200).map(lambda s: s.encode("utf-8", "replace")), GRAMMAR)
)
@example(data=b"VECT 1 3 0 -3 0" + b" 0" * 9)
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_any_bytes_give_a_curve_or_one_sentence(tmp_path, suffix, data):
    path = tmp_path / f"fuzz{suffix}"
    path.write_bytes(data)
    message = None
    try:
        mesh = read_curve(path).mesh
        assert all(size >= (3 if closed else 2) for size, closed in zip(mesh.component_sizes, mesh.closed, strict=True))
    except CurveFileError as error:
        message = str(error)
    assert message is None or message.startswith(str(path))
    assert message is None or "\n" not in message


def test_later_errors_find_file_and_line(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("# two triangles\n0 0 0\n1 0 0\n0 1 0\n\n0 0 5\n# here\n1 0 5\n0 1 5\n")
    file = load_curve(path)
    assert [file.line_of(vertex) for vertex in range(6)] == [2, 3, 4, 6, 8, 9]
    assert str(file.refusal(CurveError("bad", Place((4, 5), (1.0, 0.0, 5.0))))) == f"{path}, line 8: bad"
    assert str(file.refusal(CurveError("bad", Place((), (0.0, 0.0, 0.0))))) == f"{path}: bad"
    assert str(file.refusal(CurveError("bad"))) == f"{path}: bad"
