"""Pictures of curves and motions, and plots of energies."""

import io
import json
import re
import struct
import sys
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from mobius_flow.addon.engine.rest import Target, plot
from mobius_flow.core import Curve, CurveError, MobiusFlowError, RelaxOptions, Trajectory, minimize, relax
from mobius_flow.core.collision.gap import thickness
from mobius_flow.core.curve.measures import writhe_and_crossings
from mobius_flow.core.keys.solids import animation, solid, wire
from mobius_flow.core.keys.view import drawing, figure, motion, still
from mobius_flow.core.knots import knot


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """The path of a link whose mesh changes."""
    path = tmp_path_factory.mktemp("view") / "T.npz"
    trajectory = Trajectory()
    for iterate in relax(knot("L2a1", 40), RelaxOptions(max_iterations=12, mesh="adaptive")):
        trajectory.add(iterate)
    trajectory.save(path)
    return path


def test_wires_are_as_wide_as_there_is_room():
    curve = knot("3_1")
    widest = 2 * thickness(curve)
    assert len(wire(curve, 0.99 * widest)) == 1
    assert wire(curve, rope=0.4 * widest)[0].points.tolist() == wire(curve, 0.8 * widest)[0].points.tolist()
    for width in (1.01 * widest, 0.0, -1.0, np.nan, np.inf):
        with pytest.raises(CurveError, match="room for"):
            wire(curve, width)


@pytest.mark.parametrize("kind", ["stl", "3mf"])
def test_solids_come_back(kind):
    trimesh = pytest.importorskip("trimesh")
    curve = knot("L2a1")
    read = trimesh.load(io.BytesIO(solid(curve, kind)), file_type=kind)
    mesh = read.to_mesh() if kind == "3mf" else read
    mesh.merge_vertices(digits_vertex=5)
    assert mesh.body_count == 2
    assert mesh.is_watertight
    made = sum(trimesh.Trimesh(part.points, part.faces).volume for part in wire(curve))
    assert mesh.volume == pytest.approx(made, rel=1e-4)


def test_motions_have_one_mesh_and_their_ends(recorded):
    shown = motion(recorded, 7)
    assert 4 <= len(shown.curves) == len(shown.energies) <= 7
    assert len({curve.mesh for curve in shown.curves}) == 1
    first = np.load(recorded)["stage_000"][0]
    gaps = np.linalg.norm(shown.curves[0].vertices[:, None] - first, axis=2).min(axis=1)
    assert gaps.max() < np.linalg.norm(np.diff(first, axis=0), axis=1).max()
    steps = [np.linalg.norm(b.vertices - a.vertices, axis=1).max() for a, b in pairwise(shown.curves)]
    assert max(steps) < 0.5 * np.ptp(first, axis=0).max()  # no point jumps along the curve
    assert len(motion(recorded, 500).curves) > 7


def test_gltf_is_read_by_others(recorded, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    shown = motion(recorded, 5)
    data = animation(shown)
    scene = trimesh.load(io.BytesIO(data), file_type="glb")
    assert len(scene.geometry) == 2
    length = struct.unpack("<I", data[12:16])[0]
    document = json.loads(data[20 : 20 + length])
    assert [len(mesh["primitives"][0]["targets"]) for mesh in document["meshes"]] == [len(shown.curves) - 1] * 2
    assert len(document["animations"][0]["channels"]) == 2
    assert struct.unpack("<I", data[8:12])[0] == len(data)
    bpy = pytest.importorskip("bpy")  # which reads the frames as shape keys
    (tmp_path / "a.glb").write_bytes(data)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(tmp_path / "a.glb"))
    meshes = [each for each in bpy.data.objects if each.type == "MESH"]
    assert [len(each.data.shape_keys.key_blocks) for each in meshes] == [len(shown.curves)] * 2
    corners = np.array([each.matrix_world @ v.co for each in meshes for v in each.data.vertices])
    points = shown.curves[0].vertices
    assert corners.min(axis=0) == pytest.approx(points.min(axis=0), abs=1.5 * shown.radius)
    assert corners.max(axis=0) == pytest.approx(points.max(axis=0), abs=1.5 * shown.radius)


def test_figures_have_a_slider_and_the_energy(recorded):
    pytest.importorskip("plotly")
    moving = motion(recorded, 6)
    made = figure(moving)
    assert [trace.type for trace in made.data] == ["mesh3d", "mesh3d", "scatter", "scatter"]
    assert len(made.frames) == len(made.layout.sliders[0].steps) == len(moving.curves) > 3
    alone = figure(still(Curve([[0.0, 0], [1, 0], [1, 1]])))
    assert [trace.type for trace in alone.data] == ["mesh3d"]
    result = minimize(knot("3_1", 40), RelaxOptions(max_iterations=3))
    shown = result.show()
    assert [trace.type for trace in shown.data] == ["mesh3d", "scatter"]
    assert tuple(shown.data[1].y) == result.energies
    rope = knot("overhand", 60).vertices
    away = rope[:1] + 99.0 * (rope[:1] - rope[1:2])
    whole, longer = (figure(still(Curve.from_components([each], [False]))) for each in (rope, np.append(away, rope, 0)))
    one, other = (np.diff(each.layout.scene.xaxis.range) for each in (whole, longer))
    assert other < 2.0 * one  # its ends leave the picture


def test_what_cannot_be_shown_is_refused(tmp_path):
    with pytest.raises(CurveError, match="dimension 4"):
        still(Curve(np.eye(4)))
    with pytest.raises(MobiusFlowError, match="none"):
        motion(tmp_path / "none.npz")
    frame = np.ones((1, 4, 3))
    np.savez(tmp_path / "point.npz", stage_000=frame, component_sizes_000=[4])
    with pytest.raises(MobiusFlowError, match="point"):
        motion(tmp_path / "point.npz")


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_a_drawing_shows_what_is_in_front(mirror):
    """Its crossings, of lines that come later over earlier ones, have the signs of the curve's."""
    shades = re.findall(r"rgb\((\d+),(\d+),(\d+)\)", drawing(knot("hopf")))
    assert {int(blue) > int(red) for red, _, blue in shades} == {True, False}  # components have colours of their own
    curve = knot("3_1")
    curve = curve.with_vertices(curve.vertices * [1.0, 1.0, mirror])
    numbers = re.findall(r'x1="(\S+)" y1="(\S+)" x2="(\S+)" y2="(\S+)" stroke="rgb', drawing(curve))
    segments = np.array(numbers, dtype=float).reshape(-1, 2, 2) * [1.0, -1.0]
    signs = []
    for k, (a, b) in enumerate(segments):
        u, v = b - a, segments[:k, 1] - segments[:k, 0]
        w, cross = segments[:k, 0] - a, u[0] * v[:, 1] - u[1] * v[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            s, t = ((w[:, 0] * d[..., 1] - w[:, 1] * d[..., 0]) / cross for d in (v, u))
        signs += np.sign(cross[(s > 0.1) & (s < 0.9) & (t > 0.1) & (t < 0.9)]).tolist()
    assert signs
    assert set(signs) == {np.sign(writhe_and_crossings(curve)[0])}


def test_notebooks_get_a_picture_beside_the_figure(monkeypatch):
    pytest.importorskip("plotly")
    import plotly.io as pio

    shown = []
    display = SimpleNamespace(display=lambda bundle, raw: shown.append(bundle))
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    monkeypatch.setattr(pio.renderers, "default", "plotly_mimetype")
    figure(still(knot("3_1")))._ipython_display_()
    assert set(shown[0]) == {"application/vnd.plotly.v1+json", "image/svg+xml"}
    assert shown[0]["image/svg+xml"].startswith("<svg ")


WIDTH, HEIGHT = 280.0, 120.0
CIRCLE = Target(4.0, "circle = 4")


def heights(energies, target=None):
    return plot(energies, target, WIDTH, HEIGHT)


@pytest.mark.parametrize("count", [1, 2, 3, 50, 5000])
@pytest.mark.parametrize("target", [None, CIRCLE], ids=["no target", "target"])
def test_all_of_it_is_inside(count, target):
    energies = 4 + 1000 * 0.9 ** np.arange(count)
    line, level = heights(energies, target)
    x, y = line.T
    assert x[0] == 0
    assert x[-1] == (WIDTH if count > 1 else 0)
    assert (np.diff(x) > 0).all()
    assert ((y > 0) & (y < HEIGHT)).all()
    assert len(x) <= min(count, 2 * WIDTH)
    assert (level is None) == (target is None)


def test_energies_go_down_on_the_screen_to_the_target_or_stay_above_it():
    line, level = heights([900.0, 30.0, 5.0, 4.0], CIRCLE)
    assert (np.diff(line[:, 1]) < 0).all()
    assert line[-1, 1] == pytest.approx(level)
    line, level = heights([100.0, 80.0], CIRCLE)
    assert level < line[:, 1].min()


@pytest.mark.parametrize(("energies", "share"), [([1000.0, 100.0, 10.0], 0.5), ([9.0, 5.0, 4.0], 0.2)])
def test_decades_are_logarithmic_and_less_is_linear(energies, share):
    y = heights(energies)[0][:, 1]
    assert (y[1] - y[2]) / (y[0] - y[2]) == pytest.approx(share)


@pytest.mark.parametrize("energies", [[5.0, 5.0, 5.0], [0.0, 0.0], [7.0, 0.0], [30.0, -2.0]], ids=str)
def test_energies_of_any_kind_have_a_place(energies):
    y = heights(energies)[0][:, 1]
    assert np.isfinite(y).all()
    assert ((y > 0) & (y < HEIGHT)).all()
