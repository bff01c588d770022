#!/usr/bin/env python3
"""Run many bad or odd command lines, the same for the same seed, and look at how the program takes them.

    tools/odd_commands.py [--count 1000] [--seed 1] [--only KIND]

Every command runs in a directory of its own under limits. Whatever it is given it must end within 20 seconds and 1 GB,
with a documented exit status, without a traceback, with one sentence where it refuses, and leave inputs, files that
were there before and temporary directories as they should be.
"""

import argparse
import contextlib
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
import zipfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from odd_cases import KINDS, Case

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
