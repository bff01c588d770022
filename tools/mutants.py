"""Break the program on purpose, in one place at a time, and see that the test which names the behaviour fails.

    python tools/mutants.py            all of them
    python tools/mutants.py NAME …     some of them

The changes are in ``mutations/``: what stands once in a file, what takes its place, and the test that must notice.
Works on a copy; exit status 1 if a mutant survives, or if a test fails without any.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]


class Mutant(NamedTuple):
    """One change, and the test that must notice it."""

    file: str
    name: str
    old: str
    new: str
    test: str


def mutants() -> Iterator[Mutant]:
    """Read them all, sorted by the files that they change."""
    for path in sorted((ROOT / "tools/mutations").glob("*.toml")):
        for file, changes in tomllib.loads(path.read_text(encoding="utf-8")).items():
            yield from (Mutant(file, **change) for change in changes)


def main(names: Sequence[str]) -> int:
    """Try the mutants with these names, or all."""
    chosen = [mutant for mutant in mutants() if not names or mutant.name in names]
    if unknown := set(names) - {mutant.name for mutant in chosen}:
        raise SystemExit(f"no mutant is called {', '.join(sorted(unknown))}; see tools/mutations")
    with tempfile.TemporaryDirectory() as work:
        copy = Path(work) / "mobius_flow"
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(".*", "build", "__pycache__", "*.egg-info"))
        if not passes(copy, sorted({mutant.test for mutant in chosen})):
            print("tests fail without any mutant")
            return 1
        survivors = [mutant.name for mutant in chosen if not killed(copy, mutant)]
    print(f"{len(chosen) - len(survivors)} of {len(chosen)} mutants killed")
    return 1 if survivors else 0


def killed(copy: Path, mutant: Mutant) -> bool:
    """Whether the mutant's test fails with the change."""
    file = copy / mutant.file
    original = file.read_text(encoding="utf-8")
    if original.count(mutant.old) != 1:
        raise SystemExit(f"{mutant.name}: {mutant.file} does not have {mutant.old!r} once")
    file.write_text(original.replace(mutant.old, mutant.new), encoding="utf-8")
    survived = passes(copy, [mutant.test])
    file.write_text(original, encoding="utf-8")
    print(f"{'SURVIVED' if survived else 'killed'}  {mutant.name}", flush=True)
    return not survived


def passes(copy: Path, tests: Sequence[str]) -> bool:
    """Whether tests pass in the copy, which takes precedence over an installed package."""
    environment = {**os.environ, "PYTHONPATH": str(copy.parent), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pytest", "--slow", "-q", "-x", "-p", "no:cacheprovider", *tests]
    return subprocess.run(command, cwd=copy, env=environment, capture_output=True, check=False).returncode == 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
