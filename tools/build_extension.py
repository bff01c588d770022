#!/usr/bin/env python3
"""Build the Blender extension: one zip for each platform, with wheels for every Python that Blender has there.

    tools/build_extension.py [--platform linux-x64] [--output dist] [--wheels DIR] [--debian]

Wheels are fetched by pip and never committed; only those with the hashes in tools/wheels.sha256 are used. The zip is
made by Blender's own command-line tool, that of the `bpy` module or of `blender`, and validated by each that is there.
"""

import argparse
import hashlib
import importlib.util
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Blender's platforms, and the parts of wheels' names that identify them
PLATFORMS = {
    "linux-x64": "manylinux2014_x86_64",
    "windows-x64": "win_amd64",
    "windows-arm64": "win_arm64",
    "macos-arm64": "macosx_12_0_arm64",
    "macos-x64": "macosx_10_",
}
DEBIAN = "-cp314-"  # the Python of Debian's Blender, which Blender's own builds do not have
ANY = "-none-any"  # wheels without compiled code
PINS = ROOT / "tools" / "wheels.sha256"
LINES = (line.split() for line in PINS.read_text(encoding="utf-8").splitlines() if line[0] != "#")
WHEELS = {name: digest for digest, name in LINES}


def main() -> int:
    """Build what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--platform", action="append", choices=PLATFORMS, help="default: all")
    parser.add_argument("--output", type=Path, default=ROOT / "dist")
    parser.add_argument("--wheels", type=Path, default=ROOT / "build" / "wheels", help="where wheels are kept")
    parser.add_argument("--debian", action="store_true", help="for Debian's Blender too, with a wheel more")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    for platform in options.platform or PLATFORMS:
        print(build(platform, options.output.resolve(), options.wheels.resolve(), options.debian))
    return 0


def build(platform: str, output: Path, wheels: Path, debian: bool = False) -> Path:
    """Build and validate the zip of one platform and return its path."""
    version = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))["version"]
    # Blender's extension tool, of the installed module, and of the program on the path
    spec = importlib.util.find_spec("bpy")
    places = spec.submodule_search_locations if spec else None
    scripts = [path for place in places or () for path in Path(place).glob("*/scripts/addons_core/bl_pkg/cli/*_ext.py")]
    tools = [[sys.executable, str(path)] for path in scripts[:1]]
    if shutil.which("blender"):
        tools.append(["blender", "--command", "extension"])
    if not tools:
        sys.exit("neither the bpy module nor blender is installed; pip install bpy")
    target = output / f"mobius_flow-{version}-{platform.replace('-', '_')}.zip"
    with tempfile.TemporaryDirectory() as room:
        stage = Path(room) / "mobius_flow"
        _stage(stage, platform, fetch_wheels(platform, wheels, debian))
        _run([*tools[0], "build", "--source-dir", str(stage), "--output-filepath", str(target)])
    for tool in tools:
        _run([*tool, "validate", str(target)])
    return target


def fetch_wheels(platform: str, wheels: Path, debian: bool = False) -> list[Path]:
    """Fetch the wheels for all Pythons of a platform, unless they are there already, exactly as pinned."""
    names = [name for name in WHEELS if PLATFORMS[platform] in name or ANY in name]
    paths = [wheels / name for name in names if debian or DEBIAN not in name]
    for path in paths:
        if not _as_pinned(path):
            _download(path)
        if not _as_pinned(path):
            sys.exit(f"{path}: not the wheel that {PINS.relative_to(ROOT)} pins; remove it and see where it came from")
    return paths


def _as_pinned(path: Path) -> bool:
    """Whether a wheel is there and has the hash listed for its name."""
    return path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() == WHEELS[path.name]


def _download(path: Path) -> None:
    """Let pip download a wheel by its name and hash."""
    distribution, version, python, _, platforms = path.stem.split("-")
    wanted = ["--only-binary", ":all:", "--no-deps"]
    if ANY not in path.name:
        wanted += [argument for tag in platforms.split(".") for argument in ("--platform", tag)]
        wanted += ["--python-version", f"{python[2]}.{python[3:]}"]
    with tempfile.TemporaryDirectory() as room:
        pinned = Path(room) / "requirements.txt"
        pinned.write_text(f"{distribution}=={version} --hash=sha256:{WHEELS[path.name]}\n", encoding="utf-8")
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--require-hashes", "--requirement", str(pinned)]
        subprocess.run([*command, *wanted, "--dest", room], check=True)
        path.parent.mkdir(parents=True, exist_ok=True)
        shutil.move(Path(room) / path.name, path)


def _stage(stage: Path, platform: str, wheels: list[Path]) -> None:
    """Copy the files that git tracks, so that nothing private or left over gets into the zip, and add the wheels."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (stage / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, stage / name)
    shutil.copy2(ROOT / "tools" / "extension.md", stage / "README.md")  # the project's own covers more
    (stage / "wheels").mkdir()
    for wheel in wheels:
        shutil.copy2(wheel, stage / "wheels")
    manifest = stage / "blender_manifest.toml"
    lines = manifest.read_text(encoding="utf-8").split("\n[", 1)  # values belong before the first table
    names = ",\n".join(f'  "./wheels/{wheel.name}"' for wheel in wheels)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    if website := project["urls"].get("Homepage"):
        lines[0] += f'\nwebsite = "{website}"'
    lines[0] += f'\nplatforms = ["{platform}"]\nwheels = [\n{names},\n]\n'
    manifest.write_text("\n[".join(lines), encoding="utf-8")


def _run(command: list[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)


if __name__ == "__main__":
    sys.exit(main())
