"""The worker's program: relaxes a curve, which a hand may drag, in its own process, and ends when Blender does.

Blender runs this file by its path, with its own Python. The package is loaded under a private name, because in
Blender it is called something like ``bl_ext.user_default.mobius_flow``, which a plain Python cannot import.
"""

import contextlib
import importlib
import importlib.util
import os
import queue
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

_PACKAGE = "_mobius_flow_worker"


def main() -> None:
    """Do the job that is read from standard input, and send the results to standard output."""
    _load_package(Path(__file__).resolve().parents[2])
    wire = importlib.import_module(f"{_PACKAGE}.addon.engine.wire")
    worker = importlib.import_module(f"{_PACKAGE}.addon.engine.worker")
    inbox: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_take_in, args=(wire.read, inbox), daemon=True).start()
    with contextlib.suppress(BrokenPipeError), os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)  # whatever a library prints must not get in between
        for reply in worker.messages(inbox):
            wire.write(out, reply)
    os._exit(0)  # the thread still reads


def _load_package(root: Path) -> None:
    spec = importlib.util.spec_from_file_location(
        _PACKAGE, root / "__init__.py", submodule_search_locations=[str(root)]
    )
    assert spec is not None
    assert spec.loader is not None
    package = importlib.util.module_from_spec(spec)
    sys.modules[_PACKAGE] = package
    spec.loader.exec_module(package)


def _take_in(read: Callable[[IO[bytes]], Any], inbox: "queue.SimpleQueue[Any]") -> None:
    """Put Blender's messages into the inbox; the input ends when Blender closes it, crashes or is killed."""
    with contextlib.suppress(EOFError, OSError):
        while True:
            inbox.put(read(sys.stdin.buffer))
    os._exit(0)


if __name__ == "__main__":
    main()
