"""Ingredients of odd command lines: curve files and archives, damaged bytes, odd values."""

import argparse
import io
import json
import random
import re
from math import cos, pi, sin
from pathlib import Path

import numpy as np
from mobius_flow.cli.parser import add_to

ENDLESS = ["--tolerance", "1e-30", "--max-iterations", "1000000"]
SLOW = ["--method", "flow-l2", *ENDLESS]
TEXTS = (".txt", ".xyz", ".obj", ".vect", ".json")
SHORT = ["--max-iterations", "1"]


def trefoil(n: int = 24) -> list[tuple[float, float, float]]:
    """The vertices of a knot."""
    t = [2 * pi * k / n for k in range(n)]
    return [((2 + cos(3 * x)) * cos(2 * x), (2 + cos(3 * x)) * sin(2 * x), sin(3 * x)) for x in t]


def text_of(points: list[tuple[float, ...]], suffix: str) -> str:
    """A curve file."""
    rows = [" ".join(map(repr, p)) for p in points]
    n = len(rows)
    if suffix == ".obj":
        return "".join(f"v {row}\n" for row in rows) + "l " + " ".join(map(str, [*range(1, n + 1), 1])) + "\n"
    if suffix == ".vect":
        return f"VECT\n1 {n} 0\n-{n}\n0\n" + "\n".join(rows) + "\n"
    return json.dumps({"components": [points]}) if suffix == ".json" else "\n".join(rows) + "\n"


def good_file(room: Path, suffix: str = ".txt", n: int = 24) -> str:
    """Write a valid curve file and return its path."""
    path = room / f"in{suffix}"
    path.write_text(text_of(trefoil(n), suffix))
    return str(path)


def trajectory(room: Path) -> bytes:
    """An archive as `relax --trajectory` writes it, of a curve that moves aside."""
    start = np.array(trefoil())
    stream = io.BytesIO()
    np.savez(stream, stage_000=np.stack([start, start + 0.01]), component_sizes_000=np.array([len(start)]))
    return stream.getvalue()


WEIRD = [
    "nan",
    "inf",
    "-inf",
    "1e999",
    "-0",
    "9" * 5000,
    "1e308",
    "0x10",
    "٣",
    "1_0",
    "\0",
    "\ufeff",
    "é",
    "{",
    "]",
    "",
]
VALUES = [
    "",
    "-1",
    "0",
    "nan",
    "inf",
    "1e999",
    "9" * 5000,
    "x",
    "1.5",
    "--",
    "-",
    "a\nb",
    "٣",
    "\udcff",
    "1e-999",
    "🙂",
]
COMMANDS = ("relax", "energy", "info", "knot", "compare", "verify", "methods")


def options_of(command: str) -> list[str]:
    """The entries listed in a command's help."""
    parser = argparse.ArgumentParser()
    add_to(parser, command)
    return re.findall(r"^  (?:-\w, )?(--[\w-]+)", parser.format_help(), re.MULTILINE)


def command_on(rng: random.Random, path: str) -> list[str]:
    """A command that reads a curve."""
    return rng.choice(
        [
            ["energy", path],
            ["energy", path, "--json", "--energy", rng.choice(["vertex", "edge", "moebius-k2"])],
            ["relax", path, "out.txt", "--report", "r.json", "--trajectory", "t.npz", *SHORT],
            ["relax", path, "out.json", "--quiet", *SHORT],
            ["compare", path, "--methods", "lbfgs", "-o", "c.csv", *SHORT],
        ]
    )


def mutated(rng: random.Random, data: bytes) -> bytes:
    """Bytes with pieces inserted, repeated, replaced and cut out."""
    for _ in range(rng.randint(1, 4)):
        a, b = sorted(rng.randrange(len(data) + 1) for _ in range(2))
        piece = rng.choice([rng.randbytes(rng.randint(0, 30)), rng.choice(WEIRD).encode(), data[a:b]])
        data = rng.choice(
            [data[:a] + piece + data[a:], data[:a] + data[b:], data[:a] + piece + data[a + 1 :], data[:b], data + data]
        )[: 1 << 20]
    return data
