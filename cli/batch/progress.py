"""How far a batch is, on a terminal."""

import sys
from typing import TYPE_CHECKING

from ..progress import WithBar
from .table import Row

if TYPE_CHECKING:
    from distributed import Client


class Progress(WithBar):
    """A bar of the runs that are done, with the numbers of those that failed and that are running, and the time left.

    Above it stands where the cluster's dashboard is, if it has one.
    """

    def __init__(self, client: "Client", total: int, shown: bool) -> None:
        self._client, self._failed = client, 0
        if shown and _has_dashboard(client):
            print(f"mobius-flow: dashboard at {client.dashboard_link}", file=sys.stderr)
        super().__init__(shown, total=total, unit="run", smoothing=0.1)

    def show(self, row: Row) -> None:
        """Count a run that has ended."""
        self._failed += row.failed
        if self._bar is not None:
            left = self._bar.total - self._bar.n - 1
            running = min(left, sum(self._client.nthreads().values()))
            self._bar.set_postfix_str(f"{self._failed} failed, {running} running", refresh=False)
            self._bar.update()


def _has_dashboard(client: "Client") -> bool:
    """Whether the scheduler shows one: there is a link even where bokeh is missing, or nobody wants it."""

    def loaded() -> bool:  # a local function travels by value: the scheduler need not have this package
        return "distributed.dashboard.scheduler" in sys.modules

    return bool(client.run_on_scheduler(loaded))
