"""Which room of the house imports which, read from the sources.

A room is a package directly below `core`, `addon` or `cli`, with everything in it, or a module there on its
own. The files of curves are a separate room: they hold codes of knots, which are made of curves. Imports inside
functions and those for type checkers count like the others: whoever reads a file has to know what it names.

    python tools/import_map.py         the map as Graphviz draws it
"""

import ast
from collections import defaultdict
from collections.abc import Iterator, Mapping
from graphlib import TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
Map = Mapping[str, frozenset[str]]
INNER = ("core.curve.io",)  # rooms within rooms


class _AtRunTime(ast.NodeTransformer):
    """Removes imports that only type checkers see."""

    def visit_If(self, node: ast.If) -> ast.AST | list[ast.stmt]:
        return node.orelse if isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING" else node


def imports(path: Path, root: Path = ROOT, *, types: bool = True) -> Iterator[str]:
    """The dotted names that a module imports; those of the package start with its directory, as in ``core.curve``.

    ``types``: whether imports for type checkers count.
    """
    package = path.relative_to(root).parts[:-1]
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree if types else _AtRunTime().visit(tree)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = [*package[: len(package) - node.level + 1], *(node.module or "").split(".")] if node.level else []
            start = ".".join(filter(None, base)) if node.level else str(node.module)
            yield from (f"{start}.{alias.name}" if start else alias.name for alias in node.names)


def room(name: str, root: Path = ROOT) -> str | None:
    """The room of a dotted name; None outside the house, ``core`` for names that `core` itself provides."""
    for inner in INNER:
        if f"{name}.".startswith(f"{inner}."):
            return inner
    first, *rest = name.split(".")
    if first in ("addon", "cli") and (root / first).is_dir():
        return first
    if first != "core":
        return None
    known = rest and ((root / "core" / rest[0]).is_dir() or (root / "core" / f"{rest[0]}.py").is_file())
    return f"core.{rest[0]}" if known else "core"


def import_map(root: Path = ROOT) -> Map:
    """The rooms, and the other rooms that each of them imports."""
    found: dict[str, set[str]] = defaultdict(set)
    for top in ("core", "addon", "cli"):
        for path in sorted((root / top).rglob("*.py")):
            here = room(".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__"), root)
            assert here is not None
            found[here] |= {there for name in imports(path, root) if (there := room(name, root)) not in (None, here)}
    return {name: frozenset(found[name]) for name in sorted(found)}


def reachable(rooms: Map, start: str) -> set[str]:
    """The rooms that a chain of imports leads to."""
    seen: set[str] = set()
    open_ends = [start]
    while open_ends:
        for there in rooms[open_ends.pop()] - seen:
            seen.add(there)
            open_ends.append(there)
    return seen


def drawn(rooms: Map) -> str:
    """A Graphviz graph, importers above; implied arrows are left out. Raises CycleError."""
    order = list(TopologicalSorter({name: sorted(rooms[name]) for name in rooms}).static_order())[::-1]
    beyond = {name: reachable(rooms, name) for name in rooms}
    lines = ["digraph rooms {", '    node [shape=plain, fontname="sans-serif", fontsize=11];']
    for name in order:
        direct = {there for there in rooms[name] if not any(there in beyond[other] for other in rooms[name])}
        lines += [f'    "{name}" -> "{there}";' for there in sorted(direct)]
    return "\n".join([*lines, "}"])


if __name__ == "__main__":
    print(drawn(import_map()))
