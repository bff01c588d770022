"""Messages between Blender and its worker: a line of JSON and raw arrays of doubles, all with their lengths."""

import hashlib
import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from types import MappingProxyType
from typing import IO, Any

import numpy as np

from ...core import Curve, Iterate, Mesh, Obstacle, Outcome, RelaxOptions, Status, Task
from ...core.base.errors import CurveError, MobiusFlowError, OptionError, Place
from ...core.base.messages import Message
from ...core.base.types import FloatArray
from ...core.keys.placement import Link, Placement

Packet = tuple[dict[str, Any], list[FloatArray]]

_LENGTH = struct.Struct("!Q")
_VALUES = tuple(field.name for field in fields(Iterate) if field.name not in ("curve", "path"))


def write(stream: IO[bytes], message: Packet) -> None:
    header, arrays = message
    text = json.dumps({**header, "shapes": [a.shape for a in arrays]}).encode()
    data = [np.ascontiguousarray(a, dtype=np.float64).tobytes() for a in arrays]
    stream.write(b"".join([_LENGTH.pack(len(text)), text, *data]))
    stream.flush()


def read(stream: IO[bytes]) -> Packet:
    """Read a message; EOFError if no whole one is left."""
    header = json.loads(_exactly(stream, _LENGTH.unpack(_exactly(stream, _LENGTH.size))[0]))
    arrays = []
    for shape in header.pop("shapes"):
        data = bytearray(_exactly(stream, 8 * int(np.prod(shape))))
        arrays.append(np.frombuffer(data, dtype=np.float64).reshape(shape))
    return header, arrays


def _exactly(stream: IO[bytes], size: int) -> bytes:
    data = stream.read(size)
    if len(data) < size:
        raise EOFError
    return data


def pack_job(
    task: Task,
    options: RelaxOptions,
    link: Link,
    stays: bool = False,
    goals: Mapping[str, Curve] = MappingProxyType({}),
) -> Packet:
    header = {**_pack_mesh(task.curve.mesh), "options": asdict(options), "counts": link.counts, "stays": stays}
    header |= {
        "pins": task.pins,
        "pin_tangents": task.pin_tangents,
        "obstacles": [each.name for each in task.obstacles],
        "goals": {name: _pack_mesh(each.mesh) for name, each in goals.items()},
    }
    linear = np.stack([placement.linear for placement in link.placements])
    origins = np.stack([placement.origin for placement in link.placements])
    obstacles = [array for each in task.obstacles for array in (each.vertices, each.faces.astype(np.float64))]
    return header, [task.curve.vertices, linear, origins, *obstacles, *(each.vertices for each in goals.values())]


def unpack_job(message: Packet) -> tuple[Task, RelaxOptions, Link]:
    header, (vertices, linear, origins, *arrays) = message
    link = Link(tuple(map(Placement, linear, origins)), tuple(header["counts"]))
    arrays = arrays[: 2 * len(header["obstacles"])]
    faces = [each.astype(np.intp) for each in arrays[1::2]]
    task = Task(
        curve=Curve(vertices, _unpack_mesh(header)),
        obstacles=tuple(map(Obstacle, arrays[::2], faces, header["obstacles"])),
        pins=header["pins"],
        pin_tangents=header["pin_tangents"],
    )
    return task, RelaxOptions(**header["options"]), link


def unpack_goals(message: Packet) -> dict[str, Curve]:
    """The curves of a job that the first one is to become, one after the other, by name."""
    header, arrays = message
    meshes = header["goals"].items()
    last = arrays[len(arrays) - len(meshes) :]
    return {name: Curve(each, _unpack_mesh(mesh)) for each, (name, mesh) in zip(last, meshes, strict=True)}


def _pack_mesh(mesh: Mesh) -> dict[str, Any]:
    return {"sizes": mesh.component_sizes, "closed": mesh.closed}


def _unpack_mesh(header: dict[str, Any]) -> Mesh:
    return Mesh(tuple(header["sizes"]), tuple(header["closed"]))


def pack_iterate(iterate: Iterate, proved: Sequence[str]) -> Packet:
    """One iterate, and the motions known to be free of contact, by their `digest`."""
    header = {name: getattr(iterate, name) for name in _VALUES}
    header |= {**_pack_mesh(iterate.curve.mesh), "proved": list(proved)}
    return header, [iterate.curve.vertices, *iterate.path]


def unpack_iterate(message: Packet) -> tuple[Iterate, list[str]]:
    header, (vertices, *path) = message
    values = {name: header[name] for name in _VALUES}
    curve = Curve(vertices, _unpack_mesh(header))
    values["pins"] = tuple(values["pins"])
    return Iterate(curve=curve, path=tuple(path), **values), header["proved"]


def pack_outcome(outcome: Outcome) -> Packet:
    clauses = list(map(_pack_message, outcome.clauses))
    return {"outcome": asdict(outcome) | {"status": outcome.status.value, "clauses": clauses}}, []


def unpack_outcome(message: Packet) -> Outcome:
    values = message[0]["outcome"]
    values |= {"status": Status(values["status"]), "place": _place(values["place"])}
    return Outcome(**values | {"clauses": tuple(map(_unpack_message, values["clauses"]))})


def pack_error(error: MobiusFlowError) -> Packet:
    place = error.place if isinstance(error, CurveError) else None
    header = {"error": _pack_message(str(error)), "place": None if place is None else asdict(place)}
    return header | {"of_option": isinstance(error, OptionError)}, []


def unpack_error(message: Packet) -> MobiusFlowError:
    """The inverse of `pack_error`, as far as Blender distinguishes errors."""
    header = message[0]
    sentence = _unpack_message(header["error"])
    return OptionError(sentence) if header["of_option"] else CurveError(sentence, _place(header["place"]))


def _pack_message(fact: Any) -> Any:
    """A message or one of its facts as JSON has it."""
    if not isinstance(fact, Message):
        return fact
    return {"template": fact.template, "facts": {name: _pack_message(value) for name, value in fact.facts.items()}}


def _unpack_message(packed: Any) -> Any:
    if not isinstance(packed, dict):
        return packed
    return Message(packed["template"], **{name: _unpack_message(fact) for name, fact in packed["facts"].items()})


def _place(values: dict[str, Any] | None) -> Place | None:
    return None if values is None else Place(**{name: tuple(numbers) for name, numbers in values.items()})


def digest(start: FloatArray, end: FloatArray) -> str:
    """Name of the straight motion between two arrays of vertices: exactly these bits, nothing else."""
    hashed = hashlib.blake2b(start.tobytes(), digest_size=16)
    hashed.update(end.tobytes())
    return hashed.hexdigest()
