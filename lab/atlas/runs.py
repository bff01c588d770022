"""The runs of batches, by the types that they ended as, and the runs that are left out."""

import json
from collections import defaultdict
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...core import CurveError, MobiusFlowError, read_curve
from ...core.base.errors import counted
from ...core.curve.fourier import FourierCurve
from ...core.knots import KNOTS, knot_type
from ...core.knots.names import table_name
from ...core.proof import stages, verify
from ..batch.folder import results
from ..batch.job import CURVE, TRAJECTORY
from ..batch.table import Row
from ..smooth.rest import RestingCurve, is_at_rest

SMOOTH = "without a smooth shape (run batch with --extrapolate)"
CHECKED = "that verify did not accept"
PROVED = "whose type is not proved to be one of the table"
APART = "whose trajectory does not end at their curve"
UNLIKE = "whose curve, or smooth shape, is not of the type reported"
MOVING = "whose smooth shape is not at rest with the energy reported"


@dataclass(frozen=True, eq=False)
class AtlasRun:
    """A run that ended as a knot or link of the table, and the smooth curve of the table's chirality that it led to."""

    row: Row
    folder: Path
    curve: FourierCurve
    mark: str  # the hash of its results

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
        for curve in (end, self.curve.polygon(self.curve.sizes)):
            if name not in {each.removeprefix("m") for each in knot_type(curve).names}:
                return UNLIKE
        return "" if is_at_rest(self.rest) else MOVING


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
                    curve = FourierCurve.of_lists(report["smooth"])
                except (KeyError, TypeError, ValueError):
                    found.left_out[SMOOTH].append(folder.name)
                    continue
                name, mirrored = _type_of(row)
                if not (row.certified and row.verified):
                    found.left_out[CHECKED].append(folder.name)
                elif not name:
                    found.left_out[PROVED].append(folder.name)
                else:
                    curve = curve.mirrored if mirrored else curve
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
