"""Write the parts of the documents that follow from the program: its registries, its options, its imports.

    python tools/docs.py            rewrite them
    python tools/docs.py --check    only say which are out of date; exit status 1 if one is

They stand between ``<!-- generated: NAME -->`` and ``<!-- end -->``.
"""

import argparse
import re
import sys
from collections.abc import Iterable
from fnmatch import fnmatchcase
from inspect import cleandoc
from pathlib import Path

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


def energies() -> str:
    """The available energies."""
    rows = [(f"`{name}`", each.description, f"{each.scale_exponent:g}") for name, each in ENERGIES.items()]
    return table(("name", "what it is", "scaling exponent"), rows)


def metrics() -> str:
    """The metrics, each with its inner product, taken from the first sentence of its class."""
    rows = [
        (f"`{name}`", typeset(each.description), cleandoc(str(type(each).__doc__)).splitlines()[0].removesuffix("."),
         f"{each.most_vertices:,}") for name, each in METRICS.items()
    ]  # fmt: skip
    return table(("name", "space", "⟨u, u⟩", "vertices up to"), rows)


def methods() -> str:
    """The methods, each linked to the section whose heading has its name, or a pattern that it fits."""
    page, rows = (ROOT / "docs/methods.md").read_text(encoding="utf-8"), []
    headings = re.findall(r"^## (.+: `.+)$", page, re.MULTILINE)
    for name, each in METHODS.items():
        own = (h for h in headings if any(fnmatchcase(name, pattern) for pattern in re.findall(r"`(\S+)`", h)))
        anchor = re.sub(r"[^\w -]", "", next(own, "").lower()).replace(" ", "-")  # as GitHub and MyST make them
        rows.append((f"[`{name}`](#{anchor})" if anchor else f"`{name}`", typeset(each.description)))
    return table(("name", "what it is"), rows)


def options() -> str:
    """The options of a relaxation, as on the command line."""
    rows = []
    for each in declared(RelaxOptions):
        default = "" if each.kind is bool or each.repeated else f" (default: {each.automatic or each.default})"
        option = f"{flag(each)} {'' if each.kind is bool else each.metavar}".rstrip()
        rows.append((f"`{option}`", each.phrase + default))
    return definitions(rows)


def commands() -> str:
    """What else the subcommands take: the options of several, then those of one alone."""
    takers: dict[tuple[str, str], list[str]] = {}  # by the option and what it does
    told = {each.help for each in declared(RelaxOptions)}  # with those of a relaxation
    for name in (*COMMANDS, *joined()):
        alone = argparse.ArgumentParser(prog=f"mobius-flow {name}", add_help=False)
        add_to(alone, name)
        for each in alone._actions:
            if each.option_strings and each.dest not in ("format", "json", "output"):  # which are told in words
                option = f"`{max(each.option_strings, key=len)} {each.metavar or ''}".rstrip() + "`"
                text = str(each.help or argparse.SUPPRESS)
                if text != argparse.SUPPRESS and not any(text.startswith(known) for known in told):
                    takers.setdefault((option, text % vars(each)), []).append(f"`{name}`")
    several = [(f"{one} ({', '.join(names)})", text) for (one, text), names in takers.items() if len(names) > 1]
    sections = {"Several commands": several}
    for name in (*COMMANDS, *joined()):
        sections[f"`{name}`"] = [(one, text) for (one, text), names in takers.items() if names == [f"`{name}`"]]
    return "".join(f"### {title}\n\n{definitions(rows)}" for title, rows in sections.items() if rows)


def formats() -> str:
    """The formats of curve files."""
    suffixes: dict[str, list[str]] = {}
    for suffix, form in FORMATS.items():
        suffixes.setdefault(form.description, []).append(f"`{suffix}`")
    return table(("suffix", "what the file holds"), [(", ".join(names), text) for text, names in suffixes.items()])


def rooms() -> str:
    """The import map of the rooms."""
    return f"```text\n{drawn(import_map(ROOT))}\n```\n"


def table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    """A table in Markdown."""
    lines = [head, ("---",) * len(head), *(tuple(cell.replace("|", "\\|") for cell in row) for row in rows)]
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def definitions(rows: Iterable[tuple[str, str]]) -> str:
    """A list of terms and their meanings, which fits on a telephone's screen too."""
    return "".join(f"{term}\n: {text[0].upper()}{text[1:]}.\n\n" for term, text in rows)


def typeset(text: str) -> str:
    """Spaces and metrics as formulas."""
    return re.sub(r"W\^\{.*?\}|J_C", r"$\g<0>$", text)


def main() -> int:
    """Rewrite the documents, or compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="change nothing, and name what is out of date")
    check = parser.parse_args().check
    if Path(mobius_flow.__file__).resolve().parent != ROOT:
        parser.error(f"Python imports {mobius_flow.__file__}; install this checkout instead: pip install -e .")
    made = {each.__name__: each for each in (energies, metrics, methods, options, commands, formats, rooms)}
    stale = 0
    for path in (ROOT / "README.md", *sorted(ROOT.glob("docs/**/*.md"))):
        text = path.read_text(encoding="utf-8")
        part = r"(?<=<!-- generated: )(\w+)( -->\n)(.*?)(?=<!-- end -->)"
        new = re.sub(part, lambda match: f"{match[1]}{match[2]}{made[match[1]]()}", text, flags=re.DOTALL)
        if new != text:
            stale += 1
            if not check:
                path.write_text(new, encoding="utf-8")
            what = "is out of date; python tools/docs.py mends it" if check else "rewritten"
            print(f"{path.relative_to(ROOT)} {what}")
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
