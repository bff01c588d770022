"""What there is to carry: files, lines, functions, names, constants, arrows between rooms, words.

python tools/weight.py [REVISION ...]     one column a revision (default: the working tree)
"""

import ast
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import fmean, median

from import_map import import_map

ROOT = Path(__file__).resolve().parents[1]
PRODUCT = ("core", "cli", "addon")
SMALL, LONG = 60, 80  # lines of a file, of a function
Function = ast.FunctionDef | ast.AsyncFunctionDef


def weights(root: Path) -> dict[str, object]:
    """The figures of a checkout, each under its name; functions, names and constants are those of product and lab."""
    texts = {
        top: {path: path.read_text(encoding="utf-8") for path in sorted((root / top).rglob("*.py"))}
        for top in (*PRODUCT, "lab", "tests", "tools", "benchmarks")
    }
    lines = {top: {path: text.count("\n") for path, text in files.items()} for top, files in texts.items()}
    total = {top: sum(each.values()) for top, each in lines.items()}
    product = [n for top in PRODUCT for n in lines[top].values()]
    trees = [ast.parse(text) for top in (*PRODUCT, "lab") for text in texts[top].values()]
    nodes = [node for tree in trees for node in ast.walk(tree)]
    functions = [node for node in nodes if isinstance(node, Function)]
    bodies = [_body(function) for function in functions]
    classes = Counter(node.name for node in nodes if isinstance(node, ast.ClassDef))
    twice = sorted(name for name, count in classes.items() if count > 1)
    rooms = import_map(root)
    return {
        "product: files": len(product),
        "product: lines": sum(product),
        **{f"  {top}": total[top] for top in PRODUCT},
        "lab: files": len(lines["lab"]),
        "lab: lines": total["lab"],
        f"files under {SMALL} lines": sum(n < SMALL for n in product),
        "longest file": max(product),
        "mean body": f"{fmean(bodies):.1f}",
        "median body": median(bodies),
        f"functions over {LONG} lines": sum(node.end_lineno - node.lineno + 1 > LONG for node in functions),
        "private functions used once": sum(map(_used_once, trees)),
        "numeric constants of modules": sum(map(_constants, trees)),
        "rooms": len(rooms),
        "arrows between rooms": sum(map(len, rooms.values())),
        "tests: files": len(lines["tests"]),
        "tests: lines": total["tests"],
        "tools and benchmarks: lines": total["tools"] + total["benchmarks"],
        "README: words": len((root / "README.md").read_text(encoding="utf-8").split()),
        "CHANGELOG: words": len((root / "CHANGELOG.md").read_text(encoding="utf-8").split()),
        "names of several classes": f"{len(twice)}: {', '.join(twice)}",
    }


def _body(function: Function) -> int:
    """Lines of a function without its head and its docstring."""
    body = function.body[1:] if ast.get_docstring(function) and len(function.body) > 1 else function.body
    return body[-1].end_lineno - body[0].lineno + 1


def _used_once(tree: ast.Module) -> int:
    """Private functions and methods whose names a module reads exactly once."""
    nodes = list(ast.walk(tree))
    used = Counter(node.id for node in nodes if isinstance(node, ast.Name))
    used.update(node.attr for node in nodes if isinstance(node, ast.Attribute))
    names = {node.name for node in nodes if isinstance(node, Function)}
    return sum(used[name] == 1 for name in names if name.startswith("_") and not name.startswith("__"))


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


@contextmanager
def unpacked(revision: str) -> Iterator[Path]:
    """The tree of a revision, for the moment, in a folder named like the package."""
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder, "mobius_flow")
        tree.mkdir()
        archive = subprocess.run(["git", "archive", revision], cwd=ROOT, check=True, capture_output=True).stdout
        subprocess.run(["tar", "-x", "-C", tree], input=archive, check=True)
        yield tree


def main(revisions: list[str]) -> None:
    """Print the table."""
    columns = []
    for revision in revisions:
        with unpacked(revision) as tree:
            columns.append(weights(tree))
    columns = columns or [weights(ROOT)]
    print("| |" + "|".join(revisions or ["now"]) + "|\n|---|" + "---|" * len(columns))
    for name in columns[0]:
        print(f"| {name} | " + " | ".join(str(column[name]) for column in columns) + " |")


if __name__ == "__main__":
    main(sys.argv[1:])
