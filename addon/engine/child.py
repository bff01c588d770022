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
from pathlib import Path
from typing import Any

_PACKAGE = "_mobius_flow_worker"


def main() -> None:
    """Do the job that is read from standard input, and send the results to standard output."""
    root = Path(__file__).resolve().parents[2]
    spec = importlib.util.spec_from_file_location(
        _PACKAGE, root / "__init__.py", submodule_search_locations=[str(root)]
    )
    assert spec is not None
    assert spec.loader is not None
    sys.modules[_PACKAGE] = package = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(package)
    wire = importlib.import_module(f"{_PACKAGE}.addon.engine.wire")
    worker = importlib.import_module(f"{_PACKAGE}.addon.engine.worker")
    inbox: queue.SimpleQueue[Any] = queue.SimpleQueue()

    def take_in() -> None:
        with contextlib.suppress(EOFError, OSError):  # the input ends when Blender closes it, crashes or is killed
            while True:
                inbox.put(wire.read(sys.stdin.buffer))
        os._exit(0)

    threading.Thread(target=take_in, daemon=True).start()
    with contextlib.suppress(BrokenPipeError), os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)  # whatever a library prints must not get in between
        for reply in worker.messages(inbox):
            wire.write(out, reply)
    os._exit(0)  # the thread still reads


if __name__ == "__main__":
    main()
