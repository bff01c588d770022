"""The runs of batches, by the types that they ended as, and the runs that are left out."""

import json
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from ...core import MobiusFlowError
from ...core.curve.fourier import FourierCurve
from ...core.errors import counted
from ...core.knots import KNOTS
from ...core.knots.names import table_name
from ...core.smooth.rest import Rest
from ..batch.folder import results
from ..batch.table import Row

SMOOTH = "without a smooth shape (run batch with --extrapolate)"
CHECKED = "that verify did not accept"
PROVED = "whose type is not proved to be one of the table"
_SHOWN = 8  # names listed of the runs that are left out


@dataclass(frozen=True, eq=False)
class Run:
    """A run that ended as a knot or link of the table, and the smooth curve of the table's chirality that it led to."""

    row: Row
    curve: FourierCurve
    mark: str  # the hash of its results

    @property
    def rest(self) -> Rest:
        """The curve at rest."""
        return Rest(self.curve, self.row.extrapolated_energy or 0.0, self.row.extrapolated_energy_error or 0.0)


@dataclass
class Runs:
    """Runs by the names of the table, in its order, and the names of the runs left out, by reason."""

    by_type: dict[str, list[Run]] = field(default_factory=lambda: defaultdict(list))
    left_out: dict[str, list[str]] = field(default_factory=lambda: defaultdict(list))

    @classmethod
    def of(cls, directories: Iterable[Path]) -> "Runs":
        """The runs in directories that batches wrote to, each once; a MobiusFlowError if there are none."""
        found = cls()
        for directory in {directory.resolve(): directory for directory in directories}.values():
            for folder, report, row in results(directory):
                found._add(folder, report, row)
        if not found.by_type:
            raise MobiusFlowError(f"there is nothing for an atlas: {found.missing}")
        found.by_type = {name: sorted(found.by_type[name], key=_order) for name in KNOTS if name in found.by_type}
        return found

    @property
    def missing(self) -> str:
        """The runs left out, and why."""
        return "; ".join(_told(why, names) for why, names in self.left_out.items())

    def _add(self, folder: Path, report: Mapping[str, object], row: Row) -> None:
        name, mirrored = _type_of(row)
        try:
            curve = FourierCurve.of_lists(report["smooth"])  # type: ignore[arg-type]
        except (KeyError, TypeError, ValueError):
            self.left_out[SMOOTH].append(folder.name)
            return
        if not (row.certified and row.verified):
            self.left_out[CHECKED].append(folder.name)
        elif not name:
            self.left_out[PROVED].append(folder.name)
        else:
            curve = curve.mirrored if mirrored else curve
            self.by_type[name].append(Run(row, curve, json.dumps(report["files"])))


def _type_of(row: Row) -> tuple[str, bool]:
    """The table's name of the type that a run, which keeps it, began with or ended as, and whether it is mirrored."""
    made = row.input_sha256 is None and row.type_before == row.type_after
    for name, known in ((row.name, made), (row.type_after or "", row.proved)):
        with suppress(MobiusFlowError):
            if known:
                return table_name(name)
    return "", False


def _order(run: Run) -> tuple[str, int, str]:
    return run.row.name, run.row.start, run.mark


def _told(why: str, names: Sequence[str]) -> str:
    more = ", …" if len(names) > _SHOWN else ""
    return f"{counted(len(names), 'run')} {why}: {', '.join(names[:_SHOWN])}{more}"
