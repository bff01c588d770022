"""Tubes as solids to print (STL and 3MF, by trimesh), and motions as binary glTF 2.0.

A motion's surfaces have its frames as morph targets, which play one after the other.
"""

import json
import struct
from typing import Any

import numpy as np
import numpy.typing as npt

from ..base import CurveError, MobiusFlowError, checked
from ..collision import thickness
from ..curve import Curve
from ..curve.tube import Tube, tubes
from .colours import linear
from .view import COLOURS, Motion

_VERTICES, _FACES = 34962, 34963  # what data are for, as glTF numbers it


@checked
def wire(curve: Curve, width: float | None = None, rope: float = 0.0) -> list[Tube]:
    """Tubes of a width in the curve's units, by default the rope of that radius, or else nine tenths of the widest.

    Raises CurveError where they would run into themselves or each other: the widest is twice the thickness.
    """
    if curve.dimension > 3:
        raise CurveError(f"the curve is in dimension {curve.dimension}; wires are of curves in the plane or in space")
    widest = 2.0 * thickness(curve)
    if width is None:
        width = 2.0 * rope if 0.0 < 2.0 * rope <= widest else 0.9 * widest
    if not 0.0 < width <= widest:
        advice = f"this curve has room for {widest:.4g}; scale it, or relax it further"
        raise CurveError(f"a wire {width:g} wide has no width, or runs into itself: {advice}")
    return [tube for (tube,) in tubes([curve], 0.5 * width, 32)]


@checked
def solid(curve: Curve, kind: str, width: float | None = None, rope: float = 0.0) -> bytes:
    """A file of kind ``stl`` or ``3mf`` with closed surfaces, in millimetres; raises as `wire`, or without trimesh."""
    parts = wire(curve, width, rope)
    try:
        import lxml  # noqa: F401 (trimesh needs these two for 3MF)
        import networkx  # noqa: F401
        import trimesh
    except ImportError as error:
        raise MobiusFlowError('solids need trimesh: pip install trimesh lxml networkx (the extra "view")') from error
    scene = trimesh.Scene([trimesh.Trimesh(part.points, part.faces, process=False) for part in parts])
    scene.units = "millimeters"
    return bytes(scene.export(file_type=kind))


@checked
def animation(shown: Motion, radius: float | None = None) -> bytes:
    """The file: a mesh for each component, and one animation of them all if there are several frames."""
    surfaces = tubes(shown.curves, shown.radius if radius is None else radius)
    data, parts = _Data(), range(len(surfaces))
    upright = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]  # a quarter turn: our z-axis is up, glTF's is y
    meshes = list[dict[str, Any]]()
    for k, (first, *others) in enumerate(surfaces):  # the surface of the first frame, and what the others add to it
        made: dict[str, Any] = {
            "attributes": {"POSITION": data.add(first.points, _VERTICES), "NORMAL": data.add(first.normals, _VERTICES)},
            "indices": data.add(first.faces.ravel().astype(np.uint32), _FACES),
            "material": k % len(COLOURS),
        }
        if others:
            made["targets"] = [
                {"POSITION": data.add(each.points - first.points), "NORMAL": data.add(each.normals - first.normals)}
                for each in others
            ]
        meshes.append({"primitives": [made]})
    light = [[*linear(np.array(list(bytes.fromhex(colour[1:]))) / 255.0).tolist(), 1] for colour in COLOURS]
    looks = [{"baseColorFactor": each, "metallicFactor": 0, "roughnessFactor": 0.5} for each in light]
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "Möbius Flow"},
        "scene": 0,
        "scenes": [{"nodes": list(parts)}],
        "nodes": [{"mesh": k, "name": f"component {k + 1}", "rotation": upright} for k in parts],
        "meshes": meshes,
        "materials": [{"pbrMetallicRoughness": look} for look in looks],
    }
    if len(shown.curves) > 1:
        # at its time each target has weight 1 and the others 0; at the first time all have
        keys = len(shown.curves)
        times, weights = np.linspace(0.0, 6.0, keys), np.eye(keys)[:, 1:]  # in seconds
        sampler = {"input": data.add(times), "output": data.add(weights.ravel()), "interpolation": "LINEAR"}
        channels = [{"sampler": 0, "target": {"node": k, "path": "weights"}} for k in range(len(parts))]
        document["animations"] = [{"samplers": [sampler], "channels": channels}]
    return data.joined(document)


class _Data:
    """The numbers of a file, and what it says about them."""

    def __init__(self) -> None:
        self._bytes = bytearray()
        self._views: list[dict[str, int]] = []
        self._accessors: list[dict[str, Any]] = []

    def add(self, array: npt.NDArray[Any], target: int | None = None) -> int:
        """Append numbers, shape (k,) or (k, 3); return the index by which they are referred to."""
        array = np.ascontiguousarray(array, dtype=np.uint32 if target == _FACES else np.float32)
        columns = array.reshape(len(array), -1)
        view = {"buffer": 0, "byteOffset": len(self._bytes), "byteLength": array.nbytes}
        self._views.append(view | ({} if target is None else {"target": target}))
        bounds = {"min": columns.min(axis=0).tolist(), "max": columns.max(axis=0).tolist()}
        kind = {"componentType": 5125 if target == _FACES else 5126, "type": {1: "SCALAR", 3: "VEC3"}[columns.shape[1]]}
        self._accessors.append({"bufferView": len(self._views) - 1, "count": len(columns)} | kind | bounds)
        self._bytes += array.tobytes()
        return len(self._accessors) - 1

    def joined(self, document: dict[str, Any]) -> bytes:
        """The file: its header, the document and the numbers, each a chunk of a multiple of four bytes."""
        whole = {
            "buffers": [{"byteLength": len(self._bytes)}],
            "bufferViews": self._views,
            "accessors": self._accessors,
        }
        text = json.dumps(document | whole).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(self._bytes), b"BIN\0") + self._bytes
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
