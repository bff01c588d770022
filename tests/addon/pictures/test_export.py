"""Scenes, pictures and films of a relaxation, whole or not at all."""

import builtins
import os
import sys

import bpy
import numpy as np
import pytest
from blender_scenes import evaluated, in_world
from mobius_flow.addon.pictures import export, movie, rendering
from mobius_flow.core import Curve, MobiusFlowError, RelaxOptions, relax
from mobius_flow.core.keys.key_options import Playing
from mobius_flow.core.knots import knot
from processes import finished
from shapes import regular_polygon, torus_trefoil

TINY = (64, 36)
WRITERS = [export.write_blend, export.write_still, export.write_movie]


@pytest.fixture
def tiny(monkeypatch):
    """Small and short pictures and films."""
    monkeypatch.setattr(export, "_PICTURE", TINY)
    monkeypatch.setattr(export, "_FILM_WITHOUT_DRIVER", (*TINY, 1))
    monkeypatch.setattr(export, "_FILM_SAMPLES", 1)
    monkeypatch.setattr(export, "_FILM", TINY)
    monkeypatch.setattr(rendering, "workbench_works", lambda: False)
    for name, value in (("MOVING", (4, 4)), ("RESTS", (1, 1))):
        monkeypatch.setattr(Playing, name, value)


def iterates_of(curve, **options):
    return list(relax(curve, RelaxOptions(**({"max_iterations": 6} | options))))


@pytest.fixture(scope="module")
def iterates():
    return iterates_of(torus_trefoil(40))


FRESH = """
import bpy, sys
sys.modules["mobius_flow"] = None
assert not hasattr(bpy.types.Scene, "mobius_flow")
bpy.ops.wm.open_mainfile(filepath=sys.argv[1] + "/a.blend")
scene = bpy.context.scene
scene.frame_set(scene.frame_end)
obj = bpy.data.objects["Curve"]
obj.data.bevel_depth = 0
mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
print("points", *[x for vertex in mesh.vertices for x in vertex.co])
scene.render.resolution_x, scene.render.resolution_y, scene.cycles.samples = 32, 18, 1
scene.render.filepath = sys.argv[1] + "/a.png"
bpy.ops.render.render(write_still=True)
"""


def test_a_film_of_a_rope_looks_at_its_knot_and_shows_its_ends_to_the_end():
    rope = knot("bowline", 100)
    ends = rope.vertices[[0, -1]] + 60.0 * (rope.vertices[[0, -1]] - rope.vertices[[1, -2]])
    parts = [np.concatenate([ends[:1], rope.vertices, ends[1:]])]
    iterates = iterates_of(Curve.from_components(parts, [False]), max_iterations=0, mesh="fixed")
    scene, certified = export._played(iterates, lambda scene: None, export.ONCE)
    assert certified
    (spline,) = bpy.data.objects["Curve"].data.splines
    assert not spline.use_cyclic_u
    size = np.linalg.norm(np.ptp([point.co[:3] for point in spline.points], axis=0))
    away = scene.camera.matrix_world.translation - bpy.data.objects["Focus"].matrix_world.translation
    assert away.length < 1.2 * size


def test_a_scene_needs_no_add_on(tmp_path, iterates):
    export.write_blend(tmp_path / "a.blend", iterates)
    done = finished([sys.executable, "-c", FRESH, str(tmp_path)])
    assert done.returncode == 0, done.stderr
    (line,) = [line for line in done.stdout.splitlines() if line.startswith("points")]
    points = np.array(line.split()[1:], dtype=float).reshape(-1, 3)
    np.testing.assert_allclose(points, iterates[-1].curve.vertices, atol=1e-6)
    assert (tmp_path / "a.png").stat().st_size > 100


@pytest.mark.parametrize(("scale", "shift"), [(1.0, 0.0), (1e-9, 0.0), (1e6, 0.0), (1.0, 5000.0)])
def test_a_scene_plays_the_relaxation_in_its_place_and_size(tmp_path, scale, shift):
    iterates = iterates_of(Curve(scale * (torus_trefoil(40).vertices + shift)), max_iterations=2)
    assert export.write_blend(tmp_path / "a.blend", iterates)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    obj, scene = bpy.data.objects["Curve"], bpy.context.scene
    radii = {point.radius for key in obj.data.shape_keys.key_blocks for point in key.data}
    thick = obj.data.bevel_depth * obj.matrix_world.to_scale().x
    assert (radii, thick) == ({1.0}, pytest.approx(iterates[-1].radius[0], rel=0.01)), "it is the rope"
    assert scene.camera
    assert obj.data.materials
    obj.data.bevel_depth = 0
    for frame, iterate in ((scene.frame_start, iterates[0]), (scene.frame_end, iterates[-1])):
        points = in_world(obj, evaluated(obj, frame))
        np.testing.assert_allclose(points, iterate.curve.vertices, atol=scale * (1e-5 + 1e-7 * shift))


def test_a_film(tmp_path, tiny, iterates, capfd):
    seen = []
    assert export.write_movie(tmp_path / "a.mp4", iterates, lambda *counts: seen.append(counts))
    scene = bpy.context.scene
    count = (scene.frame_end - scene.frame_start) // scene.frame_step + 1
    assert seen == [(k + 1, count) for k in range(count)]
    clip = bpy.data.movieclips.load(str(tmp_path / "a.mp4"))
    assert (tuple(clip.size), clip.frame_duration) == (TINY, count)
    assert os.listdir(tmp_path) == ["a.mp4"]
    assert capfd.readouterr().out == ""


@pytest.mark.parametrize("write", WRITERS)
def test_what_cannot_be_written_is_said_in_one_line(tmp_path, tiny, iterates, write):
    others = iterates_of(torus_trefoil(41), max_iterations=1)
    thick = iterates_of(regular_polygon(30, dimension=4), max_iterations=1)
    for made, place, said in (
        (thick, "a.out", "4 coordinates"),
        (iterates + others, "a.out", "a change to another curve"),
        (iterates, "nowhere/a.blend", "cannot be written: the directory"),
    ):
        with pytest.raises(MobiusFlowError, match=said) as error:
            write(tmp_path / place, made)
        assert "\n" not in str(error.value)
        assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("module", "function", "name"),
    [
        (rendering, "save", "write_blend"),
        (rendering, "render_still", "write_still"),
        (movie, "render_movie", "write_movie"),
    ],
)
def test_what_blender_cannot_write_leaves_the_old_file(tmp_path, tiny, iterates, monkeypatch, module, function, name):
    def fail(*_arguments, **_options):
        raise RuntimeError("Error: no space left\n")

    monkeypatch.setattr(module, function, fail)
    target = tmp_path / "a.blend"
    target.write_text("old")
    with pytest.raises(MobiusFlowError, match="no space left"):
        getattr(export, name)(target, iterates)
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.blend"]


def test_lines_of_drivers_are_kept_out(capfd):
    with rendering.quiet():
        os.write(1, b"Blender\n")
        os.write(2, b"EGL Error\n")
    os.write(2, b"ours\n")
    assert capfd.readouterr() == ("", "ours\n")


MISSING = [
    (ModuleNotFoundError, "pip install bpy,"),
    (ImportError("libEGL.so.1: cannot open"), "cannot be loaded: libEGL.so.1"),
]


@pytest.mark.parametrize(("error", "said"), MISSING)
def test_a_missing_module_and_a_missing_library_of_it(monkeypatch, error, said):
    def importing(name, *arguments):
        if name == "bpy":
            raise error
        return real(name, *arguments)

    real = builtins.__import__
    monkeypatch.setattr(builtins, "__import__", importing)
    with pytest.raises(MobiusFlowError, match=said):
        export.require_blender()


def test_a_film_that_loops_ends_where_it_begins(iterates, tmp_path, monkeypatch):
    monkeypatch.setattr(rendering, "workbench_works", lambda: True)
    monkeypatch.setattr(Playing, "MOVING", (6, 6))
    monkeypatch.setattr(movie, "render_movie", lambda _scene, path, _progress: path.touch())
    export.write_movie(tmp_path / "a.mp4", iterates, None, Playing(loop=True, constant_radius=True))
    scene, (curve,) = bpy.context.scene, [obj for obj in bpy.data.objects if obj.type == "CURVE"]
    half = 6 + 6 + 12
    assert (scene.frame_start, scene.frame_end) == (1, 2 * half)
    assert len({point.radius for block in curve.data.shape_keys.key_blocks for point in block.data}) == 1
    for k in (0, 7, 9, half):
        times, places = [], []
        for frame in (1 + k, 1 + 2 * half - k):
            scene.frame_set(frame)
            times.append(curve.data.shape_keys.eval_time)
            places.append(tuple(scene.camera.matrix_world.translation))
        assert times[0] == pytest.approx(times[1], abs=1e-4)
        assert places[0] == pytest.approx(places[1], abs=1e-4)
