"""The extension's zip: what is in it, and that it works in a clean Blender with nothing else installed."""

import ast
import hashlib
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
PLATFORM = "linux-x64"


@pytest.fixture(scope="module")
def builder():
    """The script that builds the zip, as a module."""
    if not (ROOT / ".git").exists():
        pytest.skip("the zip is built from what git knows of")
    spec = importlib.util.spec_from_file_location("build_extension", ROOT / "tools" / "build_extension.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def empty_wheels(builder, tmp_path_factory, monkeypatch):
    """Wheels with the right names and nothing in them, pinned as such, so that none is fetched."""
    room = tmp_path_factory.mktemp("wheels")
    for name in builder.WHEELS:
        (room / name).touch()
    monkeypatch.setattr(builder, "WHEELS", dict.fromkeys(builder.WHEELS, hashlib.sha256(b"").hexdigest()))
    return room


@pytest.fixture
def archive(builder, empty_wheels, tmp_path):
    """The zip for one platform, opened."""
    with zipfile.ZipFile(builder.build(PLATFORM, tmp_path, empty_wheels)) as opened:
        yield opened


def test_only_what_blender_runs_is_in_the_zip(archive):
    files = [name for name in archive.namelist() if not name.endswith("/")]
    top = {name.split("/")[0] for name in files}
    documents = {"CHANGELOG.md", "LICENSE", "README.md"}
    assert top == {"__init__.py", "blender_manifest.toml", *documents, "addon", "core", "wheels"}
    data = [name for name in files if name.startswith(("addon/", "core/")) and not name.endswith(".py")]
    tables = [f"core/knots/{name}" for name in ("least_energies.csv", "shapes.npz", "table.ini")]
    assets = [f"addon/assets/{name}" for name in ("LICENSE.md", "assets.blend", "knots.png")]
    assert sorted(data) == [*assets, "addon/translations/de.po", *tables]
    assert not [name for name in files if "__pycache__" in name or Path(name).name.startswith(".")]
    tracked = subprocess.run(
        ["git", "ls-files", "addon", "core"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.split()
    assert set(files) >= {name for name in tracked if (ROOT / name).is_file()}
    wheels = [name.removeprefix("wheels/").split("-")[0] for name in files if name.startswith("wheels/")]
    assert sorted(wheels) == ["scipy"] * 2 + ["threadpoolctl"]  # Python 3.11 and 3.13
    text = archive.read("README.md").decode()
    links = re.findall(r"\]\(([^)]*)\)", text)
    assert links
    assert all(link in files for link in links if "://" not in link)
    assert all(f"**{button}**" in text for button in ("Add Knot", "Relax", "Render Film"))


def reviewed(path):
    """What in a module reviewers of extensions look for."""
    processes = {"concurrent", "multiprocessing", "signal", "subprocess", "threading"}
    modules = processes | {"ctypes", "pickle", "socket", "urllib"}
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        match node:
            case (
                ast.Name(id="__file__" as name)
                | ast.Call(func=ast.Name(id="eval" | "exec" | "__import__" | "open" as name))
            ):
                found.add(name)
            case ast.Attribute(value=ast.Name(id="sys"), attr="modules"):
                found.add("sys.modules")
            case ast.Import(names=names):
                found |= {each.name.partition(".")[0] for each in names} & modules
            case ast.ImportFrom(module=str(name), level=0):
                found |= {name.partition(".")[0]} & modules
    return found


def test_reviewers_are_told_all_that_they_look_for():
    text = (ROOT / "tools/extension.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`.*`) \| (`.*`) \| \S.* \|$", text, re.MULTILINE)
    told = {name: set(re.findall(r"`(.*?)`", has)) for names, has in rows for name in re.findall(r"`(.*?)`", names)}
    paths = [ROOT / "__init__.py", *ROOT.glob("addon/**/*.py"), *ROOT.glob("core/**/*.py")]
    assert told == {path.relative_to(ROOT).as_posix(): has for path in paths if (has := reviewed(path))}


def test_debians_blender_has_a_wheel_more(builder, empty_wheels, tmp_path):
    with zipfile.ZipFile(builder.build(PLATFORM, tmp_path, empty_wheels, debian=True)) as archive:
        assert len([name for name in archive.namelist() if "cp314" in name]) == 1


def test_each_platform_has_its_own_wheels(builder, empty_wheels, tmp_path):
    for platform, tag in list(builder.PLATFORMS.items())[1::2]:
        builder._stage(stage := tmp_path / platform, platform, builder.fetch_wheels(platform, empty_wheels))
        manifest = tomllib.loads((stage / "blender_manifest.toml").read_text(encoding="utf-8"))
        assert {f"./wheels/{path.name}" for path in stage.glob("wheels/*.whl")} == set(manifest["wheels"])
        assert manifest["platforms"] == [platform]
        assert {wheel.split("-")[2] for wheel in manifest["wheels"]} >= {"cp311", "cp313", "py3"}
        assert all(tag in wheel or "-none-any" in wheel for wheel in manifest["wheels"])


def test_a_wheel_is_used_only_if_its_hash_is_pinned(builder, empty_wheels, tmp_path, monkeypatch):
    """A file of the right name with something else in it is fetched again, and refused if that does not help."""
    fetched = []
    monkeypatch.setattr(builder, "_download", lambda path: (fetched.append(path), path.write_bytes(b"")))
    foreign, *others = builder.fetch_wheels(PLATFORM, empty_wheels)
    assert others
    assert not fetched
    foreign.write_bytes(b"something else")
    assert foreign in builder.fetch_wheels(PLATFORM, empty_wheels)
    assert fetched == [foreign]
    monkeypatch.setattr(builder, "_download", lambda path: path.write_bytes(b"something else again"))
    foreign.unlink()
    with pytest.raises(SystemExit, match=r"not the wheel that tools.wheels\.sha256 pins"):
        builder.build(PLATFORM, tmp_path, empty_wheels)
    assert not list(tmp_path.glob("*.zip"))


def test_pins_are_of_one_version_for_every_platform_and_python(builder):
    names = [name.split("-") for name in builder.WHEELS if "win_arm64" not in name]
    pins = {(distribution, python): {version} for distribution, version, python, *_ in names}
    for distribution, version, python, *_ in names:
        assert pins[distribution, python] == {version}
    assert {distribution for distribution, _ in pins} == {"scipy", "threadpoolctl"}
    assert all(len(digest) == 64 and int(digest, 16) for digest in builder.WHEELS.values())
    platforms = [*builder.PLATFORMS.values(), "none-any"]
    assert all(sum(tag in name for tag in platforms) == 1 for name in builder.WHEELS)


def test_it_is_validated_by_every_blender_that_is_there(builder, empty_wheels, tmp_path, monkeypatch):
    ran = []
    with monkeypatch.context() as patch:
        patch.setattr(builder, "_run", ran.append)
        patch.setattr(shutil, "which", lambda name: name)
        path = str(builder.build(PLATFORM, tmp_path, empty_wheels))
    assert [each[-1] for each in ran] == [path] * 3
    assert ran[1:] == [[*ran[0][:2], "validate", path], ["blender", "--command", "extension", "validate", path]]
    with pytest.raises(SystemExit):
        builder._run(["false"])


def test_it_is_found_among_extensions_and_the_manifest_itself_names_no_wheels():
    """As Blender's list is filtered: by what is part of the name or of the tagline."""
    from bl_pkg.bl_extension_ops import pkg_info_check_exclude_filter_ex

    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    for typed in ("mobius", "relax", "knot", "untangle"):
        assert pkg_info_check_exclude_filter_ex(manifest["name"], manifest["tagline"], typed)
    assert "wheels" not in manifest
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert project["project"]["version"] == manifest["version"]


INSTALL = """
import importlib, sys
sys.path.insert(0, sys.argv[1])
import bpy
for name in ("scipy", "mobius_flow"):
    try:
        __import__(name)
    except ImportError:
        continue
    sys.exit(f"{name} is not hidden")
bpy.ops.extensions.package_install_files(filepath=sys.argv[2], repo="user_default", enable_on_install=True)
bpy.ops.curve.mobius_flow_add_knot(knot="3_1")
bpy.context.object.data.bevel_depth = 0.0  # the mesh that is drawn has the vertices of the curve
assert bpy.ops.curve.mobius_flow_relax(max_iterations=5, length=40, fit_bevel=False) == {"FINISHED"}
import numpy as np, scipy

def keys():
    return np.array([[point.co for point in block.data] for block in shape_keys().key_blocks])

def shape_keys():
    return bpy.context.object.data.shape_keys

def timing():
    action = shape_keys().animation_data.action
    curves = action.layers[0].strips[0].channelbags[0].fcurves if hasattr(action, "layers") else action.fcurves
    return curves[0].keyframe_points

def shown(frame):
    bpy.context.scene.frame_set(int(frame), subframe=frame % 1.0)
    mesh = bpy.context.object.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return np.array([vertex.co for vertex in mesh.vertices])

written = keys()
assert len(written) >= 5
for point in timing():
    point.co[0] *= 2.0  # half as fast
frames = [point.co[0] for point in timing()]
assert frames[-1] == 80.0, frames
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[3])
bpy.ops.wm.open_mainfile(filepath=sys.argv[3])
assert np.array_equal(keys(), written)
assert np.allclose(shown(frames[0]), written[0], atol=1e-6)
assert np.allclose(shown(frames[-1]), written[-1], atol=1e-6)
print("relaxed", np.__version__, scipy.__file__)
name = next(name for name in bpy.context.preferences.addons.keys() if name.endswith("mobius_flow"))
# the worker of a run in a window, under the name that Blender gives the package
live = importlib.import_module(f"{name}.addon.engine.worker")
task = live.Task(curve=live.Curve(written[0].astype(float)))
worker = live.Worker(task, live.RelaxOptions(max_iterations=3))
assert worker.process is not None
arrived = [worker._queue.get(timeout=100) for _ in range(5)]
assert isinstance(arrived[-1], live.Outcome), arrived[-1]
worker.close()
bpy.ops.preferences.addon_disable(module=name)
assert not hasattr(bpy.types.Scene, "mobius_flow")
"""


def blender_alone(room):
    """A directory with links to Blender's module and all that is installed beside it but SciPy and us."""
    room.mkdir()
    hidden = ("scipy", "mobius", "__editable__", "_mobius", "__pycache__")
    for path in Path(np.__file__).parents[1].iterdir():
        if not path.name.startswith(hidden) and path.suffix != ".pth":
            (room / path.name).symlink_to(path)
    return room


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="installs the wheels for Linux")
def test_it_works_in_a_clean_profile(builder, tmp_path):
    archive = builder.build(PLATFORM, tmp_path, ROOT / "build" / "wheels")
    profile = tmp_path / "profile"
    done = subprocess.run(
        [
            sys.executable,
            "-I",
            "-S",
            "-c",
            INSTALL,
            str(blender_alone(tmp_path / "site")),
            str(archive),
            str(tmp_path / "a.blend"),
        ],
        env=os.environ | {"BLENDER_USER_RESOURCES": str(profile)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (line,) = [line for line in done.stdout.splitlines() if line.startswith("relaxed")]
    assert str(profile) in line
    assert "Traceback" not in done.stderr
