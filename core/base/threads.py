"""One BLAS thread for the library's own work, and none of it left behind.

NumPy and SciPy each bring a pool of BLAS threads, whose idle threads spin: next to other work the pools slow each other
down tenfold and more, where a thread each is as fast alone and never bad.
"""

import threading
from collections.abc import Generator, Iterator
from contextlib import closing, contextmanager
from functools import cached_property
from typing import Any, ClassVar, TypeVar

import numpy.linalg  # noqa: F401 (loads NumPy's BLAS)
import scipy.linalg  # noqa: F401 (loads SciPy's)
from threadpoolctl import ThreadpoolController

_Yielded = TypeVar("_Yielded")
_Returned = TypeVar("_Returned")


class BlasPools:
    """The BLAS pools of this process.

    A pool is the whole process's: while one thread is in a `bounded` block, the others have one BLAS thread as well.
    Blocks may nest, and those of several threads overlap; the last to end gives the pool its number back.  OpenMP's
    pools belong to the thread that calls, and so do their blocks.  Accelerate, on macOS, cannot be bounded.
    """

    threads: ClassVar[int] = 1  # of each pool while the library works

    def __init__(self) -> None:
        self._lock = threading.Lock()
        # of each pool that is held: by how many blocks, and its own number of threads
        self._held: dict[tuple[str, int | None], tuple[int, int]] = {}

    @cached_property
    def _controller(self) -> ThreadpoolController:
        return ThreadpoolController().select(user_api="blas")

    @contextmanager
    def bounded(self) -> Iterator[None]:
        """Do a block with one BLAS thread; also a decorator of functions."""
        with self._changing():
            for library in self._controller.lib_controllers:
                pool = _pool(library)
                blocks, threads = self._held.get(pool) or (0, library.num_threads)
                self._held[pool] = blocks + 1, threads
                if not blocks:
                    library.set_num_threads(self.threads)
        try:
            yield
        finally:
            with self._changing():
                for library in self._controller.lib_controllers:
                    blocks, threads = self._held.pop(pool := _pool(library))
                    if blocks > 1:
                        self._held[pool] = blocks - 1, threads
                    else:
                        library.set_num_threads(threads)

    def bounding(self, work: Generator[_Yielded, None, _Returned]) -> Generator[_Yielded, None, _Returned]:
        """The same generator with one BLAS thread: its consumer has its own."""
        with closing(work):
            while True:
                with self.bounded():
                    try:
                        value = next(work)
                    except StopIteration as end:
                        return end.value  # type: ignore[no-any-return]
                yield value

    @contextmanager
    def _changing(self) -> Iterator[None]:
        """Alone, and as threadpoolctl wants it: a thread that has set a number must not keep others from doing so."""
        with self._lock:
            yield
            with self._controller.limit(limits=None):
                pass


def _pool(library: Any) -> tuple[str, int | None]:
    """Whose number of threads a library's is: the process's, or the calling thread's."""
    own = getattr(library, "threading_layer", None) == "openmp"
    return library.filepath, threading.get_ident() if own else None


BLAS = BlasPools()
"""There is one, as there is one process."""
