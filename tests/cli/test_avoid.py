"""Obstacles on the command line: ``--avoid``."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.cli import main
from mobius_flow.core import Obstacle, read_curve, write_curve
from shapes import regular_polygon, torus_trefoil
from solids import plate


def write_mesh(path, obstacle: Obstacle):
    vertices = [f"v {x!r} {y!r} {z!r}" for x, y, z in obstacle.vertices.tolist()]
    faces = ["f " + " ".join(str(k + 1) for k in face) for face in obstacle.faces.tolist()]
    path.write_text("\n".join([*vertices, *faces]) + "\n")
    return path


def run(*words):
    return main([str(word) for word in words])


@pytest.fixture
def files(tmp_path):
    trefoil = torus_trefoil(60)
    write_curve(tmp_path / "trefoil.txt", trefoil.with_vertices(trefoil.vertices * [1.0, 1.0, 0.9]))
    write_mesh(tmp_path / "ceiling.obj", plate(0.95))
    write_mesh(tmp_path / "floor.obj", plate(-0.95))
    write_curve(tmp_path / "ring.txt", regular_polygon(30).with_vertices(9.0 * regular_polygon(30).vertices))
    return tmp_path


def test_obstacles_are_avoided_reported_and_verified(files, capsys):
    avoid = [word for name in ("ceiling.obj", "floor.obj", "ring.txt") for word in ("--avoid", files / name)]
    outputs = ["--report", files / "r.json", "--trajectory", files / "t.npz", "--max-iterations", 8]
    assert run("relax", files / "trefoil.txt", files / "o.txt", *outputs, *avoid) in (0, 1)
    assert np.abs(read_curve(files / "o.txt").vertices[:, 2]).max() < 0.95
    report = json.loads((files / "r.json").read_text())
    assert report["obstacles"] == 3
    assert report["options"]["avoid"] == ["ceiling.obj", "floor.obj", "ring.txt"]
    capsys.readouterr()
    assert run("verify", files / "t.npz") == 0
    assert capsys.readouterr().out.strip().endswith("in 1 stage, nor with 3 obstacles")
    assert run("verify", files / "t.npz", "--json") == 0
    verdict = json.loads(capsys.readouterr().out)
    assert (verdict["obstacles"], verdict["obstacle"]) == (3, None)


def test_a_verdict_names_the_obstacle_counted_from_one(files, capsys):
    arrays = {"stage_000": torus_trefoil(60).vertices[None], "component_sizes_000": np.array([60])}
    wall = plate(0.2)
    np.savez(files / "t.npz", **arrays, obstacle_000_vertices=wall.vertices, obstacle_000_faces=wall.faces)
    assert run("verify", files / "t.npz", "--json") == 1
    verdict = json.loads(capsys.readouterr().out)
    assert verdict["obstacle"] == 1
    assert verdict["reason"] == f"edge {verdict['edges'][0]} meets obstacle 1 (counted from 1)"


def one_line(capsys):
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    return captured.err


def test_a_curve_that_pierces_is_refused_with_file_and_line(files, capsys):
    write_mesh(files / "wall.obj", plate(0.3))
    assert run("relax", files / "trefoil.txt", files / "o.txt", "--avoid", files / "wall.obj") == 2
    said = one_line(capsys)
    assert "trefoil.txt, line " in said
    assert "pierces obstacle wall.obj at (" in said
    assert not (files / "o.txt").exists()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "mesh.obj: no face (f) and no polyline (l) found"),
        ("v 0 0 0\nf 1 2 3\n", "mesh.obj, line 2: vertex 3 does not exist; there are 1"),
        ("v 0 0 nan\nf 1 1 1\n", "vertex 1, (0, 0, nan), is not finite"),
        (None, "mesh.obj: cannot be read"),
    ],
)
def test_bad_meshes_are_refused_in_one_line(files, capsys, text, said):
    if text is not None:
        (files / "mesh.obj").write_text(text)
    assert run("relax", files / "trefoil.txt", files / "o.txt", "--avoid", files / "mesh.obj") == 2
    assert said in one_line(capsys)


@pytest.mark.parametrize(
    "words", [["relax", "trefoil.txt", "ring.json"], ["compare", "trefoil.txt", "-o", "ring.json"]]
)
def test_an_obstacle_is_not_overwritten(files, capsys, monkeypatch, words):
    monkeypatch.chdir(files)
    write_curve("ring.json", read_curve("ring.txt"))
    before = (files / "ring.json").read_text()
    assert run(*words, "--avoid", "ring.json") == 2
    assert "ring.json: --avoid ring.json and " in one_line(capsys)
    assert (files / "ring.json").read_text() == before


def test_compare_avoids_obstacles_too(files):
    words = ["--methods", "cg", "--max-iterations", 2, "--avoid", files / "floor.obj", "-o", files / "c.json"]
    assert run("compare", files / "trefoil.txt", *words) == 0


def test_the_help_says_that_it_may_be_given_several_times(capsys):
    assert run("relax", "--help") == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "--avoid MESH.obj" in said
    assert "may be given several times" in said


@pytest.mark.skipif(os.name != "posix", reason="links and pipes")
def test_an_obstacle_that_is_named_twice_counts_once(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_curve("in.txt", torus_trefoil(40))
    Path("wall.obj").write_text("v 9 0 0\nv 9 1 0\nv 9 0 1\nf 1 2 3\n")
    os.link("wall.obj", "hard.obj")
    os.symlink("wall.obj", "soft.obj")
    again = [word for name in ("wall", "./wall", "hard", "soft") for word in ("--avoid", f"{name}.obj")]
    reports = []
    for words in (again[:2], again):
        assert main(["relax", "in.txt", "out.txt", "--report", "r.json", "--max-iterations=1", *words]) == 0
        reports.append(json.loads(Path("r.json").read_text()))
    once, often = reports
    assert once["obstacles"] == often["obstacles"] == 1
    assert once["energy"] == often["energy"]


@pytest.mark.skipif(os.name != "posix", reason="links and pipes")
def test_an_obstacle_in_a_pipe_is_not_waited_for(tmp_path, capsys):
    write_curve(tmp_path / "in.txt", torus_trefoil(40))
    os.mkfifo(tmp_path / "wall.obj")
    words = ["relax", tmp_path / "in.txt", tmp_path / "out.txt", "--avoid", tmp_path / "wall.obj"]
    assert main(list(map(str, words))) == 2
    assert "wall.obj: is not a regular file; obstacles are not read from pipes" in capsys.readouterr().err
