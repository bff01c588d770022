"""Odd command lines by kind, for `odd_commands`: each makes its files in its own directory."""

import json
import os
import random
import resource
import signal
import zipfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from odd_files import (
    COMMANDS,
    ENDLESS,
    SHORT,
    SLOW,
    TEXTS,
    VALUES,
    command_on,
    good_file,
    mutated,
    options_of,
    text_of,
    trajectory,
    trefoil,
)


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
    module = rng.choice(["numpy", "scipy", "tqdm", "matplotlib", "bpy"])
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
    if "os.kill" in how and module in ("tqdm", "matplotlib", "bpy"):
        env = {"MPLBACKEND": "nonsense"}
    return Case(rng.choice(words), env=env)


@kind
def low_memory(rng: random.Random, room: Path) -> Case:
    """Too little address space."""
    good = good_file(room, n=rng.choice([24, 3000]))
    dense = ["--vertices", "9000", "--solver", "dense", *SHORT]
    words = rng.choice([["relax", good, "out.txt", *SHORT], ["energy", good], ["relax", good, "out.txt", *dense]])
    return Case(words, limits={resource.RLIMIT_AS: rng.choice([420, 500, 700]) << 20})
