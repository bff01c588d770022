"""Which room of the house imports which, read from the sources.

A room is a package directly below `core`, with everything in it, and each of `addon`, `cli` and `lab`; modules directly
in `core` count as `core.base`. Imports inside functions and those for type checkers count like the others: whoever
reads a file has to know what it names.

    python tools/import_map.py         the map, room by room
"""

import ast
from collections import defaultdict
from collections.abc import Iterator, Mapping
from graphlib import TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
Map = Mapping[str, frozenset[str]]
TOPS = ("core", "addon", "cli", "lab")


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
    first, *rest = name.split(".")
    if first in TOPS[1:] and (root / first).is_dir():
        return first
    if first != "core":
        return None
    if rest and (root / "core" / rest[0]).is_dir():
        return f"core.{rest[0]}"
    return "core.base" if rest and (root / "core" / f"{rest[0]}.py").is_file() else "core"


def import_map(root: Path = ROOT) -> Map:
    """The rooms, and the other rooms that each of them imports."""
    found: dict[str, set[str]] = defaultdict(set)
    for top in TOPS:
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
    """A line for each room with those it needs, importers above; implied arrows are left out. Raises CycleError."""
    order = list(TopologicalSorter({name: sorted(rooms[name]) for name in rooms}).static_order())[::-1]
    beyond = {name: reachable(rooms, name) for name in rooms}
    lines = []
    for name in order:
        direct = {there for there in rooms[name] if not any(there in beyond[other] for other in rooms[name])}
        if direct:
            lines.append(f"{name:<{max(map(len, order))}} → {', '.join(sorted(direct))}")
    return "\n".join(lines)


if __name__ == "__main__":
    print(drawn(import_map()))
