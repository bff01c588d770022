"""A release is refused unless manifest, package and changelog agree, and what is built is whole."""

import re
import shutil
import subprocess
import sys
from pathlib import Path
from runpy import run_path

import pytest
from processes import finished

ROOT = Path(__file__).resolve().parents[1]
FILES = ("blender_manifest.toml", "pyproject.toml", "__init__.py", "CITATION.cff", "CHANGELOG.md")
release = run_path(str(ROOT / "tools/release.py"))


def git(root, *words):
    identity = ("-c", "user.name=Somebody", "-c", "user.email=somebody@example.org", "-c", "commit.gpgsign=false")
    subprocess.run(["git", "-C", str(root), *identity, *words], check=True, capture_output=True)


@pytest.fixture
def checkout(tmp_path):
    """A clean checkout of what the versions stand in, with a date in the changelog."""
    for name in FILES:
        shutil.copy(ROOT / name, tmp_path)
    changelog = tmp_path / "CHANGELOG.md"
    text = changelog.read_text(encoding="utf-8")
    changelog.write_text(re.sub(r"(?m)^(## \[.+?\]).*", r"\1 - 2026-01-01", text, count=1), encoding="utf-8")
    git(tmp_path, "init", "--quiet")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "--quiet", "-m", "a release")
    return tmp_path


def change(root, name, old, new):
    """Replace a text in a file, and commit."""
    path = root / name
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    git(root, "commit", "--quiet", "-am", "changed")


def test_the_versions_of_the_project_agree():
    assert len(set(release["versions"](ROOT).values())) == 1


def test_a_release_may_be_tagged_or_not(checkout):
    assert release["objections"](checkout) == []
    git(checkout, "tag", f"v{release['versions'](checkout)['pyproject.toml']}")
    assert release["objections"](checkout) == []


@pytest.mark.parametrize("name", FILES)
def test_another_version_in_one_file_is_named(checkout, name):
    version = release["versions"](checkout)[name]
    change(checkout, name, version, "7.8.9")
    (said,) = release["objections"](checkout)
    assert f"{name} has 7.8.9" in said


def test_a_section_without_a_date_is_no_release(checkout):
    change(checkout, "CHANGELOG.md", " - 2026-01-01", "")
    (said,) = release["objections"](checkout)
    assert "YYYY-MM-DD" in said


def test_changes_that_are_not_committed(checkout):
    (checkout / "new.py").write_text("")
    assert release["objections"](checkout) == ["there are changes that are not committed"]


def test_another_tag(checkout):
    git(checkout, "tag", "v0.0.1")
    (said,) = release["objections"](checkout)
    assert "tagged v0.0.1" in said


def test_the_package_has_every_module_and_all_data(tmp_path, request):
    """And nothing of the user's: the README's first command leaves its result beside the modules."""
    pytest.importorskip("setuptools")
    result = ROOT / "relaxed.blend"
    if not result.exists():
        request.addfinalizer(result.unlink)
        result.touch()
    words = ["--quiet", "egg_info", "--egg-base", str(tmp_path), "build_py", "--build-lib", str(tmp_path / "built")]
    # as build backends do: under another name than its own
    done = finished([sys.executable, "-c", "exec(open('setup.py').read())", *words], cwd=ROOT)
    assert done.returncode == 0, done.stderr
    rooms = [path for room in ("core", "cli", "addon", "lab") for path in (ROOT / room).rglob("*")]
    wanted = {path.relative_to(ROOT) for path in rooms if path.is_file() and "__pycache__" not in path.parts}
    package = tmp_path / "built/mobius_flow"
    found = {path.relative_to(package) for path in package.rglob("*") if path.is_file()}
    assert found == wanted | {Path(name) for name in ("__init__.py", "__main__.py", "py.typed")}
