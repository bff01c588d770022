"""Curve objects that are relaxed together: they show stand-ins, and form one link in the world."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager

import bpy
import numpy as np

from ...core import Curve
from ...core.base import CurveError, FloatArray, Message, OptionError, Place, Sentence
from ...core.driver.words import in_blenders_words, named, spline_names
from ...core.keys.key_options import KeyOptions
from ...core.keys.placement import Frame, Placement, Spot, spots
from .member import Member
from .strands import read_link


class Group:
    """Curve objects, which show stand-ins from `begin` until they are written or discarded.

    ``curve``: all splines as polygons in world space; ``link``: where their vertices are stored.
    """

    def begin(self, objects: Sequence[bpy.types.Object], options: KeyOptions, continues: bool) -> None:
        """Show stand-ins for curve objects, and read the link that they form; raises CurveError."""
        self._options = options
        self.members = [Member(obj, continues) for obj in objects]
        self._shown: tuple[Curve, Frame, float | None] | None = None
        for member in self.members:
            member.begin()
        self.curve, self.link = read_link(objects)

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(member.name for member in self.members)

    @property
    def title(self) -> str:
        return named(self.names)

    @property
    def objects(self) -> list[bpy.types.Object]:
        """Those that are still there."""
        return [obj for member in self.members if (obj := member.object) is not None]

    def hide(self) -> None:
        """Show the originals for a moment, because the file is being saved or something is undone."""
        for member in self.members:
            member.hide()

    def resume(self) -> None:
        for member in self.members:
            member.resume()
        if self._shown is not None:
            shown, self._shown = self._shown, None
            self.move(*shown)

    def discard(self) -> bool:
        """Show the originals for good, unless somebody else changed something; return whether all is as it was."""
        restored: list[bool] = []
        with ExitStack() as everything:
            # close curves that may just have been opened for editing, and reopen them afterwards
            if mode := next((obj.mode for obj in self.objects if obj.mode != "OBJECT"), None):
                bpy.ops.object.mode_set(mode="OBJECT")
                everything.callback(bpy.ops.ed.undo_push, message="Relaxation Ended")
                everything.callback(bpy.ops.object.mode_set, mode=mode)
            for member in self.members:  # each of them, even if one fails
                everything.callback(lambda each: restored.append(each.discard()), member)
        return all(restored)

    @contextmanager
    def all_or_nothing(self) -> Iterator[None]:
        """Put all back, as `discard` does, if a block fails."""
        try:
            yield
        except BaseException:
            self.discard()
            raise

    def move(self, start: Curve, frame: Frame, radius: float | None) -> None:
        """Move all points, (n, 3) in each object's own coordinates; ``start``: the start with as many vertices.

        Tubes that are to be fitted are given the radius, in the common space.
        """
        if self._shown is None or self._shown[0].mesh != start.mesh:
            self.make_polygons(start)
        self._shown = start, frame, radius
        for member, vertices, scale in zip(self.members, self.link.slices(start.mesh), self.link.scales, strict=True):
            own = radius / scale if radius is not None and member.fits(self._options) else None
            member.move(frame[vertices], own)

    def make_polygons(self, refined: Curve) -> None:
        """Give all splines the points of the refined link; their positions are left open."""
        parts = zip(self.members, self.link.split(self.curve), self.link.split(refined), strict=True)
        for member, drawn, part in parts:
            member.make_polygons(drawn, part)

    @property
    def in_view(self) -> Curve | None:
        """The link where it is shown now, which for a single object may be elsewhere; None if there is none."""
        if self._shown is None or len(self.objects) < len(self.members):
            return None
        start, frame, _ = self._shown
        parts = zip(self._placements, self.link.slices(start.mesh), strict=True)
        return start.with_vertices(np.concatenate([each.to_world(frame[s].astype(np.float64)) for each, s in parts]))

    def unmoved(self, component: int, point: FloatArray) -> FloatArray:
        """Where a point in view, shape (3,), would be on a component if no object had been moved."""
        number = int(np.searchsorted(np.cumsum(self.link.counts), component, side="right"))
        local = self._placements[number].to_local(point[None])
        return np.asarray(self.link.placements[number].to_world(local)[0])

    @property
    def _placements(self) -> list[Placement]:
        return [Placement.from_matrix(obj.matrix_world) for obj in self.objects]

    @property
    def _spline_names(self) -> list[Message]:
        return spline_names([member.drawn for member in self.members], self.link.counts)

    def reworded(self, error: CurveError) -> CurveError:
        """The core's error, with the splines named by their objects; those about options use the names of options."""
        if isinstance(error, OptionError):
            return error
        return CurveError(Sentence("{reason}", reason=in_blenders_words(str(error), self._spline_names)), error.place)

    def spots(self, place: Place | None, curve: Curve) -> list[Spot]:
        """The spots on the objects of a place on the link, or on the same link with other vertices."""
        return [] if place is None else spots(place, curve, self.link)
