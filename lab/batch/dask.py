"""Dask's own command, also where SnapPy is installed: ``python -m mobius_flow.lab.batch.dask worker tcp://HEAD:8786``.

dask.distributed takes any module called snappy for python-snappy, a compression library, and fails to load if it
is SnapPy. Worker processes started by others load this module first, too.
"""

import sys


def import_distributed() -> None:
    """Import dask.distributed as if there were no module called snappy; raises ImportError."""
    others = {name: module for name, module in sys.modules.items() if name == "snappy"}
    sys.modules["snappy"] = None  # type: ignore[assignment]  # which makes its import an ImportError
    try:
        import distributed  # noqa: F401
    finally:
        del sys.modules["snappy"]
        sys.modules.update(others)


if __name__ in ("__main__", "__mp_main__"):
    import_distributed()

if __name__ == "__main__":
    from dask.__main__ import main

    main()
