"""An atlas of what batches found."""

import csv
import hashlib
import html
import json
import re
import shlex
import shutil
import sys
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from batch_results import write_run
from mobius_flow.addon.pictures import export
from mobius_flow.core import Curve, MobiusFlowError, RelaxOptions, minimize, read_curve, write_curve
from mobius_flow.core.collision import thickness
from mobius_flow.core.curve.symmetry import symmetries
from mobius_flow.core.knots import knot, knot_type
from mobius_flow.lab.atlas import data, entries, make
from mobius_flow.lab.batch.table import Row
from mobius_flow.lab.smooth.rest import at_rest, energy_of
from mobius_flow.lab.smooth.ropelength import ropelength_bound

HIGHER = 2.0  # energy above the least


@pytest.fixture(scope="module")
def trefoil():
    found = at_rest(minimize(knot("3_1", 90), RelaxOptions(vertices=90)).curve)
    assert found is not None
    return found


@pytest.fixture(scope="module")
def known():
    return {}


@pytest.fixture
def described_once(known, monkeypatch):
    """Describe the same minimum once for all tests: proofs of bounds take a second."""
    describe = entries._described

    def described(name, runs):
        key = name, repr([(run.row, [each.tobytes() for each in run.curve.coefficients]) for run in runs])
        return known[key] if key in known else known.setdefault(key, describe(name, runs))

    monkeypatch.setattr(entries, "_described", described)


@pytest.fixture
def results(tmp_path, trefoil, monkeypatch, described_once):
    """Two runs to the trefoil, one of them turned and mirrored, one said to be higher; and two that do not count."""
    monkeypatch.setattr(entries, "is_at_rest", lambda rest: True)
    place = tmp_path / "results"
    turned = replace(trefoil.curve, coefficients=tuple(np.roll(c, 1, axis=1) for c in trefoil.curve.coefficients))
    for start, curve, columns in (
        (1, trefoil.curve, {"type_after": "3_1", "kind": "named"}),
        (2, turned.mirrored, {"type_after": "m3_1", "kind": "drawn", "seed": 7}),
        (3, trefoil.curve, {"type_after": "3_1", "kind": "drawn", "extrapolated_energy": trefoil.energy + HIGHER}),
        (4, trefoil.curve, {"type_after": "3_1", "proved": False}),
        (5, None, {"type_after": "3_1"}),
        (6, None, {"type_after": "m3_1", "kind": "tight"}),
    ):
        known = {"extrapolated_energy": trefoil.energy, "extrapolated_energy_error": trefoil.error, "proved": True}
        polygon = (curve or trefoil.curve).polygon([100])
        write_run(place, "3_1", start, polygon, curve, **known | {"index": 0} | columns)
    write_run(place, "3_1", 7, trefoil.curve.polygon([40]), type_after="3_1", proved=True, kind="tight")
    return place


@pytest.fixture
def atlas(run, results, tmp_path):
    """Make it without pictures; what is said."""

    def make(*words, status=0):
        code, out, err = run("atlas", results, "-o", tmp_path / "atlas", "--look", "none", *words)
        assert code == status
        return out + err

    return make


def table(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_minima_are_counted_measured_and_described(atlas, tmp_path, trefoil):
    told = atlas()
    assert told.startswith(
        "✓ 1 type      from 3 runs\n  left out    1 run whose type is not proved to be one of the table: 3_1-4;"
    )
    assert "1 run without a smooth shape (run batch with --extrapolate): 3_1-5" in told
    place = tmp_path / "atlas"
    least, higher = table(place / "data/minima.csv")
    assert least["type"] == higher["type"] == "3_1"
    assert float(least["energy"]) == trefoil.energy
    assert [each["met"] for each in (least, higher)] == ["2", "1"]
    assert least["kinds"] == "named 1, drawn 1"
    assert float(least["writhe"]) > 3.3  # right-handed
    assert float(least["lower_bound"]) == pytest.approx(6.0 * np.pi + 4.0)
    assert 0.0 <= float(least["upper_bound"]) - trefoil.energy < 1e-5
    rope = trefoil.curve.polygon([100])
    assert float(least["tight_ropelength"]) == pytest.approx(rope.length / thickness(rope))
    assert float(least["ropelength_bound"]) == ropelength_bound(rope)
    assert least["command"] == "mobius-flow batch 3_1 --starts 1 --extrapolate -o results"
    (short,) = table(place / "data/atlas.csv")
    assert short["energy"] == data.rounded(trefoil.energy, trefoil.error)
    for suffix in (".vect", ".json"):
        assert knot_type(read_curve(place / f"data/curves/3_1-1{suffix}")).names == ("3_1",)
    downloaded = json.loads((place / "data/curves/3_1-1.json").read_text())
    fourier = entries.curve_of(downloaded)
    assert fourier.modes == trefoil.curve.modes
    assert energy_of(fourier, 8) == pytest.approx(downloaded["energy"])
    upright = symmetries(fourier.polygon(fourier.sizes))
    assert max(np.abs(each @ [0.0, 0.0, 1.0])[2] for each in upright.matrices[1:]) == pytest.approx(1.0)
    package = json.loads((place / "data/datapackage.json").read_text())
    for resource in package["resources"]:
        described = [field["name"] for field in resource["schema"]["fields"]]
        assert described == [*table(place / "data" / resource["path"])[0]]
    with zipfile.ZipFile(place / data.ARCHIVE) as archive:
        packed = {name.partition("/")[2]: archive.read(name) for name in archive.namelist()}
    there = [path for path in place.glob("data/**/*.*") if path != place / data.ARCHIVE]
    assert packed == {path.relative_to(place / "data").as_posix(): path.read_bytes() for path in there}
    citation = yaml.safe_load(packed["CITATION.cff"])
    assert (citation["type"], citation["license"]) == ("dataset", package["licenses"][0]["name"])
    index, page = ((place / name).read_text() for name in ("index.html", "knots/3_1.html"))
    assert 'data-name="3_1"' in index
    assert page.count('class="bar"') == 2
    assert f"{100 * HIGHER / trefoil.energy:.3f} %" in page


def test_bounds_are_those_of_the_type_that_is_proved_or_of_its_mirror_image(trefoil):
    for curve in (trefoil.curve, trefoil.curve.mirrored):
        lower, upper = entries._proved("3_1", curve) or (np.nan, np.nan)
        assert lower <= upper < lower + 1e-5
        assert upper == pytest.approx(trefoil.energy, abs=1e-5)
        assert entries._proved("4_1", curve) is None


def test_made_knots_have_the_type_of_their_name_and_files_what_is_proved():
    kinds = {"start": 2, "seed": 2, "status": "converged", "message": "", "options": "{}", "kind": "scrambled"}
    made = Row(name="m10_71", type_before="10_71 or m10_71", type_after="10_71 or m10_71", proved=False, **kinds)
    file = Row(name="5_1", type_before="5_2", type_after="5_2", proved=True, input_sha256="1f", **kinds)
    assert entries._type_of(made) == ("10_71", True)
    assert entries._type_of(file) == ("5_2", False)
    assert entries._type_of(replace(file, proved=False)) == ("", False)


def test_links_lead_to_files(atlas, tmp_path):
    atlas()
    for page in tmp_path.glob("atlas/**/*.html"):
        links = re.findall(r'(?:href|src)="(.*?)"', page.read_text())
        assert len(links) > 5
        assert [link for link in links if not (page.parent / link).is_file()] == []


def test_the_second_time_nothing_is_made(atlas, tmp_path, monkeypatch):
    atlas()
    before = {path: path.stat().st_mtime_ns for path in tmp_path.glob("atlas/**/*") if path.is_file()}
    monkeypatch.setattr(entries, "_described", None)
    atlas()
    after = {path: path.stat().st_mtime_ns for path in before}
    assert [path.name for path in before if before[path] != after[path]] == ["SHA256SUMS"]


def test_a_directory_that_is_given_twice_counts_once(atlas, run, results, tmp_path):
    twice = run("atlas", results, results / ".." / results.name, "-o", tmp_path / "atlas", "--look", "none")
    assert twice == (0, atlas(), "")


def test_checksums_are_those_of_all_files(atlas, tmp_path):
    atlas()
    lines = (tmp_path / "atlas/SHA256SUMS").read_text().splitlines()[1:]
    listed = {name: digest for digest, name in (line.split("  ") for line in lines)}
    there = {path.relative_to(tmp_path / "atlas").as_posix(): path for path in tmp_path.glob("atlas/**/*.*")}
    assert listed == {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in there.items()}


def test_what_is_new_is_added_and_what_is_gone_is_removed(atlas, results, tmp_path):
    atlas()
    shutil.rmtree(results / "3_1-3")
    (tmp_path / "atlas/mine.txt").write_text("of somebody else")
    assert atlas().startswith("✓ 1 type      from 2 runs\n")
    assert not (tmp_path / "atlas/data/curves/3_1-2.vect").exists()
    assert (tmp_path / "atlas/mine.txt").exists()


def test_interrupted_it_goes_on(atlas, tmp_path, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(make, "write_pages", interrupt)
        atlas(status=130)
    assert (tmp_path / "atlas/data/minima.csv").exists()
    monkeypatch.setattr(entries, "_described", None)
    atlas()
    assert (tmp_path / "atlas/index.html").exists()


@pytest.mark.parametrize("changed", ["data/minima.csv", "style.css"])
def test_files_that_are_changed_are_kept(atlas, tmp_path, changed):
    atlas()
    file = tmp_path / "atlas" / changed
    file.write_text("mine")
    told = atlas(status=2)
    assert "was not written by mobius-flow atlas, or has been changed since" in told
    assert str(file) in told
    assert file.read_text() == "mine"


def test_other_directories_are_left_alone(atlas, tmp_path):
    (tmp_path / "atlas").mkdir()
    (tmp_path / "atlas/letter.txt").write_text("dear")
    assert "move it, or name another directory" in atlas(status=2)
    assert [path.name for path in (tmp_path / "atlas").iterdir()] == ["letter.txt"]


@pytest.mark.parametrize("case", ["none", "empty", "without", "unproved", "edited"])
def test_results_that_are_none(run, results, tmp_path, trefoil, case):
    place = tmp_path / case
    if case != "none":
        place.mkdir()
    if case == "without":
        write_run(place, "a", 1, trefoil.curve.polygon([100]), type_after="3_1", proved=True)
    if case == "unproved":
        write_run(place, "a", 1, trefoil.curve.polygon([100]), trefoil.curve, type_after="3_1 or 9_1", proved=True)
    if case == "edited":
        report = write_run(place, "a", 1, trefoil.curve.polygon([100]), trefoil.curve) / "report.json"
        report.write_text(report.read_text().replace('"name": "a"', '"name": "b"'))
    status, out, err = run("atlas", place, "-o", tmp_path / "atlas")
    told = {
        "without": "there is nothing for an atlas: 1 run without a smooth shape (run batch with --extrapolate): a",
        "unproved": "there is nothing for an atlas: 1 run whose type is not proved to be one of the table: a",
    }.get(case, f"{place}: holds no results of mobius-flow batch")
    assert (status, out, err) == (2, "", f"mobius-flow: {told}\n")
    assert not (tmp_path / "atlas").exists()


def hopf(folder, curve):
    link = knot("hopf", 40)
    sizes = link.mesh.component_sizes
    np.savez(folder / "trajectory.npz", stage_000=link.vertices[None], component_sizes_000=sizes)


def through_itself(folder, curve):
    frames = np.stack([-curve.vertices, curve.vertices])
    np.savez(folder / "trajectory.npz", stage_000=frames, component_sizes_000=[len(curve)])


def five(folder, curve):
    cinquefoil = knot("5_1", 60)
    write_curve(folder / "curve.txt", cinquefoil)
    np.savez(folder / "trajectory.npz", stage_000=cinquefoil.vertices[None], component_sizes_000=[60])


FORGERIES: dict[str, tuple[Callable[[Path, Curve], None] | float, str]] = {
    "the motion of a link": (hopf, entries.APART),
    "a motion through itself": (through_itself, entries.CHECKED),
    "another knot": (five, entries.UNLIKE),
    "no curve": (lambda folder, curve: (folder / "curve.txt").write_text("x"), entries.APART),
    "less energy": (-4.4, entries.MOVING),
}


@pytest.mark.usefixtures("described_once")
@pytest.mark.parametrize(("forged", "reason"), FORGERIES.values(), ids=FORGERIES)
def test_reports_are_not_believed(run, tmp_path, trefoil, forged, reason):
    """Whatever a report says, whose checksum is right, of a run beside one that counts."""
    claim = trefoil.energy + (forged if isinstance(forged, float) else 0.0)
    known = {"type_after": "3_1", "proved": True, "index": 0, "extrapolated_energy_error": 4.0}
    curve = trefoil.curve.polygon([100])
    write_run(tmp_path / "r", "3_1", 1, curve, trefoil.curve, extrapolated_energy=trefoil.energy, **known)
    folder = write_run(tmp_path / "r", "3_1", 2, curve, trefoil.curve, extrapolated_energy=claim, **known)
    if callable(forged):
        forged(folder, curve)
    wrote = tmp_path / "atlas/index.html"
    said = f"✓ 1 type      from 1 run\n  left out    1 run {reason}: 3_1-2\n  wrote       {wrote}\n"
    for _ in range(2):
        assert run("atlas", tmp_path / "r", "-o", tmp_path / "atlas", "--look", "none") == (0, said, "")
    shutil.rmtree(tmp_path / "r/3_1")
    status, _, err = run("atlas", tmp_path / "r", "-o", tmp_path / "atlas", "--look", "none")
    assert (status, err) == (2, f"mobius-flow: there is nothing for an atlas: 1 run {reason}: 3_1-2\n")


def test_nothing_behind_links_is_touched(atlas, tmp_path):
    """As where somebody lists a file of yours with its checksum, and links its folder."""
    atlas()
    (tmp_path / "yours").mkdir()
    yours = tmp_path / "yours/thesis.txt"
    yours.write_text("mine")
    (tmp_path / "atlas/link").symlink_to(tmp_path / "yours")
    with (tmp_path / "atlas/SHA256SUMS").open("a") as sums:
        sums.write(f"{hashlib.sha256(b'mine').hexdigest()}  link/thesis.txt\n")
    assert "was not written by mobius-flow atlas" in atlas(status=2)
    assert yours.read_text() == "mine"


def test_commands_to_be_copied_are_quoted(run, results, tmp_path, trefoil):
    name = "$(touch X)&lt;b"
    known = {"type_after": "3_1", "proved": True, "index": 0, "input_sha256": "1f\ntouch X"}
    energies = {"extrapolated_energy": trefoil.energy, "extrapolated_energy_error": 0.1 * trefoil.error}
    write_run(tmp_path / "r", name, 1, trefoil.curve.polygon([100]), trefoil.curve, **known, **energies)
    assert run("atlas", tmp_path / "r", "-o", tmp_path / "atlas", "--look", "none")[0] == 0
    commands = re.findall(r"(?s)<pre>(.*?)</pre>", (tmp_path / "atlas/knots/3_1.html").read_text())
    for line in (line for each in commands for line in html.unescape(each).splitlines()):
        words = shlex.split(line, comments=True)
        assert words[0] == "mobius-flow"
        assert name not in line or f"results/{name}/trajectory.npz" in words


def test_pictures_are_rendered_once(run, results, tmp_path, monkeypatch):
    pytest.importorskip("bpy")
    monkeypatch.setattr(make, "LARGE", (48, 36))
    monkeypatch.setattr(make, "SMALL", (32, 24))
    words = "atlas", results, "-o", tmp_path / "atlas", "--look", "studio"
    assert run(*words)[0] == 0
    shown = sorted(path.name for path in (tmp_path / "atlas/pictures").iterdir())
    assert [name[:6] for name in shown] == ["3_1-1-", "3_1-2-"]
    assert all(f'src="pictures/{name}"' in (tmp_path / "atlas/index.html").read_text() for name in shown[:1])
    monkeypatch.setattr(export, "write_picture", None)
    assert run(*words)[0] == 0


def test_pages_need_jinja2_which_is_told_before_the_work(run, results, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "jinja2", None)
    status, _, said = run("atlas", results, "-o", tmp_path / "atlas", "--look", "none")
    assert status == 2
    assert said == 'mobius-flow: pages need jinja2: pip install jinja2 (the extra "lab")\n'
    assert not (tmp_path / "atlas").exists()


def test_without_blender_there_are_no_pictures(monkeypatch):
    def missing():
        raise MobiusFlowError("not installed")

    monkeypatch.setattr(export, "require_blender", missing)
    assert make.usable(None) == make.NO_LOOK
    with pytest.raises(MobiusFlowError, match="not installed"):
        make.usable("STUDIO")


def test_balanced_curves_may_miss_their_symmetries_by_little(trefoil, monkeypatch):
    monkeypatch.setattr(entries, "_proves", lambda: False)
    monkeypatch.setattr(entries, "balanced", lambda rest: rest)
    row = Row(name="3_1", start=1, seed=None, status="converged", message="", options="{}")
    for width, name in ((0.92, "D3"), (0.5, "C2")):
        curve = replace(trefoil.curve, coefficients=tuple(c * [1.0, width, 1.0] for c in trefoil.curve.coefficients))
        assert entries._described("3_1", [entries.AtlasRun(row, Path(), curve, "")])["symmetry"] == name


def test_bounds_are_rounded_outwards():
    known = {"upper_bound": 74.4120430000001, "lower_bound": 22.849556, "ropelength_bound": 32.745892000001}
    found = {"upper_bound": "74.412044", "lower_bound": "22.849555", "ropelength_bound": "32.745893"}
    assert data.bounds(known) == found  # of doubles, not of decimals
    assert set(data.bounds(dict.fromkeys(known)).values()) == {""}


def test_commands_of_files_have_their_hash():
    row = Row(name="5_1", start=2, seed=2, status="converged", message="", options="{}", input_sha256="1f")
    found = entries._command(row)
    assert found == "mobius-flow batch FILE --starts 2 --extrapolate -o results  # SHA-256 of FILE: 1f"


def test_energies_are_rounded_to_their_errors():
    assert [data.rounded(74.4120429, error) for error in (3e-8, 2e-3, 0.3, 1e-15)] == [
        *("74.41204290", "74.412", "74.4", "74.412042900")
    ]
