#!/usr/bin/env python3
"""Run many bad or odd command lines, the same for the same seed, and look at how the program takes them.

    tools/odd_commands.py [--count 1000] [--seed 1] [--only KIND]

Every command runs in a directory of its own under limits. Whatever it is given it must end within 20 seconds and 1 GB,
with a documented exit status, without a traceback, with one sentence where it refuses, and leave inputs, files that
were there before and temporary directories as they should be.
"""

import argparse
import contextlib
import io
import json
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
import zipfile
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from math import cos, pi, sin
from pathlib import Path
from typing import IO

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


@dataclass
class Case:
    """One command line and its surroundings.

    Parameters
    ----------
    words
        The arguments.
    statuses
        Exit statuses that are right; by default all documented ones.
    given, out, err
        Standard input (bytes or "closed" or a path) and how the outputs are: "pipe", "closed", "full" or "gone".
    signals
        Signals and seconds to wait before each.
    """

    words: list[str]
    statuses: tuple[int, ...] = (0, 1, 2, 130)
    given: bytes | str = b""
    out: str = "pipe"
    err: str = "pipe"
    env: dict[str, str] = field(default_factory=dict)
    limits: dict[int, int] = field(default_factory=dict)
    signals: list[tuple[float, int]] = field(default_factory=list)
    feeds: dict[str, bytes] = field(default_factory=dict)  # what is written to named pipes


Kind = Callable[[random.Random, Path], Case]
KINDS: dict[str, Kind] = {}


def kind(make: Kind) -> Kind:
    """Register a kind of odd command."""
    KINDS[make.__name__] = make
    return make


@kind
def bad_files(rng: random.Random, room: Path) -> Case:
    """Damaged curve files."""
    suffix = rng.choice(TEXTS)
    path = room / f"in{suffix}"
    path.write_bytes(mutated(rng, text_of(trefoil(), suffix).encode()))
    return Case(command_on(rng, str(path)))


@kind
def garbage(rng: random.Random, room: Path) -> Case:
    """Files of random bytes, of one line over and over, or of nothing."""
    path = room / f"in{rng.choice(TEXTS)}"
    n = rng.choice([0, 1, 100, 100_000])
    data = rng.choice(
        [rng.randbytes(n), b"\n" * n, b"0 0 0\n" * n, b"[" * n, b"l 1 2\n" * n, b"0" * n, b"\xff\xfe" * n]
    )
    path.write_bytes(data)
    return Case(command_on(rng, str(path)), statuses=(2,))


@kind
def geometry(rng: random.Random, room: Path) -> Case:
    """Coordinates that are huge, tiny, repeated, collinear, touching, or far away."""
    points = [list(p) for p in trefoil(rng.choice([3, 4, 24]))]
    scale = rng.choice([1.0, 1e-320, 1e-200, 1e-20, 1e20, 1e150, 1e300])
    shift = rng.choice([0.0, 1e5, 1e14, 1e40, -1e300])
    points = [[scale * x + shift for x in p] for p in points]
    for _ in range(rng.randint(0, 3)):
        points[rng.randrange(len(points))] = list(rng.choice(points))
    suffix = rng.choice(TEXTS)
    path = room / f"in{suffix}"
    path.write_text(text_of([tuple(p) for p in points], suffix))
    return Case(command_on(rng, str(path)))


@kind
def trajectories(rng: random.Random, room: Path) -> Case:
    """Damaged archives."""
    path = room / "t.npz"
    data = trajectory(room)
    if rng.random() < 0.2:
        with zipfile.ZipFile(path, "w", rng.choice([zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])) as archive:
            archive.writestr("stage_000.npy", rng.randbytes(200))
            archive.writestr("component_sizes_000.npy", b"")
        data = path.read_bytes()
    path.write_bytes(mutated(rng, data))
    words = ["verify", str(path), *rng.choice([[], ["--json"]])]
    if rng.random() < 0.3:
        return Case(["verify", "-"], given=path.read_bytes())
    return Case(words, statuses=(0, 1))


@kind
def bad_options(rng: random.Random, room: Path) -> Case:
    """Options with odd values, cut short, unknown."""
    command = rng.choice(COMMANDS)
    good = good_file(room)
    words = {
        "relax": [command, good, "out.txt", *SHORT],
        "knot": [command, "3_1", "k.txt"],
        "compare": [command, good, "-o", "c.csv", "--methods", "lbfgs", *SHORT],
        "methods": [command],
    }.get(command, [command, good])
    option = rng.choice(options_of(command))
    option = rng.choice([option, option, option, option[:-1], option + "s", option.upper()])
    value = [f"{option}={rng.choice(VALUES)}"] if rng.random() < 0.5 else [option, rng.choice(VALUES)]
    return Case(words + value)


@kind
def bad_words(rng: random.Random, room: Path) -> Case:
    """Arguments in random combinations."""
    words = [rng.choice([*COMMANDS, *VALUES, "relaks", "--version", "-h", "--vers"]) for _ in range(rng.randint(0, 4))]
    return Case(words)


@kind
def knots(rng: random.Random, room: Path) -> Case:
    """Knot names that are long, huge or invalid."""
    names = ["3_1", "T(3,5)", "T(999999,999999)", "braid()", "braid(1,2,3)", "m" * 2000, "3_1#" * 200, "0_1", *VALUES]
    extra = rng.choice([[], ["--vertices", rng.choice(["3", "100", "1000000000", "-5"])]])
    return Case(["knot", rng.choice(names), rng.choice(["k.txt", "k.obj", "-", "k", "no/k.txt"]), *extra])


@kind
def streams(rng: random.Random, room: Path) -> Case:
    """Standard streams that are closed, full, gone, endless or in a limited encoding."""
    good = good_file(room)
    words = rng.choice(
        [
            ["energy", good],
            ["methods"],
            ["--help"],
            ["relax", "--help"],
            ["--version"],
            ["relax", good, "-", *SHORT],
            ["relax", good, "out.txt", *SHORT],
            ["relax", good, "out.txt", "--report", "/dev/stdout", *SHORT],
            ["relax", good, "out.txt", "--trajectory", "/dev/stdout", *SHORT],
            ["energy", "none.txt"],
            ["knot", "3_1", "-"],
            ["energy", "-"],
            ["verify", "-"],
        ]
    )
    out, err = rng.choice(["pipe", "closed", "full", "gone"]), rng.choice(["pipe", "closed", "full", "gone"])
    encoding = rng.choice(["utf-8", "ascii", "cp1252", "latin-1", "utf-16"])
    env = rng.choice(
        [{}, {"PYTHONIOENCODING": encoding}, {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}]
    )
    return Case(
        words, given=rng.choice([b"", "closed", "/dev/zero", Path(good).read_bytes()]), out=out, err=err, env=env
    )


@kind
def same_files(rng: random.Random, room: Path) -> Case:
    """One file named twice."""
    good = good_file(room)
    names = {"r.json": "--report", "t.npz": "--trajectory"}
    os.link(good, room / "hard.txt")
    (room / "soft.txt").symlink_to(good)
    alias = rng.choice([good, "in.txt", "./in.txt", f"../{room.name}/in.txt", "hard.txt", "soft.txt"])
    which = rng.choice(["out", "compare", *names])
    if which == "out":
        return Case(["relax", good, alias, *SHORT], statuses=(2,))
    if which == "compare":
        (room / "in.json").write_text(text_of(trefoil(), ".json"))
        return Case(["compare", "in.json", "-o", "./in.json", "--methods", "lbfgs", *SHORT], statuses=(2,))
    if rng.random() < 0.5:
        return Case(["relax", good, "out.txt", names[which], alias, *SHORT], statuses=(2,))
    twice = rng.choice([["--report", "./out.txt"], ["--report", "x", "--trajectory", str(room / "x")]])
    return Case(["relax", good, "out.txt", *twice, *SHORT], statuses=(2,))


@kind
def places(rng: random.Random, room: Path) -> Case:
    """Outputs where no file can be."""
    good = good_file(room)
    (room / "directory.txt").mkdir()
    deep = room / "/".join(["d" * 60] * 20)
    deep.mkdir(parents=True)
    place = rng.choice(
        [
            "no/such/out.txt", "directory.txt", "in.txt/out.txt", "x" * 300 + ".txt", "/proc/out.txt", "/dev/full",
            "/proc/self/mem", "/sys/out.txt", "y/" * 3000 + "out.txt", str(deep / "out.txt"), "/dev/null", "-", "out",
        ]
    )  # fmt: skip
    option = rng.choice([None, "--report", "--trajectory", "compare"])
    if option is None:
        return Case(["relax", good, place, *rng.choice([[], ["--format", "obj"]]), *SHORT])
    if option == "compare":
        return Case(["compare", good, "--methods", "lbfgs", "-o", place.replace(".txt", ".csv"), *SHORT])
    return Case(["relax", good, "out.txt", option, place, *SHORT])


@kind
def no_room(rng: random.Random, room: Path) -> Case:
    """Files may hardly grow, or hardly any may be open."""
    good = good_file(room)
    for name in ("out.txt", "r.json", "t.npz"):
        (room / name).write_text("old")
    words = ["relax", good, "out.txt", "--report", "r.json", "--trajectory", "t.npz", *SHORT]
    if rng.random() < 0.6:
        return Case(words, limits={resource.RLIMIT_FSIZE: rng.choice([0, 1, 300, 3000])}, statuses=(2,))
    return Case(words, limits={resource.RLIMIT_NOFILE: rng.choice([8, 9, 10, 12, 15, 20])}, statuses=(0, 1, 2))


@kind
def interrupted(rng: random.Random, room: Path) -> Case:
    """Signals at odd moments, sometimes several at once."""
    good = good_file(room)
    words = rng.choice(
        [
            ["relax", good, "out.txt", "--report", "r.json", "--trajectory", "t.npz", "--vertices", "100", *SLOW],
            ["relax", good, "out.obj", "--report", "r.json", *SLOW],
            ["compare", good, "-o", "c.json", "--time-limit", "0.1", *ENDLESS],
            ["energy", good, "--energy", "tangent-point"],
        ]
    )
    number = rng.choice([signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
    moments = [(rng.choice([0.0, 0.02, 0.1, 0.3]) + rng.random() * rng.choice([0.05, 0.5, 1.5]), number)]
    moments += [(rng.choice([0.0, 0.001, 0.005, 0.01]), rng.choice([number, signal.SIGTERM]))] * rng.randint(0, 2)
    return Case(words, signals=moments, statuses=(0, 130, -number, -signal.SIGTERM))


@kind
def huge(rng: random.Random, room: Path) -> Case:
    """More vertices, coordinates or components than can be used."""
    options, most = rng.choice([([], 200_000), (["--solver", "dense"], 12_000), (["--method", "trust-region"], 12_000)])
    which = rng.choice(["file", "vertices", "dimension", "words", "components"])
    if which == "file":
        path = good_file(room, rng.choice(TEXTS), rng.choice([most + 1, 2 * most]))
        return Case(rng.choice([["relax", path, "out.txt", *options], ["compare", path, "-o", "c.csv"]]), statuses=(2,))
    if which == "dimension":
        (room / "in.json").write_text(json.dumps([[float(k == i) for k in range(100_000)] for i in range(3)]))
        return Case(command_on(rng, "in.json"), statuses=(2,))
    if which == "components":
        (room / "in.txt").write_text("0 0 0\n1 0 0\n0 1 0\n\n" * 30_000)
        return Case(command_on(rng, "in.txt"), statuses=(2,))
    if which == "words":
        (room / "in.obj").write_text("v 0 0 0\n" * 3 + "l " + "1 2 3 " * 500_000)
        return Case(command_on(rng, "in.obj"), statuses=(2,))
    count = rng.choice([str(most + 1), "1000000000", "9" * 30])
    return Case(["relax", good_file(room), "out.txt", "--vertices", count, *options], statuses=(2,))


@kind
def devices(rng: random.Random, room: Path) -> Case:
    """Devices and pipes instead of files."""
    good, name = good_file(room), rng.choice(["txt", "obj", "json", "vect"])
    os.mkfifo(room / "fifo.txt")
    source = rng.choice(
        ["/dev/zero", "/dev/urandom", "/dev/null", "/dev/stdin", "-", "fifo.txt", "/dev/full", "/dev/tty"]
    )
    feeds = (
        {"fifo.txt": rng.choice([b"", Path(good).read_bytes(), b"0 0 0\n" * 3_000_000])} if source == "fifo.txt" else {}
    )
    words = rng.choice(
        [
            ["energy", source, "--format", name],
            ["relax", source, "/dev/null", "--format", name, *SHORT],
            ["relax", source, "-", "--format", name, *SHORT],
            ["relax", source, "out.txt", "--report", "/dev/stdout", "--format", name, *SHORT],
            ["verify", source],
        ]
    )
    return Case(words, given=rng.choice(["/dev/zero", Path(good).read_bytes(), b""]), feeds=feeds)


@kind
def dependencies(rng: random.Random, room: Path) -> Case:
    """Modules that are missing, broken, out of memory, or interrupted while they are imported."""
    good = good_file(room)
    fake = room / "fake"
    fake.mkdir()
    module = rng.choice(["numpy", "scipy", "shtab", "matplotlib", "bpy"])
    how = rng.choice(
        [
            f"raise ModuleNotFoundError('No module named {module}')",
            "raise MemoryError",
            "import os, signal\nos.kill(os.getpid(), signal.SIGINT)\nwhile True: pass",
            "raise OSError(24, 'Too many open files')",
            "syntax error",
        ]
    )
    (fake / f"{module}.py").write_text(how + "\n")
    output = rng.choice(["out.txt", "out.blend", "out.png"]) if module == "bpy" else "out.txt"
    words = [
        ["relax", good, output, *SHORT],
        ["compare", good, "-o", "c.png", "--methods", "lbfgs", *SHORT],
        ["methods"],
    ]
    env = {"PYTHONPATH": str(fake), "MPLBACKEND": rng.choice(["nonsense", "agg", ""])}
    if "os.kill" in how and module in ("shtab", "matplotlib", "bpy"):
        env = {"MPLBACKEND": "nonsense"}
    return Case(rng.choice(words), env=env)


@kind
def low_memory(rng: random.Random, room: Path) -> Case:
    """Too little address space."""
    good = good_file(room, n=rng.choice([24, 3000]))
    dense = ["--vertices", "9000", "--solver", "dense", *SHORT]
    words = rng.choice([["relax", good, "out.txt", *SHORT], ["energy", good], ["relax", good, "out.txt", *dense]])
    return Case(words, limits={resource.RLIMIT_AS: rng.choice([420, 500, 700]) << 20})


ROOT = Path(__file__).resolve().parents[1]
PROGRAM = [sys.executable, "-P", "-m", "mobius_flow"]
PATIENCE = 20.0  # seconds
MEMORY = 1 << 30  # bytes of resident memory
LIMITS = {resource.RLIMIT_AS: 6 << 30, resource.RLIMIT_FSIZE: 1 << 28, resource.RLIMIT_CORE: 0}
RESULTS = ("out", "r.json", "t.npz", "c.", "k", "x", "film.", "directory.")  # how the names of outputs begin
UNFORGIVABLE = (b"Traceback", b"Exception ignored", b"internal error", b"Fatal Python error")


@dataclass
class Outcome:
    """What a command did: its exit status, seconds, bytes of memory, and what it printed."""

    status: int
    seconds: float
    memory: int
    out: bytes
    err: bytes


def run(case: Case, room: Path, patience: float = PATIENCE) -> Outcome:
    """Run a case in its directory, for so many seconds at most."""
    ends = [_end(case.out), _end(case.err)]
    started = time.monotonic()
    process = subprocess.Popen(
        [os.fsencode(word) for word in PROGRAM + [word.replace("\0", "") for word in case.words]],
        cwd=room,
        env={**os.environ, "TMPDIR": str(room / "scratch"), "PYTHONDONTWRITEBYTECODE": "1"} | case.env,
        stdin=_source(case.given),
        stdout=ends[0],
        stderr=ends[1],
        preexec_fn=lambda: _prepare(case),
        start_new_session=True,
    )
    for end in ends:
        if end >= 0:
            os.close(end)
    heard: dict[int, bytes] = {}
    readers = [
        threading.Thread(target=lambda k=k, stream=stream: heard.update({k: stream.read()}))
        for k, stream in enumerate([process.stdout, process.stderr])
        if stream is not None
    ]
    helpers = [threading.Thread(target=_send, args=(process, case.signals), daemon=True)]
    if process.stdin is not None and isinstance(case.given, bytes):
        helpers.append(threading.Thread(target=_feed, args=(process.stdin, case.given), daemon=True))
    for name, data in case.feeds.items():
        helpers.append(threading.Thread(target=_open_and_feed, args=(room / name, data), daemon=True))
    killer = threading.Timer(patience, process.kill)
    for thread in (*readers, *helpers, killer):
        thread.start()
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.monotonic() - started
    process.returncode = os.waitstatus_to_exitcode(status)
    killer.cancel()
    for thread in readers:
        thread.join()
    return Outcome(process.returncode, seconds, usage.ru_maxrss * 1024, heard.get(0, b""), heard.get(1, b""))


def _prepare(case: Case) -> None:
    """In the new process: set limits, signals as in a terminal, and closed streams."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    for limit, value in (LIMITS | case.limits).items():
        resource.setrlimit(limit, (value, value))
    for number, how in enumerate((case.given, case.out, case.err)):
        if how == "closed":
            os.close(number)


def _end(how: str) -> int:
    if how == "full":
        return os.open("/dev/full", os.O_WRONLY)
    if how == "gone":
        reader, writer = os.pipe()
        os.close(reader)
        return writer
    return subprocess.PIPE if how == "pipe" else os.open(os.devnull, os.O_RDWR)


def _source(given: bytes | str) -> int:
    if isinstance(given, bytes):
        return subprocess.PIPE
    return os.open(os.devnull if given == "closed" else given, os.O_RDONLY)


def _feed(stream: IO[bytes], data: bytes) -> None:
    with contextlib.suppress(OSError), stream:
        stream.write(data)


def _open_and_feed(path: Path, data: bytes) -> None:
    with contextlib.suppress(OSError), path.open("wb") as stream:
        stream.write(data)


def _send(process: "subprocess.Popen[bytes]", signals: list[tuple[float, int]]) -> None:
    for seconds, number in signals:
        time.sleep(seconds)
        if process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(process.pid, number)


def complaints(case: Case, room: Path, before: dict[str, bytes], outcome: Outcome) -> list[str]:
    """Everything that is wrong with an outcome."""
    found = []
    if outcome.status == -signal.SIGKILL:
        found.append(f"was still running after {outcome.seconds:.0f} s")
    if outcome.memory > MEMORY:
        found.append(f"took {outcome.memory >> 20} MB")
    if outcome.status not in case.statuses:
        found.append(f"exit status {outcome.status}, not one of {case.statuses}")
    found += [word.decode() for word in UNFORGIVABLE if word in outcome.err + outcome.out]
    if (case.signals or case.limits) and b"Traceback" in outcome.err and os.fsencode(f"{ROOT}/") not in outcome.err:
        return []  # Python itself did not start
    lines = outcome.err.replace(b"\0", b"").decode("utf-8", "replace").splitlines()  # it may be UTF-16
    several = "compare" in case.words and outcome.status == 130  # the methods that have finished
    if case.err == "pipe" and outcome.status in (2, 130) and not several and len(lines) != 1:
        found.append(f"{len(lines)} lines instead of a sentence")
    return found + _losses(case, room, before, outcome)


def contents(room: Path) -> dict[str, bytes]:
    """The regular files of a directory, by name."""
    return {path.name: path.read_bytes() for path in room.iterdir() if path.is_file()}


def _losses(case: Case, room: Path, before: dict[str, bytes], outcome: Outcome) -> list[str]:
    after = contents(room)
    found = [f"{name} is gone" for name in before.keys() - after.keys()]
    for name in sorted(after):
        ours = name.startswith(RESULTS)
        if name in before and after[name] != before[name] and not (ours and _whole(room / name)):
            found.append(f"{name} has changed")
        named = any(word.endswith(f"={name}") or word == name for word in case.words)
        if name not in before and not ((ours or named) and _whole(room / name)):
            found.append(f"{name} is left behind")
    told = case.err == "pipe"
    left = [path for path in (room / "scratch").iterdir() if told and os.fsencode(path) not in outcome.err]
    return found + [f"{path.name} is left in the temporary directory" for path in left if outcome.status >= 0]


def _whole(path: Path) -> bool:
    """Whether an output is complete."""
    if zipfile.is_zipfile(path):
        return True
    data = path.read_bytes()
    return data.endswith((b"}\n", b"]\n") if path.suffix == ".json" else b"\n") or path.suffix in (".png", ".blend")


def judged(
    number: int, seed: int, only: str | None = None, patience: float = PATIENCE
) -> tuple[str, Case, Outcome, list[str]]:
    """Run the command with a number: return its kind, what it was, what it did, and what is wrong with that."""
    rng = random.Random(f"{seed} {number}")
    kind = only or list(KINDS)[number % len(KINDS)]
    with tempfile.TemporaryDirectory(prefix="odd-") as place:
        room = Path(place)
        (room / "scratch").mkdir()
        case = KINDS[kind](rng, room)
        before = contents(room)
        outcome = run(case, room, patience)
        return kind, case, outcome, complaints(case, room, before, outcome)


def main() -> int:
    """Run the commands; exit status 1 if the program handles one of them badly."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="number of the first command")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=KINDS, metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--patience", type=float, default=PATIENCE, help="seconds a command may take")
    options = parser.parse_args()
    statuses: Counter[int] = Counter()
    slowest, largest, bad = (0.0, ""), (0, ""), 0
    for number in range(options.first, options.first + options.count):
        kind, case, outcome, wrong = judged(number, options.seed, options.only, options.patience)
        statuses[outcome.status] += 1
        words = " ".join(word[:60] for word in case.words)
        slowest, largest = max(slowest, (outcome.seconds, words)), max(largest, (outcome.memory, words))
        if wrong:
            bad += 1
            print(f"{number} {kind}: {words!a}\n  {'; '.join(wrong)}\n  {outcome.err[-400:]!r}", flush=True)
    print(f"{options.count} commands, {bad} taken badly; exit statuses {dict(sorted(statuses.items()))}")
    print(f"slowest {slowest[0]:.1f} s: {slowest[1]!a}; largest {largest[0] >> 20} MB: {largest[1]!a}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
