#!/usr/bin/env python3
"""Run many bad or odd command lines, the same for the same seed, and look at how the program takes them.

    tools/odd_commands.py [--count 1000] [--seed 1] [--only KIND]

Every command runs in a directory of its own under limits. Whatever it is given it must end within 20 seconds and 1 GB,
with a documented exit status, without a traceback, with one sentence where it refuses, and leave inputs, files that
were there before and temporary directories as they should be. Odd geometry, names, places and sizes, which need no
process of their own, are in tests/core/test_hostile.py and tests/cli.
"""

import argparse
import contextlib
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
from dataclasses import dataclass, field
from pathlib import Path

from mobius_flow.cli.parser import add_to
from mobius_flow.core import write_curve
from mobius_flow.core.knots import knot

ROOT = Path(__file__).resolve().parents[1]
LIMITS = {resource.RLIMIT_AS: 6 << 30, resource.RLIMIT_FSIZE: 1 << 28, resource.RLIMIT_CORE: 0}
TEXTS = (".txt", ".xyz", ".obj", ".vect", ".json")
SHORT = "--max-iterations 1"
Ended = subprocess.CompletedProcess[bytes]
ENDLESS = "--tolerance 1e-30 --max-iterations 1000000"
ALL = f"out.txt --report r.json --trajectory t.npz {SHORT}"
VALUES = ["", "-1", "0", "nan", "inf", "-inf", "1e999", "1e-999", "-0", "9" * 5000, "0x10", "1_0", "x", "1.5", "--"]
VALUES += ["-", "a\nb", "٣", "\0", "\ufeff", "é", "🙂", "{", "]"]
COMMANDS = {  # what each takes at least; IN is a good curve
    "relax": f"IN out.txt {SHORT}",
    "separate": "IN out.txt --radius 0.1",
    "energy": "IN",
    "info": "IN",
    "draw": "IN out.svg --layout",
    "knot": "3_1 k.txt",
    "compare": f"IN -o c.csv --methods lbfgs {SHORT}",
    "verify": "IN",
    "methods": "",
}
READERS = (  # commands that read a curve
    "energy IN",
    "draw IN out.pdf --arrows --numbers",
    f"relax IN {ALL}",
    f"compare IN --methods lbfgs -o c.csv {SHORT}",
)


@dataclass
class Case:
    """One command line and its surroundings."""

    words: list[str]
    statuses: tuple[int, ...] = (0, 1, 2, 130)  # exit statuses that are right; by default all documented ones
    given: bytes | str = b""  # standard input: bytes, a path, or "closed"
    out: str = "pipe"  # how outputs are: "pipe", "closed", "full" or "gone"
    err: str = "pipe"
    env: dict[str, str] = field(default_factory=dict)
    limits: dict[int, int] = field(default_factory=dict)
    signals: list[tuple[float, int]] = field(default_factory=list)  # each after so many seconds
    feeds: dict[str, bytes] = field(default_factory=dict)  # what is written to named pipes


def split(line: str, path: object = "in.txt") -> list[str]:
    """The words of a line, with a path in place of IN."""
    return [str(path) if word == "IN" else word for word in line.split()]


def curve_file(room: Path, n: int = 24, suffix: str = ".txt") -> str:
    """Write a good curve, and return its path."""
    path = room / f"in{suffix}"
    write_curve(path, knot("3_1", n))
    return str(path)


def mutated(rng: random.Random, data: bytes) -> bytes:
    """Bytes with pieces inserted, repeated, replaced and cut out."""
    for _ in range(rng.randint(1, 4)):
        a, b = sorted(rng.randrange(len(data) + 1) for _ in range(2))
        piece = rng.choice([rng.randbytes(rng.randint(0, 30)), rng.choice(VALUES).encode(), data[a:b]])
        cuts = [piece + data[a:], data[b:], piece + data[a + 1 :], data[a:b], data[a:] + data]
        data = (data[:a] + rng.choice(cuts))[: 1 << 20]
    return data


def damaged(rng: random.Random, room: Path) -> Case:
    """Damaged curve files, and files of random bytes, of one line over and over, or of nothing."""
    path = Path(curve_file(room, suffix=rng.choice(TEXTS)))
    if rng.random() < 0.5:
        path.write_bytes(mutated(rng, path.read_bytes()))
        return Case(split(rng.choice(READERS), path))
    piece = rng.choice([b"\n", b"0 0 0\n", b"[", b"l 1 2\n", b"0", b"\xff\xfe", rng.randbytes(100)])
    path.write_bytes(piece * rng.choice([0, 1, 100, 100_000 // len(piece)]))
    return Case(split(rng.choice(READERS), path), statuses=(2,))


def options(rng: random.Random, room: Path) -> Case:
    """Options with odd values, cut short, unknown, and arguments in random combinations."""
    if rng.random() < 0.3:
        words = [*COMMANDS, *VALUES, "relaks", "--version", "-h", "--vers"]
        return Case([rng.choice(words) for _ in range(rng.randint(0, 4))])
    command, parser = rng.choice(list(COMMANDS)), argparse.ArgumentParser()
    add_to(parser, command)
    option = rng.choice(re.findall(r"^  (?:-\w, )?(--[\w-]+)", parser.format_help(), re.MULTILINE))
    option = rng.choice([option, option, option, option[:-1], option + "s", option.upper()])
    value = [f"{option}={rng.choice(VALUES)}"] if rng.random() < 0.5 else [option, rng.choice(VALUES)]
    return Case([command, *split(COMMANDS[command], curve_file(room)), *value])


def streams(rng: random.Random, room: Path) -> Case:
    """Standard streams that are closed, full, gone, endless or in a limited encoding; devices and pipes as files."""
    good, name = curve_file(room), rng.choice(["txt", "obj", "json", "vect"])
    os.mkfifo(room / "fifo.txt")
    devices = [f"/dev/{name}" for name in ("zero", "urandom", "null", "stdin", "full", "tty")]
    source = rng.choice([*devices, "-", "fifo.txt", "in.txt"])
    line = rng.choice(
        [
            f"energy {source} --format {name}",
            f"verify {source}",
            *(f"relax {source} {out} --format {name} {SHORT}" for out in ("/dev/null", "-", "out.txt --report -")),
            f"relax IN out.txt --{rng.choice(['report', 'trajectory'])} /dev/stdout {SHORT}",
            *("methods", "--help", "relax --help", "--version", "energy none.txt", "knot 3_1 -"),
        ]
    )
    feed = rng.choice([b"", Path(good).read_bytes(), b"0 0 0\n" * 3_000_000])
    encoding = {"PYTHONIOENCODING": rng.choice(["utf-8", "ascii", "cp1252", "latin-1", "utf-16"])}
    return Case(
        split(line),
        given=rng.choice([b"", "closed", "/dev/zero", Path(good).read_bytes()]),
        out=rng.choice(["pipe", "closed", "full", "gone"]),
        err=rng.choice(["pipe", "closed", "full", "gone"]),
        env=rng.choice([{}, encoding, {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}]),
        feeds={"fifo.txt": feed} if "fifo.txt" in line else {},
    )


def scarcity(rng: random.Random, room: Path) -> Case:
    """Files may hardly grow, hardly any may be open, or there is too little address space."""
    curve_file(room, rng.choice([24, 3000]))
    for name in ("out.txt", "r.json", "t.npz"):
        (room / name).write_text("old")
    limit, amounts, statuses = rng.choice(
        [
            (resource.RLIMIT_FSIZE, [0, 1, 300, 3000], (2,)),
            (resource.RLIMIT_NOFILE, [8, 9, 10, 12, 15, 20], (0, 1, 2)),
            (resource.RLIMIT_AS, [420 << 20, 500 << 20, 700 << 20], (0, 1, 2)),
        ]
    )
    memory = limit == resource.RLIMIT_AS
    line = rng.choice([f"{ALL} --solver dense --vertices 9000", f"out.txt {SHORT}"]) if memory else ALL
    return Case(split(f"relax IN {line}"), limits={limit: rng.choice(amounts)}, statuses=statuses)


def interrupted(rng: random.Random, room: Path) -> Case:
    """Signals at odd moments, sometimes several at once."""
    line = rng.choice(
        [
            f"relax IN out.txt --report r.json --trajectory t.npz --vertices 100 --method flow-l2 {ENDLESS}",
            f"relax IN out.obj --report r.json --method flow-l2 {ENDLESS}",
            f"compare IN -o c.json --time-limit 0.1 {ENDLESS}",
            "energy IN --energy tangent-point",
        ]
    )
    number = rng.choice([signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
    moments = [(rng.choice([0.0, 0.02, 0.1, 0.3]) + rng.random() * rng.choice([0.05, 0.5, 1.5]), number)]
    moments += [(rng.choice([0.0, 0.001, 0.005, 0.01]), rng.choice([number, signal.SIGTERM]))] * rng.randint(0, 2)
    return Case(split(line, curve_file(room)), signals=moments, statuses=(0, 130, -number, -signal.SIGTERM))


def dependencies(rng: random.Random, room: Path) -> Case:
    """Modules that are missing, broken, out of memory, or interrupted while they are imported."""
    curve_file(room)
    (room / "fake").mkdir()
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
    (room / "fake" / f"{module}.py").write_text(how + "\n")
    out = rng.choice(["out.txt", "out.blend", "out.png"]) if module == "bpy" else "out.txt"
    line = rng.choice([f"relax IN {out} {SHORT}", f"compare IN -o c.png --methods lbfgs {SHORT}", "methods"])
    loops = "os.kill" in how and module in ("shtab", "matplotlib", "bpy")  # where the program swallows what is raised
    fake = {} if loops else {"PYTHONPATH": str(room / "fake")}
    return Case(split(line), env={"MPLBACKEND": rng.choice(["nonsense", "agg", ""]), **fake})


KINDS = {each.__name__: each for each in (damaged, options, streams, scarcity, interrupted, dependencies)}


def run(case: Case, room: Path, patience: float) -> Ended:
    """Run a case in its directory, for so many seconds at most."""

    def prepare() -> None:  # in the new process: signals as in a terminal, limits, and closed streams
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        for limit, value in (LIMITS | case.limits).items():
            resource.setrlimit(limit, (value, value))
        for number, how in enumerate((case.given, case.out, case.err)):
            if how == "closed":
                os.close(number)

    def end(how: str) -> int:
        reader, gone = os.pipe()
        os.close(reader)
        if how == "gone":
            return gone
        os.close(gone)
        return subprocess.PIPE if how == "pipe" else os.open("/dev/full" if how == "full" else os.devnull, os.O_RDWR)

    def feed(path: Path, data: bytes) -> None:
        with contextlib.suppress(OSError):
            path.write_bytes(data)

    def send() -> None:
        for seconds, number in case.signals:
            time.sleep(seconds)
            process.send_signal(number)  # not to one that has ended

    source = os.devnull if case.given == "closed" else case.given
    given = subprocess.PIPE if isinstance(source, bytes) else os.open(source, os.O_RDONLY)
    ends = [given, end(case.out), end(case.err)]
    process = subprocess.Popen(
        [os.fsencode(word.replace("\0", "")) for word in (sys.executable, "-P", "-m", "mobius_flow", *case.words)],
        cwd=room,
        env={**os.environ, "TMPDIR": str(room / "scratch"), "PYTHONDONTWRITEBYTECODE": "1"} | case.env,
        stdin=ends[0],
        stdout=ends[1],
        stderr=ends[2],
        preexec_fn=prepare,
        start_new_session=True,
    )
    for each in ends:
        if each >= 0:
            os.close(each)
    threading.Thread(target=send, daemon=True).start()
    for name, data in case.feeds.items():
        threading.Thread(target=feed, args=(room / name, data), daemon=True).start()
    try:
        out, err = process.communicate(source if isinstance(source, bytes) else None, patience)
    except subprocess.TimeoutExpired:
        process.kill()
        out, err = process.communicate()
    return subprocess.CompletedProcess(case.words, process.returncode, out or b"", err or b"")


def complaints(case: Case, room: Path, before: dict[str, bytes], outcome: Ended) -> list[str]:
    """Everything that is wrong with an outcome."""
    found, said = [], outcome.stderr
    if outcome.returncode == -signal.SIGKILL:
        found.append("was still running when its time was up")
    if (largest := resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss >> 10) > 1 << 10:  # of all commands so far
        found.append(f"this one, or one before, took {largest} MB")
    if outcome.returncode not in case.statuses:
        found.append(f"exit status {outcome.returncode}, not one of {case.statuses}")
    bad = ("Traceback", "Exception ignored", "internal error", "Fatal Python error")
    found += [word for word in bad if word.encode() in said + outcome.stdout]
    if (case.signals or case.limits) and b"Traceback" in said and os.fsencode(f"{ROOT}/") not in said:
        return []  # Python itself did not start
    lines = said.replace(b"\0", b"").decode("utf-8", "replace").splitlines()  # it may be UTF-16
    several = "compare" in case.words and outcome.returncode == 130  # the methods that have finished
    if case.err == "pipe" and outcome.returncode in (2, 130) and not several and len(lines) != 1:
        found.append(f"{len(lines)} lines instead of a sentence")
    after = contents(room)
    found += [f"{name} is gone" for name in before.keys() - after.keys()]
    for name, data in sorted(after.items()):
        ours = name.startswith(("out", "r.json", "t.npz", "c.", "k", "x"))  # names of outputs
        named = any(word.endswith(f"={name}") or word == name for word in case.words)
        whole = data.endswith((b"}\n", b"]\n") if name.endswith(".json") else b"\n")
        whole = whole or name.endswith((".png", ".blend")) or zipfile.is_zipfile(room / name)
        if name in before and data != before[name] and not (ours and whole):
            found.append(f"{name} has changed")
        if name not in before and not ((ours or named) and whole):
            found.append(f"{name} is left behind")
    told = case.err == "pipe" and outcome.returncode >= 0
    left = [path for path in (room / "scratch").iterdir() if told and os.fsencode(path) not in said]
    return found + [f"{path.name} is left in the temporary directory" for path in left]


def contents(room: Path) -> dict[str, bytes]:
    """The regular files of a directory, by name."""
    return {path.name: path.read_bytes() for path in room.iterdir() if path.is_file()}


def main() -> int:
    """Run the commands; exit status 1 if the program handles one of them badly."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=KINDS, metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--patience", type=float, default=20.0, help="seconds a command may take")
    asked = parser.parse_args()
    statuses: Counter[int] = Counter()
    slowest, bad = (0.0, ""), 0
    for number in range(asked.count):
        rng, name = random.Random(f"{asked.seed} {number}"), asked.only or list(KINDS)[number % len(KINDS)]
        with tempfile.TemporaryDirectory(prefix="odd-") as place:
            room = Path(place)
            (room / "scratch").mkdir()
            case = KINDS[name](rng, room)
            before, began = contents(room), time.monotonic()
            outcome = run(case, room, asked.patience)
            seconds = time.monotonic() - began
            wrong = complaints(case, room, before, outcome)
        statuses[outcome.returncode] += 1
        words = " ".join(word[:60] for word in case.words)
        slowest = max(slowest, (seconds, words))
        if wrong:
            bad += 1
            print(f"{number} {name}: {words!a}\n  {'; '.join(wrong)}\n  {outcome.stderr[-400:]!r}", flush=True)
    print(f"{asked.count} commands, {bad} taken badly; exit statuses {dict(sorted(statuses.items()))}")
    print(f"slowest {slowest[0]:.1f} s: {slowest[1]!a}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
