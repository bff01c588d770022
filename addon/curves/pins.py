"""Pinned points: those with the greatest goal weight that a point can have.

The weight belongs to soft bodies, where it holds points in place as well, and Blender's own tools give points 1 at the
most. It is kept with the point itself, so that whatever keeps points keeps pins: files, undo (in Edit Mode too, which
knows of no custom properties), copies, joined objects. Where edges are refined, points between two pinned ones are
pinned too, and no others.
"""

from collections.abc import Sequence

import bpy
import numpy as np

from ...core import CurveError, Mesh
from ...core.base import BoolArray, IntArray, Message
from ...core.keys.placement import Frame
from .splines import control_points, coordinates, kind, read

_MARK, _PINNED = "weight_softbody", 100.0


def marked(spline: bpy.types.Spline) -> BoolArray:
    return np.asarray(read(control_points(spline), _MARK) == _PINNED)


def pin(spline: bpy.types.Spline, chosen: BoolArray, weight: float = _PINNED) -> None:
    """Pin points of a spline, (points,)."""
    weights = read(control_points(spline), _MARK)
    weights[chosen] = weight
    control_points(spline).foreach_set(_MARK, weights)


def unpin(spline: bpy.types.Spline, chosen: BoolArray) -> None:
    """Let pinned points of a spline, (points,), move again; others keep the weights that they have."""
    pin(spline, chosen & marked(spline), 1.0)


def pin_only(objects: Sequence[bpy.types.Object], vertices: Sequence[int]) -> None:
    """Pin these points, counted through all splines of all objects, and no others."""
    first = 0
    for spline in [spline for obj in objects for spline in obj.data.splines]:
        chosen = np.isin(np.arange(first, first + len(spline.points)), vertices)
        first += len(chosen)
        pin(spline, chosen)
        unpin(spline, ~chosen)


def ends(spline: bpy.types.Spline) -> BoolArray:
    """The first and the last point of an open spline, none of a closed one; (points,)."""
    found = np.zeros(len(control_points(spline)), dtype=bool)
    if not spline.use_cyclic_u:
        found[[0, -1]] = True
    return found


def selected(spline: bpy.types.Spline) -> BoolArray:
    """The points of a spline that are selected in Edit Mode; (points,)."""
    return read(control_points(spline), "select_control_point" if spline.type == "BEZIER" else "select", dtype=bool)


def count(data: bpy.types.Curve) -> int:
    return sum(int(marked(spline).sum()) for spline in data.splines)


def places(data: bpy.types.Curve) -> Frame:
    """Coordinates of all pinned points; shape (k, 3)."""
    found = [coordinates(spline)[chosen] for spline in data.splines if (chosen := marked(spline)).any()]
    return np.concatenate([np.empty((0, 3), dtype=np.float32), *found])


def check_place(obj: bpy.types.Object, number: int, chosen: BoolArray) -> None:
    """Raise a CurveError if some points, (points,), of a spline lie on no polygon that can be drawn for it."""
    spline = obj.data.splines[number]
    if spline.type != "POLY" and (chosen & ~ends(spline)).any():
        sentence = (
            "Spline {number} of '{name}' is a {kind} spline, of which only the ends can be pinned; "
            "convert it to Poly first (Edit Mode, Curve > Set Spline Type > Poly)"
        )
        raise CurveError(Message(sentence, number=number + 1, name=obj.name, kind=kind(spline)))


def pinned_vertices(objects: Sequence[bpy.types.Object], mesh: Mesh) -> tuple[int, ...]:
    """The pinned vertices of the link that curve objects form, ascending; ``mesh`` has a component for each spline.

    Raises CurveError if a pinned point is between the ends of a smooth spline.
    """
    found: list[IntArray] = []
    for obj in objects:
        for number, spline in enumerate(obj.data.splines):
            chosen, piece = marked(spline), mesh.slices[len(found)]
            check_place(obj, number, chosen)
            inside = np.flatnonzero(chosen)
            if spline.type != "POLY":  # only its ends can be pinned
                inside = np.where(inside == 0, 0, piece.stop - piece.start - 1)
            found.append(piece.start + inside)
    return tuple(map(int, np.concatenate(found)))
