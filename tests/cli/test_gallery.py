"""A page with the results of a batch."""

import csv
import os
import sys
from dataclasses import asdict, fields
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.addon.pictures import export
from mobius_flow.cli import gallery, main
from mobius_flow.cli.batch.table import Row
from mobius_flow.core import Curve, MobiusFlowError, write_curve
from mobius_flow.core.curve.bending import bending
from shapes import half_circle, regular_polygon, torus_trefoil

CURVES = {"round": regular_polygon(24), "knot": torus_trefoil(60), "knot-2": torus_trefoil(50)}


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """Three results, and a run without one."""
    place = tmp_path / "results"
    rows = [
        Row(name="knot", start=1, seed=None, status="converged", message="", options="{}", energy=74.5),
        Row(name="knot", start=2, seed=2, status="iteration_limit", message="", options="{}", energy=80.0),
        Row(name="none", start=1, seed=None, status="failed", message="empty", options="{}"),
        Row(
            name="round",
            start=1,
            seed=None,
            status="converged",
            message="",
            options="{}",
            energy=4.0,
            extrapolated_energy=4.0,
            extrapolated_energy_error=2e-4,
        ),
    ]
    for name, curve in CURVES.items():
        (place / name).mkdir(parents=True)
        write_curve(place / name / "curve.txt", curve)
    with (place / "results.csv").open("w", newline="") as stream:
        table = csv.DictWriter(stream, [field.name for field in fields(Row)])
        table.writeheader()
        table.writerows(map(asdict, rows))
    return place


def test_every_result_has_its_picture_name_and_energy(
    results: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    image = pytest.importorskip("matplotlib.image")
    drawn: list[Curve] = []
    titles: list[str] = []
    write_page = gallery._write_page

    def draw(path: Path, curve: Curve, width: int, height: int) -> None:
        drawn.append(curve)
        image.imsave(path, np.full((height, width, 3), 0.1 * len(drawn)))

    def spied(path: str, given: list[str], pictures: list[Path]) -> None:
        titles.extend(given)
        write_page(path, given, pictures)

    monkeypatch.setattr(export, "require_blender", lambda: None)
    monkeypatch.setattr(export, "write_picture", draw)
    monkeypatch.setattr(gallery, "_write_page", spied)
    assert main(["gallery", str(results), "-o", str(tmp_path / "page.png")]) == 0
    assert capsys.readouterr() == ("", "")
    assert titles == ["knot\n74.5000", "knot-2\n80.0000", "round\n4.0000 ± 0.0002"]
    assert bending(drawn[0]) < bending(CURVES["knot"])  # balanced, as it has converged
    assert np.array_equal(drawn[1].vertices, CURVES["knot-2"].vertices)
    page = image.imread(tmp_path / "page.png")
    assert [np.isclose(page[..., :3], 0.1 * k, atol=0.01).all(axis=2).sum() > 20_000 for k in (1, 2, 3)] == [True] * 3


def test_tables_of_earlier_versions_are_read(results: Path) -> None:
    table = results / "results.csv"
    new = {"input_sha256", "proved", "ropelength", "writhe", "average_crossing_number"}
    new |= {"iterations", "fallback_steps", "processor_seconds"}
    now = [(each.title, each.free) for each in gallery._results(results)]
    with table.open(encoding="utf-8", newline="") as stream:
        rows = [{name: row[name] for name in row if name not in new} for row in csv.DictReader(stream)]
    with table.open("w", encoding="utf-8", newline="") as stream:
        old = csv.DictWriter(stream, list(rows[0]))
        old.writeheader()
        old.writerows(rows)
    assert len(rows[0]) == 18
    assert [(each.title, each.free) for each in gallery._results(results)] == now


@pytest.mark.parametrize("options", ["{}", '{"avoid": [{"name": "ball.obj"}]}', '{"pins": [0]}'])
@pytest.mark.parametrize("curve", [half_circle(30), torus_trefoil(60)])
def test_curves_whose_moebius_images_are_something_else_are_shown_as_they_are(
    tmp_path: Path, curve: Curve, options: str
) -> None:
    row = {"name": "k", "start": "1", "extrapolated_energy": "", "energy": "1", "status": "converged"}
    (tmp_path / "k").mkdir()
    write_curve(tmp_path / "k" / "curve.txt", curve)
    shown = gallery._shown(tmp_path, row | {"options": options})
    moved = not np.array_equal(shown.look().vertices, curve.vertices)
    assert moved == (options == "{}" and curve.mesh.all_closed)


@pytest.mark.parametrize(
    "text", ["name,start,status\nknot\n", f"name,start,status,energy\n{'x' * 200_000},1,converged,1\n", "\0\xff"]
)
def test_other_tables_are_no_results(
    text: str, results: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.setattr(export, "require_blender", lambda: None)
    (results / "results.csv").write_text(text, encoding="latin-1")
    assert main(["gallery", str(results), "-o", str(results / "page.png")]) == 2
    assert capsys.readouterr().err == f"mobius-flow: {results}: holds no results of mobius-flow batch\n"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes with names")
@pytest.mark.parametrize(
    ("pipe", "told"),
    [
        ("results.csv", "{}: holds no results of mobius-flow batch"),
        ("round/curve.txt", "{}/round/curve.txt: cannot be read: it is missing, or not a regular file"),
    ],
)
def test_a_pipe_is_no_result(pipe: str, told: str, results: Path) -> None:
    (results / pipe).unlink()
    os.mkfifo(results / pipe)
    with pytest.raises(MobiusFlowError) as refusal:
        gallery._results(results)
    assert str(refusal.value) == told.format(results)


def test_rendered_by_blender(results: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("bpy")
    image = pytest.importorskip("matplotlib.image")
    monkeypatch.setattr(gallery, "SIZE", 32)
    assert main(["gallery", str(results), "-o", str(tmp_path / "page.png")]) == 0
    assert len(np.unique(image.imread(tmp_path / "page.png").reshape(-1, 4), axis=0)) > 200  # shaded


@pytest.mark.parametrize("library", ["bpy", "matplotlib.figure"])
def test_a_missing_library_is_named(
    library: str, results: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    if library != "bpy":
        monkeypatch.setattr(export, "require_blender", lambda: None)
    monkeypatch.setitem(sys.modules, library, None)
    assert main(["gallery", str(results), "-o", str(results / "page.png")]) == 2
    assert f"pip install {library.partition('.')[0]}" in capsys.readouterr().err
    assert not (results / "page.png").exists()


@pytest.mark.parametrize(
    ("place", "out", "told"),
    [
        ("results", "page.jpg", "galleries end in .png"),
        ("results", "none/page.png", "does not exist"),
        ("none", "page.png", "holds no results of mobius-flow batch"),
        ("empty", "page.png", "holds no results of mobius-flow batch"),
        ("failed", "page.png", "none of the runs has a result"),
    ],
)
def test_one_sentence(
    place: str,
    out: str,
    told: str,
    results: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.setattr(export, "require_blender", lambda: None)
    for name in ("empty", "failed"):
        (results.parent / name).mkdir()
    lines = (results / "results.csv").read_text().splitlines(keepends=True)
    (results.parent / "failed/results.csv").write_text("".join([lines[0], lines[3]]))
    assert main(["gallery", str(results.parent / place), "-o", str(results.parent / out)]) == 2
    said = capsys.readouterr().err
    assert told in said
    assert said.count("\n") == 1
