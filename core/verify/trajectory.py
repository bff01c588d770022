"""Read trajectory files frame by frame, trusting nothing in them.

A file is a zip archive of .npy arrays, as numpy.savez writes it: ``stage_000``, ``stage_001``, … each (k, n, m) and
float64, and ``component_sizes_000``, … with the numbers of vertices of the components. Where some of them are open
polygons, ``component_closed_000``, … says which are closed; without it all are. There may be obstacles,
``obstacle_000_vertices``, … each (k, 3) and float64, and ``obstacle_000_faces``, … each (f, 3) or (f, 2), of whole
numbers, at least one; and ``pins``, (k, m) and float64, the points at which a vertex stays. Of the stages only one
frame is in memory at a time (in Fortran order, one stage of bounded size), and memory is taken only for data that the
file really has.
"""

import ast
import math
import operator
import struct
import zipfile
import zlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..types import FloatArray, IntArray

_MAX_HEADER = 1000
_MAX_FRAME = 1 << 25  # bytes: over a million vertices in space
_MAX_FORTRAN = 1 << 28  # bytes of a whole stage in Fortran order, whose frames are scattered over it
_MAX_SIZES = 1 << 24  # bytes
_MAX_TABLE = 1 << 28  # bytes of one array of an obstacle, or of pins
_PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # what NumPy writes
_DAMAGE = (OSError, EOFError, zipfile.BadZipFile, zlib.error, struct.error, NotImplementedError, RuntimeError)


class TrajectoryError(ValueError):
    """A file that is not a trajectory; the message says why."""


@dataclass(frozen=True)
class Component:
    """The number of vertices of a polygon, and whether an edge leads from the last to the first."""

    size: int
    closed: bool


Components = Sequence[Component]


@dataclass(frozen=True, eq=False)
class Stage:
    """One stage: the name of its array, the components, and the frames, each (n, m), to be read once."""

    name: str
    components: Components
    frames: Iterator[FloatArray]


def stages(path: Path | str) -> Iterator[Stage]:
    """Yield the stages in order, frames to be read before the next; a TrajectoryError if the file is damaged."""
    with _opened(path) as archive:
        for number in range(_count(archive)):
            components = _components(archive, number)
            with _member(archive, f"stage_{number:03d}") as array:
                yield Stage(array.name, components, _frames(array, sum(each.size for each in components)))


def obstacle_parts(path: Path | str) -> list[tuple[FloatArray, IntArray]]:
    """The obstacles of a file: vertices, shape (k, 3), and indices of simplices, shape (f, 2 or 3), of each."""
    with _opened(path) as archive:
        found = sorted(name for name in archive.namelist() if name.startswith("obstacle_"))
        names = [f"obstacle_{k:03d}" for k in range(len(found) // 2)]
        if found != sorted(f"{name}_{part}.npy" for name in names for part in ("faces", "vertices")):
            raise TrajectoryError("the obstacles are not numbered obstacle_000, …, each with vertices and faces")
        return [_obstacle(archive, name) for name in names]


def pinned_points(path: Path | str) -> FloatArray:
    """The places of the pins of a file, shape (k, m); (0, 0) if it has none. Raises as `stages` does."""
    with _opened(path) as archive:
        if "pins.npy" not in archive.namelist():
            return np.empty((0, 0))
        points = _table(archive, "pins", "f")
    if points.dtype != np.dtype("<f8") or not np.isfinite(points).all():
        raise TrajectoryError(f"pins is a table of {points.dtype}; it must be one of finite numbers, float64")
    return np.array(points, dtype=np.float64, order="C")


def count_legs(path: Path | str) -> int:
    """Number of legs in a file according to the headers of its stages, as far as these can be read."""
    legs = 0
    with suppress(TrajectoryError), _opened(path) as archive:
        for number in range(_count(archive)):
            with _member(archive, f"stage_{number:03d}") as array:
                legs += max(array.shape[0] - 1, 0) if array.shape else 0
    return legs


@contextmanager
def _opened(path: Path | str) -> Iterator[zipfile.ZipFile]:
    """The archive; any damage met while it is read is a TrajectoryError."""
    try:
        with zipfile.ZipFile(path) as archive:
            yield archive
    except TrajectoryError:
        raise
    except (*_DAMAGE, ValueError) as error:  # ValueError: a path with a null character
        raise TrajectoryError(f"the file cannot be read: {getattr(error, 'strerror', None) or error}") from error


def _count(archive: zipfile.ZipFile) -> int:
    names = archive.namelist()
    if len(set(names)) < len(names):
        raise TrajectoryError("the file has two arrays of one name")
    found = sorted(name for name in names if name.startswith("stage_"))
    if not found or found != sorted(f"stage_{k:03d}.npy" for k in range(len(found))):
        raise TrajectoryError("the stages are not numbered stage_000, stage_001, …, each once")
    return len(found)


def _components(archive: zipfile.ZipFile, number: int) -> Components:
    name, flags = f"component_sizes_{number:03d}", f"component_closed_{number:03d}"
    sizes = _list(archive, name, "iu", "whole numbers")
    closed = [True] * len(sizes)
    if f"{flags}.npy" in archive.namelist():
        closed = list(map(bool, _list(archive, flags, "b", "truth values")))
    if len(closed) != len(sizes):
        raise TrajectoryError(f"{flags} tells of {len(closed)} components, {name} of {len(sizes)}")
    for size, is_closed in zip(sizes, closed, strict=True):
        if size < (least := 3 if is_closed else 2):
            kind = "a closed polygon" if is_closed else "an open polygon"
            raise TrajectoryError(f"{name} has a component with {size} vertices; {kind} has {least} or more")
    return [Component(*each) for each in zip(sizes, closed, strict=True)]


def _frames(array: "_Array", vertices: int) -> Iterator[FloatArray]:
    """The frames of a stage with a number of vertices, read while its file is open."""
    name, shape = array.name, array.shape
    if array.dtype != np.dtype("<f8") or len(shape) != 3:
        raise TrajectoryError(f"{name} is an array {shape} of {array.dtype}; it must be (k, n, m) of float64")
    k, n, m = shape
    if n != vertices:
        raise TrajectoryError(f"{name} has {n} vertices, but its components have {vertices}")
    if k < 1 or m not in (2, 3):
        raise TrajectoryError(f"{name} has shape {shape}; frames there must be, in dimension 2 or 3")
    if n * m * 8 > _MAX_FRAME:
        raise TrajectoryError(f"{name} has {n} vertices, more than this program takes")
    if array.fortran and k * n * m * 8 > _MAX_FORTRAN:
        raise TrajectoryError(f"{name} is in Fortran order and large; write it with numpy.ascontiguousarray")
    return (_finite(name, k, frame) for k, frame in enumerate(array.whole() if array.fortran else array.one_by_one()))


def _finite(name: str, k: int, frame: NDArray[Any]) -> FloatArray:
    if not np.isfinite(frame).all():
        raise TrajectoryError(f"{name}, frame {k}: a coordinate is not finite")
    return np.array(frame, dtype=np.float64, order="C")


def _obstacle(archive: zipfile.ZipFile, name: str) -> tuple[FloatArray, IntArray]:
    vertices, faces = _table(archive, f"{name}_vertices", "f"), _table(archive, f"{name}_faces", "iu")
    if vertices.dtype != np.dtype("<f8") or vertices.shape[1] != 3:
        found = f"{vertices.shape} of {vertices.dtype}"
        raise TrajectoryError(f"{name}_vertices is an array {found}; it must be (k, 3) of float64")
    if faces.shape[1] not in (2, 3):
        raise TrajectoryError(f"{name}_faces has shape {faces.shape}; it must be (f, 3) or (f, 2)")
    if not len(faces):
        raise TrajectoryError(f"{name}_faces is empty; an obstacle has at least one")
    if not np.isfinite(vertices).all():
        raise TrajectoryError(f"{name}_vertices: a coordinate is not finite")
    if not (faces.min() >= 0 and faces.max() < len(vertices)):
        raise TrajectoryError(f"{name}_faces: an index has no vertex")
    return np.array(vertices, dtype=np.float64, order="C"), faces.astype(np.intp)


def _list(archive: zipfile.ZipFile, name: str, kinds: str, what: str) -> list[int]:
    with _member(archive, name) as array:
        if array.dtype.kind not in kinds or len(array.shape) != 1 or not 0 < array.size <= _MAX_SIZES:
            raise TrajectoryError(f"{name} is an array {array.shape} of {array.dtype}; it must be a list of {what}")
        return list(map(int, array.whole().tolist()))


def _table(archive: zipfile.ZipFile, name: str, kinds: str) -> NDArray[Any]:
    with _member(archive, name) as array:
        if array.dtype.kind not in kinds or len(array.shape) != 2:
            raise TrajectoryError(f"{name} is an array {array.shape} of {array.dtype}; it must be a table of numbers")
        if array.size > _MAX_TABLE:
            raise TrajectoryError(f"{name} has {array.shape[0]} rows, more than this program takes")
        return array.whole()


@contextmanager
def _member(archive: zipfile.ZipFile, name: str) -> Iterator["_Array"]:
    if f"{name}.npy" not in archive.namelist():
        raise TrajectoryError(f"{name} is missing")
    if archive.getinfo(f"{name}.npy").compress_type not in _PACKED:
        raise TrajectoryError(f"{name} is packed by a method that NumPy does not use; write it with numpy.savez")
    with archive.open(f"{name}.npy") as file:
        yield _Array(name, file)


class _Array:
    """An array whose header has been read, but not trusted: shape, type, and order of its entries."""

    def __init__(self, name: str, file: IO[bytes]) -> None:
        self.name, self._file = name, file
        magic = self._read(8)
        if magic not in (b"\x93NUMPY\x01\x00", b"\x93NUMPY\x02\x00"):
            raise TrajectoryError(f"{name} is not an array in NumPy's format 1.0 or 2.0")
        length = int.from_bytes(self._read(2 if magic[6] == 1 else 4), "little")
        if length > _MAX_HEADER:
            raise TrajectoryError(f"{name} has a header of {length} bytes, which is too long")
        text = self._read(length).decode("latin1")
        try:
            header = ast.literal_eval(text)
            self.shape = tuple(map(operator.index, header["shape"]))
            self.fortran, self.dtype = bool(header["fortran_order"]), np.dtype(str(header["descr"]))
        except (ValueError, SyntaxError, TypeError, KeyError, MemoryError, RecursionError) as error:
            raise TrajectoryError(f"{name} has a header that cannot be read") from error
        if min(self.shape, default=0) < 0:
            raise TrajectoryError(f"{name} has a negative shape")

    @property
    def size(self) -> int:
        return math.prod(self.shape) * self.dtype.itemsize

    def whole(self) -> NDArray[Any]:
        data = self._read(self.size)
        self._check_end()
        return np.frombuffer(data, self.dtype).reshape(self.shape, order="F" if self.fortran else "C")

    def one_by_one(self) -> Iterator[NDArray[Any]]:
        count, *shape = self.shape
        for _ in range(count):
            yield np.frombuffer(self._read(self.size // count), self.dtype).reshape(shape)
        self._check_end()

    def _check_end(self) -> None:
        if self._file.read(1):
            raise TrajectoryError(f"{self.name} is longer than its header says")

    def _read(self, count: int) -> bytes:
        """Read ``count`` bytes, in pieces, so that memory grows only with what is really there."""
        pieces = []
        while count:
            piece = self._file.read(min(count, 1 << 20))
            if not piece:
                raise TrajectoryError(f"{self.name} is shorter than its header says")
            pieces.append(piece)
            count -= len(piece)
        return b"".join(pieces)
