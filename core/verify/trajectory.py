"""Read trajectory files frame by frame, trusting nothing in them.

A file is a zip archive of .npy arrays, as numpy.savez writes it: ``stage_000``, ``stage_001``, … each (k, n, m) float64
in C order, and ``component_sizes_000``, … with the numbers of vertices of the components. Only one frame is in memory
at a time, and memory is taken only for data that the file really has.
"""

import ast
import struct
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np

from ..types import FloatArray

_MAX_HEADER = 1000
_MAX_FRAME = 1 << 28  # bytes: eleven million vertices in space
_MAX_SIZES = 1 << 24  # bytes
_DAMAGE = (OSError, EOFError, zipfile.BadZipFile, zlib.error, struct.error, NotImplementedError, RuntimeError)


class TrajectoryError(ValueError):
    """A file that is no trajectory; the message says why."""


@dataclass(frozen=True, eq=False)
class Stage:
    """One stage: the name of its array, the components' sizes, and the frames, each (n, m), to be read once."""

    name: str
    component_sizes: tuple[int, ...]
    frames: Iterator[FloatArray]


def stages(path: Path | str) -> Iterator[Stage]:
    """Yield the stages of a file, in order.

    Raises
    ------
    TrajectoryError
        If the file is none or is damaged, also while frames are read.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            for number in range(_count(archive)):
                yield _stage(archive, number)
    except _DAMAGE as error:
        raise TrajectoryError(f"the file cannot be read: {error}") from error


def _count(archive: zipfile.ZipFile) -> int:
    names = archive.namelist()
    found = sorted(name for name in names if name.startswith("stage_"))
    wanted = [f"stage_{k:03d}.npy" for k in range(len(found))]
    if not found or found != sorted(wanted):
        raise TrajectoryError("the stages are not numbered stage_000, stage_001, …, each once")
    return len(found)


def _stage(archive: zipfile.ZipFile, number: int) -> Stage:
    sizes = _component_sizes(archive, f"component_sizes_{number:03d}")
    name = f"stage_{number:03d}"
    file = archive.open(f"{name}.npy")
    shape, dtype = _header(file, name)
    if dtype != np.dtype("<f8") or len(shape) != 3:
        raise TrajectoryError(f"{name} is an array {shape} of {dtype}; it must be (k, n, m) of float64")
    k, n, m = shape
    if n != sum(sizes):
        raise TrajectoryError(f"{name} has {n} vertices, but its components have {sum(sizes)}")
    if k < 1 or m not in (2, 3):
        raise TrajectoryError(f"{name} has shape {shape}; frames there must be, in dimension 2 or 3")
    if n * m * 8 > _MAX_FRAME:
        raise TrajectoryError(f"{name} has {n} vertices, more than this program takes")
    return Stage(name, sizes, _frames(file, name, k, (n, m)))


def _component_sizes(archive: zipfile.ZipFile, name: str) -> tuple[int, ...]:
    if f"{name}.npy" not in archive.namelist():
        raise TrajectoryError(f"{name} is missing")
    with archive.open(f"{name}.npy") as file:
        shape, dtype = _header(file, name)
        if dtype.kind not in "iu" or len(shape) != 1 or not 0 < shape[0] * dtype.itemsize <= _MAX_SIZES:
            raise TrajectoryError(f"{name} is an array {shape} of {dtype}; it must be a list of whole numbers")
        data = _exactly(file, shape[0] * dtype.itemsize, name)
    sizes = tuple(np.frombuffer(data, dtype).tolist())
    if min(sizes) < 3:
        raise TrajectoryError(f"{name} has a component with {min(sizes)} vertices; a closed polygon has 3 or more")
    return sizes


def _header(file: IO[bytes], name: str) -> tuple[tuple[int, ...], "np.dtype[np.generic]"]:
    """Shape and type of an array, from a .npy header of bounded length."""
    magic = _exactly(file, 8, name)
    if magic not in (b"\x93NUMPY\x01\x00", b"\x93NUMPY\x02\x00"):
        raise TrajectoryError(f"{name} is not an array in NumPy's format 1.0 or 2.0")
    length = int.from_bytes(_exactly(file, 2 if magic[6] == 1 else 4, name), "little")
    if length > _MAX_HEADER:
        raise TrajectoryError(f"{name} has a header of {length} bytes, which is too long")
    try:
        header = ast.literal_eval(_exactly(file, length, name).decode("latin1"))
        shape, fortran = tuple(map(int, header["shape"])), bool(header["fortran_order"])
        dtype = np.dtype(str(header["descr"]))
    except (ValueError, SyntaxError, TypeError, KeyError, MemoryError, RecursionError) as error:
        raise TrajectoryError(f"{name} has a header that cannot be read") from error
    if min(shape, default=0) < 0 or (fortran and len(shape) > 1):
        raise TrajectoryError(f"{name} has a negative shape or is in Fortran order; neither is read")
    return shape, dtype


def _frames(file: IO[bytes], name: str, count: int, shape: tuple[int, int]) -> Iterator[FloatArray]:
    with file:
        for k in range(count):
            data = _exactly(file, 8 * shape[0] * shape[1], name)
            frame = np.frombuffer(data, "<f8").reshape(shape).astype(np.float64)
            if not np.isfinite(frame).all():
                raise TrajectoryError(f"{name}, frame {k}: a coordinate is not finite")
            yield frame
        if file.read(1):
            raise TrajectoryError(f"{name} is longer than its header says")


def _exactly(file: IO[bytes], count: int, name: str) -> bytes:
    """Read ``count`` bytes, in pieces, so that memory grows only with what is really there."""
    pieces = []
    while count:
        piece = file.read(min(count, 1 << 20))
        if not piece:
            raise TrajectoryError(f"{name} is shorter than its header says")
        pieces.append(piece)
        count -= len(piece)
    return b"".join(pieces)
