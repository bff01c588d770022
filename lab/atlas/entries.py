"""What an atlas contains on one knot or link: the runs that count and their minima, as plain values for files."""

import hashlib
import json
import shlex
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from importlib.util import find_spec
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ... import __version__
from ...cli.options import flag
from ...cli.terminal import one_line
from ...core import CurveError, MobiusFlowError, RelaxOptions, read_curve
from ...core.base import FloatArray, counted, declared
from ...core.collision.gap import thickness
from ...core.curve import Curve, writhe_and_crossings
from ...core.curve.symmetry import SymmetryGroup, symmetries
from ...core.curve.symmetry.group import multiplication, order_of
from ...core.knots import KNOTS, knot_type
from ...core.knots.names import table_name
from ...core.proof import stages, verify
from ..batch.folder import results
from ..batch.job import CURVE, TIGHT, TRAJECTORY, folder_name
from ..batch.table import Row
from ..smooth.fourier import FourierCurve
from ..smooth.least import lower_bound
from ..smooth.minima import balanced, distinct
from ..smooth.rest import RestingCurve, index_of, is_at_rest
from ..smooth.ropelength import ropelength_bound
from .folder import Folder

SMOOTH = "without a smooth shape (run batch with --extrapolate)"
CHECKED = "that verify did not accept"
PROVED = "whose type is not proved to be one of the table"
APART = "whose trajectory does not end at their curve"
ALONE = "pulled tight, of a type without a curve at rest"
UNLIKE = "whose curve, or smooth shape, is not of the type reported"
MOVING = "whose smooth shape is not at rest with the energy reported"
Values = dict[str, Any]


@dataclass(frozen=True, eq=False)
class AtlasRun:
    """A run that ended as a knot or link of the table, and the smooth curve of the table's chirality that it led to.

    A knot that was pulled tight led to none.
    """

    row: Row
    folder: Path
    smooth: FourierCurve | None
    mark: str  # the hash of its results

    @property
    def curve(self) -> FourierCurve:
        assert self.smooth is not None, "it came to rest"
        return self.smooth

    @property
    def rest(self) -> RestingCurve:
        """The curve at rest."""
        return RestingCurve(self.curve, self.row.extrapolated_energy or 0.0, self.row.extrapolated_energy_error or 0.0)

    def doubt(self, name: str) -> str:
        """Why the run does not count as one of a type, by its files, as reports may say anything; empty if it does."""
        trajectory = self.folder / TRAJECTORY
        if not verify(trajectory).accepted:
            return CHECKED
        *_, last = (frame for _, _, frames in stages(trajectory) for frame in frames)
        try:
            end = read_curve(self.folder / CURVE)
        except CurveError:
            return APART
        if not np.array_equal(end.vertices, last):
            return APART
        for curve in (end, *(each.polygon(each.sizes) for each in (self.smooth,) if each)):
            if name not in {each.removeprefix("m") for each in knot_type(curve).names}:
                return UNLIKE
        return "" if self.smooth is None or is_at_rest(self.rest) else MOVING


@dataclass
class Runs:
    """Runs by the names of the table, in its order, and the names of the runs left out, by reason."""

    by_type: dict[str, list[AtlasRun]] = field(default_factory=lambda: defaultdict(list))
    left_out: dict[str, list[str]] = field(default_factory=lambda: defaultdict(list))

    @classmethod
    def of(cls, directories: Iterable[Path]) -> "Runs":
        """The runs in directories that batches wrote to, each once; a MobiusFlowError if there are none."""
        found = cls()
        for directory in {directory.resolve(): directory for directory in directories}.values():
            for folder, report, row in results(directory):
                try:
                    curve = None if row.kind == TIGHT else FourierCurve.of_lists(report["smooth"])
                except (KeyError, TypeError, ValueError):
                    found.left_out[SMOOTH].append(folder.name)
                    continue
                name, mirrored = _type_of(row)
                if not (row.certified and row.verified):
                    found.left_out[CHECKED].append(folder.name)
                elif not name:
                    found.left_out[PROVED].append(folder.name)
                else:
                    curve = curve.mirrored if curve and mirrored else curve
                    found.by_type[name].append(AtlasRun(row, folder, curve, json.dumps(report["files"])))
        if not found.by_type:
            raise MobiusFlowError(f"there is nothing for an atlas: {found.missing}")
        for each in found.by_type.values():
            each.sort(key=lambda run: (run.row.name, run.row.start, run.mark))
        found.by_type = {name: found.by_type[name] for name in KNOTS if name in found.by_type}
        return found

    @property
    def missing(self) -> str:
        """The runs left out, and why."""
        return "; ".join(
            f"{counted(len(names), 'run')} {why}: {', '.join(names[:8])}{', …' * (len(names) > 8)}"
            for why, names in self.left_out.items()
        )


def _type_of(row: Row) -> tuple[str, bool]:
    """The table's name of the type that a run, which keeps it, began with or ended as, and whether it is mirrored."""
    made = row.input_sha256 is None and row.type_before == row.type_after
    for name, known in ((row.name, made), (row.type_after or "", row.proved)):
        with suppress(MobiusFlowError):
            if known:
                return table_name(name)
    return "", False


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
        good, tight = [list[AtlasRun]() for _ in range(2)]
        for run in by_doubt.pop("", []):
            (good if run.smooth else tight).append(run)
        if tight and not good:
            by_doubt[ALONE] += tight
        left_out = {reason: [run.folder.name for run in each] for reason, each in by_doubt.items()}
        groups = enumerate(distinct([run.rest for run in good]), start=1)
        minima = [{"number": number} | _described(name, [good[k] for k in group]) for number, group in groups]
        made = {"type": name, "lower_bound": lower_bound(name), "runs": len(good), **_shortest(tight), "minima": minima}
        known = {"made_from": made_from, "entry": made if good else None, "left_out": left_out}
    folder.put(file, json.dumps(known) + "\n")
    return known["entry"], known["left_out"]


def _shortest(runs: Sequence[AtlasRun]) -> Values:
    """The ropelength of the shortest rope, and what is proved to be no less than the type's."""
    ropes = [(curve.length / thickness(curve), curve) for curve in (read_curve(run.folder / CURVE) for run in runs)]
    least, rope = min(ropes, key=itemgetter(0), default=(None, None))
    bound = None
    with suppress(CurveError):
        bound = ropelength_bound(rope) if rope else None
    return {"tight_ropelength": least, "ropelength_bound": bound}


def curve_of(minimum: Mapping[str, Any]) -> FourierCurve:
    """The smooth curve of an entry's minimum."""
    return FourierCurve.of_lists(minimum["fourier"])


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
    name, file = row.name, ""
    if row.input_sha256 is not None:
        name, file = "FILE", f"  # SHA-256 of FILE: {one_line(row.input_sha256)}"
    given: list[str] = []
    values = json.loads(row.options)
    for option in declared(RelaxOptions):
        if value := values.get(option.name):
            text = ",".join(map(str, value)) if isinstance(value, list) else str(value)
            given += [flag(option)] if option.kind is bool else [flag(option), text]
    words = [name, "--starts", str(row.start), *seed, *given, "--extrapolate"]
    return shlex.join(["mobius-flow", "batch", *words, "-o", "results"]) + file


def standing(curve: Curve, group: SymmetryGroup) -> FloatArray:
    """The rotation, shape (3, 3), that turns a curve's axis of highest order into the third axis.

    Without one of order three or more it is the direction in which the curve extends least. The second axis is one of
    order two if there is one across, and otherwise points to where the curve is farthest away.
    """
    points, axes = curve.vertices - group.centre, []
    table = multiplication(group.matrices)
    for number, matrix in enumerate(group.matrices):
        order, sign = order_of(table, number), np.linalg.det(matrix)
        turn = Rotation.from_matrix(sign * matrix).as_rotvec()
        if order > 2 or (order == 2 and sign > 0.0):  # no reflection in a plane or a point
            axes.append((order, turn / np.linalg.norm(turn)))
    order, up = max(axes, key=lambda each: each[0], default=(1, points[0]))
    if order < 3:
        up = np.linalg.svd(points, full_matrices=False)[2][2]
    flat = points - np.outer(points @ up, up)
    twofold = [axis for order, axis in axes if order == 2 and abs(axis @ up) < 0.1]  # a right angle
    far = max([*twofold, *(-axis for axis in twofold)], key=lambda axis: float((flat @ axis).max()), default=None)
    second = flat[np.linalg.norm(flat, axis=1).argmax()] if far is None else far - (far @ up) * up
    second = second / np.linalg.norm(second)
    return np.array([np.cross(second, up), second, up])
