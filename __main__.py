"""The command ``mobius-flow``, the same as ``python -m mobius_flow``."""

import os
import sys

# NumPy and SciPy each bring an OpenBLAS whose idle threads spin; on a machine with other work to do the two pools
# slow each other down tenfold and more.  One thread each is as fast alone and never bad.  Set before NumPy is imported.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def main() -> int:
    """Run the command line and return its exit status."""
    try:
        # relative, so that it is the same program however the package is called
        from .cli.process import run

        return run()
    except KeyboardInterrupt:  # in the moment before signals are handled
        print("mobius-flow: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
