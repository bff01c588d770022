#!/usr/bin/env python3
"""Build a release into dist/, or say why there is none: manifest, package and changelog must agree.

    python tools/release.py           check, then build and check the source distribution, the wheel and the extension
    python tools/release.py --check   only check

A release is a clean checkout whose version has a dated section at the head of CHANGELOG.md, and the tag vVERSION if it
has any.
"""

import argparse
import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HEADING = re.compile(r"^## \[(?P<version>[^\]]+)\](?: - (?P<date>.+))?$", re.MULTILINE)


def versions(root: Path) -> dict[str, str]:
    """What each file says the version is."""
    heading = HEADING.search((root / "CHANGELOG.md").read_text(encoding="utf-8"))
    cited = re.search(r"^version: (.+)$", (root / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE)
    package = re.search(r'^__version__ = "(.+)"$', (root / "__init__.py").read_text(encoding="utf-8"), re.MULTILINE)
    return {
        "blender_manifest.toml": tomllib.loads((root / "blender_manifest.toml").read_text("utf-8"))["version"],
        "pyproject.toml": tomllib.loads((root / "pyproject.toml").read_text("utf-8"))["project"]["version"],
        "__init__.py": package[1] if package else "none",
        "CITATION.cff": cited[1] if cited else "none",
        "CHANGELOG.md": heading["version"] if heading else "none",
    }


def objections(root: Path) -> list[str]:
    """Why this checkout is not a release; empty if it is one."""
    found = versions(root)
    wrong = []
    if len(set(found.values())) > 1:
        wrong.append("versions differ: " + ", ".join(f"{name} has {version}" for name, version in found.items()))
    heading = HEADING.search((root / "CHANGELOG.md").read_text(encoding="utf-8"))
    if heading is None or not re.fullmatch(r"\d{4}-\d\d-\d\d", heading["date"] or ""):
        wrong.append("CHANGELOG.md gives its first version no date; write ## [X.Y.Z] - YYYY-MM-DD")
    if _git(root, "status", "--porcelain"):
        wrong.append("there are changes that are not committed")
    tags = _git(root, "tag", "--points-at", "HEAD").split()
    if tags and f"v{found['pyproject.toml']}" not in tags:
        wrong.append(f"the commit is tagged {', '.join(tags)}, not v{found['pyproject.toml']}")
    return wrong


def _git(root: Path, *words: str) -> str:
    return subprocess.run(["git", "-C", str(root), *words], check=True, capture_output=True, text=True).stdout


def main() -> int:
    """Check, and build."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="build nothing")
    only_check = parser.parse_args().check
    wrong = objections(ROOT)
    for each in wrong:
        print(f"no release: {each}", file=sys.stderr)
    if wrong or only_check:
        return 1 if wrong else 0
    python = [sys.executable, "-m"]
    subprocess.run([*python, "build", "--outdir", str(ROOT / "dist"), str(ROOT)], check=True)
    made = ROOT.glob(f"dist/mobius_flow-{versions(ROOT)['pyproject.toml']}[.-]*[lz]")
    subprocess.run([*python, "twine", "check", "--strict", *map(str, made)], check=True)
    subprocess.run([sys.executable, str(ROOT / "tools/build_extension.py")], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
