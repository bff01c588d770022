"""What there is to carry: files, lines by room, constants, arrows between rooms, functions too long, words.

python tools/weight.py [REVISION ...]     one column a revision (default: the working tree)
"""

import ast
import importlib.util
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PRODUCT = ("core", "cli", "addon")
SMALL, LONG = 60, 50  # lines of a file, of a function


def weights(root: Path) -> dict[str, object]:
    """The figures of a checkout, each under its name."""
    files = {path: path.read_text(encoding="utf-8") for top in PRODUCT for path in sorted((root / top).rglob("*.py"))}
    trees = [ast.parse(text) for text in files.values()]
    lines = {path: text.count("\n") for path, text in files.items()}
    functions = [length for tree in trees for length in _function_lengths(tree)]
    rooms = _import_map(root)
    return {
        "product: files": len(files),
        "product: lines": sum(lines.values()),
        **{f"  {top}": sum(n for path, n in lines.items() if path.is_relative_to(root / top)) for top in PRODUCT},
        f"files under {SMALL} lines": sum(n < SMALL for n in lines.values()),
        "longest file": max(lines.values()),
        "median function": statistics.median(functions),
        f"functions over {LONG} lines": sum(n > LONG for n in functions),
        "numeric constants of modules": sum(map(_constants, trees)),
        "rooms": len(rooms),
        "arrows between rooms": sum(map(len, rooms.values())),
        "tests: files": len(list((root / "tests").rglob("*.py"))),
        "tests: lines": sum(path.read_text(encoding="utf-8").count("\n") for path in (root / "tests").rglob("*.py")),
        "README: words": len((root / "README.md").read_text(encoding="utf-8").split()),
        "CHANGELOG: words": len((root / "CHANGELOG.md").read_text(encoding="utf-8").split()),
    }


def _function_lengths(tree: ast.AST) -> Iterator[int]:
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.end_lineno - node.lineno + 1


def _constants(tree: ast.Module) -> int:
    """Names in capitals to which a module assigns numbers, or tuples of them."""
    found = 0
    for node in tree.body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None and _is_numeric(node.value):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            names = [each for target in targets for each in ast.walk(target) if isinstance(each, ast.Name)]
            found += sum(each.id.isupper() for each in names)
    return found


def _is_numeric(node: ast.expr) -> bool:
    if isinstance(node, ast.Tuple):
        return all(map(_is_numeric, node.elts))
    if isinstance(node, ast.BinOp):
        return _is_numeric(node.left) and _is_numeric(node.right)
    if isinstance(node, ast.UnaryOp):
        return _is_numeric(node.operand)
    return isinstance(node, ast.Constant) and isinstance(node.value, int | float) and not isinstance(node.value, bool)


def _import_map(root: Path) -> dict[str, frozenset[str]]:
    spec = importlib.util.spec_from_file_location("import_map", Path(__file__).with_name("import_map.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.import_map(root)


def _at(revision: str, then: Callable[[Path], dict[str, object]]) -> dict[str, object]:
    """The figures of a revision, unpacked for the moment."""
    with tempfile.TemporaryDirectory() as folder:
        archive = subprocess.run(["git", "archive", revision], cwd=ROOT, check=True, capture_output=True).stdout
        subprocess.run(["tar", "-x", "-C", folder], input=archive, check=True)
        return then(Path(folder))


def main(revisions: list[str]) -> None:
    """Print the table."""
    columns = [_at(revision, weights) for revision in revisions] or [weights(ROOT)]
    print("| |" + "|".join(revisions or ["now"]) + "|\n|---|" + "---|" * len(columns))
    for name in columns[0]:
        print(f"| {name} | " + " | ".join(str(column[name]) for column in columns) + " |")


if __name__ == "__main__":
    main(sys.argv[1:])
