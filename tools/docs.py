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
from mobius_flow.cli.options import flag
from mobius_flow.cli.parser import COMMANDS, add_to, joined
from mobius_flow.core import METHODS, RelaxOptions
from mobius_flow.core.base.arguments import declared
from mobius_flow.core.energies import ENERGIES
from mobius_flow.core.io import FORMATS
from mobius_flow.core.solve.metrics import METRICS

ROOT = Path(__file__).resolve().parents[1]
_REGION = re.compile(r"(?<=<!-- generated: )(\w+)( -->\n)(.*?)(?=<!-- end -->)", re.DOTALL)


def energies() -> str:
    """The available energies."""
    rows = [(f"`{name}`", each.description, f"{each.scale_exponent:g}") for name, each in ENERGIES.items()]
    return _table(("name", "what it is", "scaling exponent"), rows)


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
        rows.append((link, _typeset(each.description)))
    return _table(("name", "what it is"), rows)


def options() -> str:
    """The options of a relaxation, as on the command line."""
    rows = []
    for each in declared(RelaxOptions):
        plain = each.kind is bool or each.repeated
        default = "" if plain else f" (default: {each.automatic or each.default})"
        rows.append((_code(flag(each), "" if each.kind is bool else each.metavar), each.phrase + default))
    return _definitions(rows)


def commands() -> str:
    """What else the subcommands take: the options of several, then those of one alone."""
    elsewhere = {each.name for each in declared(RelaxOptions)} | {"format", "json", "output"}  # told in words
    takers: dict[str, list[str]] = {}
    texts: dict[str, str] = {}
    for name in (*COMMANDS, *joined()):
        alone = argparse.ArgumentParser(prog=f"mobius-flow {name}", add_help=False)
        add_to(alone, name)
        for each in alone._actions:
            if each.option_strings and each.dest not in elsewhere and each.help not in (None, argparse.SUPPRESS):
                option = _code(max(each.option_strings, key=len), str(each.metavar or ""))
                takers.setdefault(option, []).append(f"`{name}`")
                texts.setdefault(option, str(each.help))
    several = [(f"{one} ({', '.join(names)})", texts[one]) for one, names in takers.items() if len(names) > 1]
    sections = {"Several commands": several}
    for name in (*COMMANDS, *joined()):
        sections[f"`{name}`"] = [(one, texts[one]) for one, names in takers.items() if names == [f"`{name}`"]]
    return "".join(f"### {title}\n\n{_definitions(rows)}" for title, rows in sections.items() if rows)


def formats() -> str:
    """The formats of curve files."""
    suffixes: dict[str, list[str]] = {}
    for suffix, form in FORMATS.items():
        suffixes.setdefault(form.description, []).append(f"`{suffix}`")
    return _table(("suffix", "what the file holds"), [(", ".join(names), text) for text, names in suffixes.items()])


def rooms() -> str:
    """The import map of the rooms."""
    return f"```text\n{drawn(import_map(ROOT))}\n```\n"


RENDERERS: Mapping[str, Callable[[], str]] = MappingProxyType(
    {each.__name__: each for each in (energies, metrics, methods, options, commands, formats, rooms)}
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


def _definitions(rows: Iterable[tuple[str, str]]) -> str:
    """A list of terms and their meanings, which fits on a telephone's screen too."""
    return "".join(f"{term}\n: {text[0].upper()}{text[1:]}.\n\n" for term, text in rows)


def _code(*words: str) -> str:
    return f"`{' '.join(filter(None, words))}`"


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
