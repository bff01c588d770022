"""The command ``mobius-flow``, the same as ``python -m mobius_flow``."""

import sys


def main() -> int:
    """Run the command line and return its exit status."""
    # relative, so that it is the same program however the package is called
    from .cli import main as run

    return run()


if __name__ == "__main__":
    sys.exit(main())
