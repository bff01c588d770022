"""A page with the results of a batch."""

import sys

import numpy as np
import pytest
from batch_results import write_run
from mobius_flow.addon.pictures import export
from mobius_flow.cli import main
from mobius_flow.core import MobiusFlowError
from mobius_flow.core.curve.measures import bending
from mobius_flow.lab import gallery
from shapes import half_circle, regular_polygon, torus_trefoil

CURVES = {"round": regular_polygon(24), "knot": torus_trefoil(60), "knot-2": torus_trefoil(50)}


@pytest.fixture
def results(tmp_path):
    """Three results."""
    place = tmp_path / "results"
    write_run(place, "knot", 1, CURVES["knot"], energy=74.5)
    write_run(place, "knot", 2, CURVES["knot-2"], status="iteration_limit", energy=80.0)
    known = {"extrapolated_energy": 4.0, "extrapolated_energy_error": 2e-4}
    write_run(place, "round", 1, CURVES["round"], energy=4.0, **known)
    return place


def test_every_result_has_its_picture_name_and_energy(results, tmp_path, monkeypatch, capsys):
    image = pytest.importorskip("matplotlib.image")
    drawn = []
    titles = []
    write_page = gallery._write_page

    def draw(path, curve, width, height, look, *, cut_out):
        assert cut_out
        drawn.append(curve)
        picture = np.full((height, width, 4), 0.1 * len(drawn))
        picture[..., 3] = 0.1  # the faintest shadow
        picture[height // 4 : -height // 4, width // 4 : -width // 4, 3] = 1.0
        image.imsave(path, picture)

    def spied(path, given, *more):
        titles.extend(given)
        write_page(path, given, *more)

    monkeypatch.setattr(export, "require_blender", lambda: None)
    monkeypatch.setattr(export, "write_picture", draw)
    monkeypatch.setattr(gallery, "_write_page", spied)
    assert main(["gallery", str(results), "-o", str(tmp_path / "page.png")]) == 0
    assert capsys.readouterr() == ("", f"✓ wrote       {tmp_path}/page.png\n")
    assert titles == ["knot\n74.5000", "knot-2\n80.0000", "round\n4.0000 ± 0.0002"]
    assert bending(drawn[0]) < bending(CURVES["knot"])  # balanced, as it has converged
    assert np.array_equal(drawn[1].vertices, CURVES["knot-2"].vertices)
    page = image.imread(tmp_path / "page.png")
    assert [np.isclose(page[..., :3], 0.1 * k, atol=0.01).all(axis=2).sum() > 15_000 for k in (1, 2, 3)] == [True] * 3
    edge = np.concatenate([page[0], page[-1], page[:, 0], page[:, -1]])
    assert np.ptp(edge, axis=0).max() == 0.0  # pictures fade into one ground


def test_only_what_is_named_is_shown_in_that_order(results):
    assert [each.name for each in gallery._chosen(results, "round, knot")] == ["round", "knot"]
    with pytest.raises(MobiusFlowError, match=f"{results}: has no '3_1'; leave it out of --only"):
        gallery._chosen(results, "knot,3_1")


@pytest.mark.parametrize("options", ["{}", '{"avoid": [{"name": "ball.obj"}]}', '{"pins": [0]}'])
@pytest.mark.parametrize("curve", [half_circle(30), torus_trefoil(60)])
def test_curves_whose_moebius_images_are_something_else_are_shown_as_they_are(tmp_path, curve, options):
    write_run(tmp_path, "k", 1, curve, energy=1.0, options=options)
    (shown,) = gallery._chosen(tmp_path, None)
    moved = not np.array_equal(shown.look().vertices, curve.vertices)
    assert moved == (options == "{}" and curve.mesh.all_closed)


def test_rendered_by_blender(results, tmp_path, monkeypatch):
    pytest.importorskip("bpy")
    image = pytest.importorskip("matplotlib.image")
    assert main(["gallery", str(results), "-o", str(tmp_path / "page.png"), "--size", "32"]) == 0
    assert len(np.unique(image.imread(tmp_path / "page.png").reshape(-1, 4), axis=0)) > 200  # shaded


@pytest.mark.parametrize("library", ["bpy", "matplotlib.figure"])
def test_a_missing_library_is_named(library, results, monkeypatch, refused):
    if library != "bpy":
        monkeypatch.setattr(export, "require_blender", lambda: None)
    monkeypatch.setitem(sys.modules, library, None)
    assert f"pip install {library.partition('.')[0]}" in refused("gallery", results, "-o", results / "page.png")
    assert not (results / "page.png").exists()


@pytest.mark.parametrize(
    ("place", "out", "told"),
    [
        ("results", "page.jpg", "galleries end in .png"),
        ("results", "none/page.png", "does not exist"),
        ("none", "page.png", "holds no results of mobius-flow batch"),
        ("empty", "page.png", "holds no results of mobius-flow batch"),
        ("results", "page.png --only 9_1", "has no '9_1'"),
        ("results", "page.png --size 2", "size is 2; give 16 to 4000"),
    ],
)
def test_one_sentence(place, out, told, results, monkeypatch, refused):
    pytest.importorskip("matplotlib")
    monkeypatch.setattr(export, "require_blender", lambda: None)
    monkeypatch.chdir(results.parent)
    (results.parent / "empty").mkdir()
    assert told in refused("gallery", place, "-o", *out.split())
