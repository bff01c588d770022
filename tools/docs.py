"""Write the parts of the documents that follow from the program: its registries, its options, its imports.

    python tools/docs.py            rewrite them
    python tools/docs.py --check    only say which are out of date; exit status 1 if one is

They stand between ``<!-- generated: NAME -->`` and ``<!-- end -->``.
"""

import argparse
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from fnmatch import fnmatchcase
from inspect import cleandoc
from pathlib import Path
from types import MappingProxyType

import mobius_flow
from import_map import drawn, import_map
from mobius_flow.core import METHODS, RelaxOptions
from mobius_flow.core.arguments import Option, declared
from mobius_flow.core.curve.io import FORMATS
from mobius_flow.core.energies import ENERGIES
from mobius_flow.core.metrics import METRICS

ROOT = Path(__file__).resolve().parents[1]
_REGION = re.compile(r"(?<=<!-- generated: )(\w+)( -->\n)(.*?)(?=<!-- end -->)", re.DOTALL)


def energies() -> str:
    """The available energies."""
    rows = [
        (f"`{name}`", each.description, f"{each.scale_exponent:g}", "yes" if hasattr(each, "hessian") else "no")
        for name, each in ENERGIES.items()
    ]
    return _table(("name", "what it is", "scaling exponent", "second derivative"), rows)


def metrics() -> str:
    """The metrics, each with its inner product, taken from the first sentence of its class."""
    rows = [
        (f"`{name}`", _typeset(each.description), _first_line(type(each)).removesuffix("."), f"{each.most_vertices:,}")
        for name, each in METRICS.items()
    ]
    return _table(("name", "space", "⟨u, u⟩", "vertices up to"), rows)


def methods() -> str:
    """The methods, each linked to the section whose heading names it."""
    sections = list(_sections())
    rows = []
    for name, each in METHODS.items():
        anchor = next((anchor for anchor, names in sections if _is_one_of(name, names)), "")
        link = f"[`{name}`](#{anchor})" if anchor else f"`{name}`"
        rows.append((link, _typeset(each.label), _typeset(each.description)))
    return _table(("name", "in Blender", "what it is"), rows)


def options() -> str:
    """The options of a relaxation."""
    rows = [
        (f"`{each.name}`", each.help, _default(each), "yes" if each.is_setting else "no")
        for each in declared(RelaxOptions)
    ]
    return _table(("option", "what it does", "default", "setting in Blender"), rows)


def formats() -> str:
    """The formats of curve files."""
    suffixes: dict[str, list[str]] = {}
    for suffix, form in FORMATS.items():
        suffixes.setdefault(form.description, []).append(f"`{suffix}`")
    return _table(("suffix", "what the file holds"), [(", ".join(names), text) for text, names in suffixes.items()])


def rooms() -> str:
    """The import map of the rooms."""
    return f"```{{graphviz}}\n{drawn(import_map(ROOT))}\n```\n"


RENDERERS: Mapping[str, Callable[[], str]] = MappingProxyType(
    {each.__name__: each for each in (energies, metrics, methods, options, formats, rooms)}
)


def documents() -> list[Path]:
    """The documents that may have generated parts."""
    return [ROOT / "README.md", *sorted(ROOT.glob("docs/**/*.md"))]


def regions(text: str) -> list[str]:
    """The names of the parts of a document."""
    return [match[1] for match in _REGION.finditer(text)]


def rendered(text: str) -> str:
    """A document with its parts brought up to date."""
    return _REGION.sub(lambda match: f"{match[1]}{match[2]}{RENDERERS[match[1]]()}", text)


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = [head, ("---",) * len(head), *(tuple(cell.replace("|", "\\|") for cell in row) for row in rows)]
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def _typeset(text: str) -> str:
    """Typeset spaces and metrics as formulas."""
    return re.sub(r"W\^\{.*?\}|J_C", r"$\g<0>$", text)


def _first_line(owner: type) -> str:
    return cleandoc(str(owner.__doc__)).splitlines()[0]


def _sections() -> Iterator[tuple[str, list[str]]]:
    """The anchor of each section about methods, as GitHub and MyST make it, and the names or patterns it covers."""
    for heading in re.findall(r"^## (.+: `.+)$", (ROOT / "docs/methods.md").read_text(encoding="utf-8"), re.MULTILINE):
        anchor = re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")
        yield anchor, re.findall(r"`(\S+)`", heading)


def _is_one_of(name: str, patterns: Iterable[str]) -> bool:
    return any(fnmatchcase(name, pattern) for pattern in patterns)


def _default(option: Option) -> str:
    if option.kind is bool:
        return "on" if option.default else "off"
    return option.automatic or ("none" if option.repeated else f"{option.default}")


def main() -> int:
    """Rewrite the documents, or compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="change nothing, and name what is out of date")
    check = parser.parse_args().check
    if Path(mobius_flow.__file__).resolve().parent != ROOT:
        parser.error(f"Python imports {mobius_flow.__file__}; install this checkout instead: pip install -e .")
    stale = []
    for path in documents():
        text = path.read_text(encoding="utf-8")
        if (new := rendered(text)) != text:
            stale.append(path)
            if not check:
                path.write_text(new, encoding="utf-8")
    for path in stale:
        print(f"{path.relative_to(ROOT)} {'is out of date; python tools/docs.py mends it' if check else 'rewritten'}")
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
