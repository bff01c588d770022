"""Relax knots on all cores, without the command line: python examples/table_of_knots.py 3_1 4_1 8_19

Client("tcp://HOST:PORT") has it done by a cluster.
"""

import sys
from collections.abc import Sequence

from dask.distributed import Client, as_completed
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.knots import knot


def relaxed(name: str) -> tuple[str, int, float, str]:
    """Relax a knot; Dask's processes have one BLAS thread each."""
    result = minimize(knot(name), RelaxOptions(tolerance=1e-3))
    return name, len(result.curve), result.final_energy, result.status.value


def main(names: Sequence[str]) -> None:
    """Print a line for each knot, as they come."""
    with Client(threads_per_worker=1, dashboard_address="127.0.0.1:0") as client:
        for future in as_completed(client.map(relaxed, names)):
            print("{:8} {:5d} {:10.4f}  {}".format(*future.result()), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
