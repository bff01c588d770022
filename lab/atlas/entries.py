"""What an atlas contains on one knot or link: its minima and saddles, measured, as plain values that files hold."""

import hashlib
import json
import shlex
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from typing import Any

from ... import __version__
from ...cli.options import flags
from ...cli.terminal import one_line
from ...core.base.errors import CurveError
from ...core.collision.gap import thickness
from ...core.curve.fourier import FourierCurve
from ...core.curve.measures import writhe_and_crossings
from ...core.curve.symmetry import standing, symmetries
from ...core.knots import knot_type
from ..batch.job import folder_name
from ..batch.table import Row
from ..smooth.least import lower_bound
from ..smooth.minima import balanced, distinct
from ..smooth.rest import index_of
from .folder import Folder
from .runs import AtlasRun

Values = dict[str, Any]


def entry(folder: Folder, name: str, runs: Sequence[AtlasRun]) -> tuple[Values | None, Mapping[str, list[str]]]:
    """The entry of a type, if any runs are as reported, and the names of those that are not, by reason.

    It is made anew unless the one of the same runs by the same version exists.
    """
    file = f"entries/{name}.json"
    text = "\n".join([__version__, str(_proves()), *(run.mark for run in runs)])
    made_from = hashlib.sha256(text.encode()).hexdigest()
    known = json.loads(folder.read(file) or "{}")
    if known.get("made_from") != made_from:
        by_doubt: dict[str, list[AtlasRun]] = defaultdict(list)
        for run in runs:
            by_doubt[run.doubt(name)].append(run)
        good = by_doubt.pop("", [])
        left_out = {reason: [run.folder.name for run in each] for reason, each in by_doubt.items()}
        known = {"made_from": made_from, "entry": _made(name, good) if good else None, "left_out": left_out}
    folder.put(file, json.dumps(known) + "\n")
    return known["entry"], known["left_out"]


def curve_of(minimum: Mapping[str, Any]) -> FourierCurve:
    """The smooth curve of an entry's minimum."""
    return FourierCurve.of_lists(minimum["fourier"])


def _made(name: str, runs: Sequence[AtlasRun]) -> Values:
    groups = enumerate(distinct([run.rest for run in runs]), start=1)
    minima = [{"number": number} | _described(name, [runs[k] for k in group]) for number, group in groups]
    return {"type": name, "lower_bound": lower_bound(name), "runs": len(runs), "minima": minima}


def _described(name: str, runs: Sequence[AtlasRun]) -> Values:
    """Everything known about a curve, by the names of the tables' columns: the balanced end of the first run."""
    rest = balanced(runs[0].rest)
    curve, polygon = rest.curve, rest.curve.polygon(rest.curve.sizes)
    # 0.1 radii of gyration: balanced curves miss their symmetries by up to .04, and others by .15 or more
    group = symmetries(polygon, 0.1)
    upright = FourierCurve(tuple(c @ standing(polygon, group).T for c in curve.coefficients))
    # twice the vertices that represent a curve, when it is measured
    fine = upright.polygon([2 * size for size in upright.sizes])
    writhe, crossings = writhe_and_crossings(fine)
    bounds = next(filter(None, (_proved(name, run.curve) for run in runs)), None)
    row = runs[0].row
    return {
        "energy": rest.energy,
        "error": rest.error,
        "upper_bound": bounds and bounds[1],
        "index": index_of(runs[0].curve),
        "symmetry": group.name,
        "met": len(runs),
        "kinds": dict(Counter(run.row.kind or "named" for run in runs).most_common()),
        "modes": upright.modes,
        "ropelength": fine.length / thickness(fine),
        "writhe": writhe,
        "average_crossing_number": crossings,
        "version": row.version,
        "command": _command(row),
        "folder": folder_name(row.name, row.start),
        "fourier": upright.as_lists,
    }


def _proves() -> bool:
    """Whether ball arithmetic is installed."""
    return find_spec("flint") is not None


def _proved(name: str, curve: FourierCurve) -> tuple[float, float] | None:
    """Proved bounds of a curve's energy if its type, or its mirror image's, is proved too; None where one is not."""
    if not _proves():
        return None
    from ..smooth.bounds import energy_bounds
    from ..smooth.isotopy import inscribed

    try:
        kind = knot_type(inscribed(curve.coefficients))  # first, because it takes less time, also when it fails
        same = kind.proved and {each.removeprefix("m") for each in kind.names} == {name}
        return energy_bounds(curve.coefficients) if same else None
    except CurveError:
        return None


def _command(row: Row) -> str:
    """The command that repeats a run, along with those of all earlier starts; FILE stands for a file."""
    seed = [] if row.seed in (None, row.start) else ["--seed", str(row.seed - row.start)]
    name, file = (
        (row.name, "") if row.input_sha256 is None else ("FILE", f"  # SHA-256 of FILE: {one_line(row.input_sha256)}")
    )
    words = [name, "--starts", str(row.start), *seed, *flags(json.loads(row.options)), "--extrapolate"]
    return shlex.join(["mobius-flow", "batch", *words, "-o", "results"]) + file
