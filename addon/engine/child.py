"""The worker's program: relaxes a curve, which a hand may drag, in its own process, and ends when Blender does.

Blender runs this file by its path, with its own Python, and tells it what this package is called there, something like
``bl_ext.user_default.mobius_flow.addon.engine``: a plain Python cannot import that, but what is pickled refers to it.
"""

import contextlib
import importlib
import importlib.util
import os
import pickle
import queue
import sys
import threading
from pathlib import Path
from types import ModuleType
from typing import Any


def main(engine: str) -> None:
    """Do the job that is read from standard input, and send the results to standard output."""
    *parents, name = engine.split(".")[:-2]
    for k in range(len(parents)):
        sys.modules[".".join(parents[: k + 1])] = ModuleType(parents[k])
    root = Path(__file__).resolve().parents[2]
    spec = importlib.util.spec_from_file_location(
        ".".join([*parents, name]), root / "__init__.py", submodule_search_locations=[str(root)]
    )
    assert spec is not None
    assert spec.loader is not None
    sys.modules[spec.name] = package = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(package)
    worker = importlib.import_module(f"{engine}.worker")
    inbox: queue.Queue[Any] = queue.Queue()

    def take_in() -> None:
        with contextlib.suppress(EOFError, OSError, pickle.UnpicklingError):  # Blender closes it, crashes or is killed
            while True:
                inbox.put(pickle.load(sys.stdin.buffer))
        os._exit(0)

    threading.Thread(target=take_in, daemon=True).start()
    with contextlib.suppress(BrokenPipeError), os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)  # whatever a library prints must not get in between
        for reply in worker.messages(inbox):
            pickle.dump(reply, out)
            out.flush()
    os._exit(0)  # the thread still reads


if __name__ == "__main__":
    main(sys.argv[1])
