"""The command ``mobius-flow``, the same as ``python -m mobius_flow``."""

import sys


def main() -> int:
    """Run the command line and return its exit status."""
    try:
        # relative, so that it is the same program however the package is called
        from .cli.main import process

        return process()
    except KeyboardInterrupt:  # in the moment before signals are handled
        print("mobius-flow: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
