"""The curve objects that are relaxed together as one link; a single object is a group of one."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack

import bpy
import numpy as np

from ...core import Curve
from ...core.base.errors import Place
from ...core.base.messages import Message
from ...core.base.types import FloatArray
from ...core.curve import Mesh
from ...core.driver.words import in_blenders_words, named, spline_names
from ...core.keys.key_options import Course, KeyOptions
from ...core.keys.motion import Keys
from ...core.keys.placement import Frame, Placement, Similarity, Spot, spots
from .member import Member
from .pins import pin, pinned_vertices, unpin
from .sizes import placement
from .splines import coordinates, read_link


class CurveGroup:
    """Curve objects, the link that their splines form, and what is written to them.

    `checks.refusal` accepts the objects, and their transforms are evaluated. They show stand-ins until all
    is written, or until `discard`. Where the run ``continues``, baked curves are relaxed on from the ends of their
    animations, and keys are added to theirs. ``curve``: all splines as polygons in world space; ``link``: where their
    vertices are stored. Raises CurveError if the splines cannot be read.
    """

    def __init__(self, objects: Sequence[bpy.types.Object], continues: bool = False) -> None:
        self.continues = continues
        self._members = [Member(obj, continues) for obj in objects]
        self._shown: tuple[Curve, Frame, KeyOptions, float | None] | None = None
        try:
            for member in self._members:
                member.begin()
            self.curve, self.link = read_link(objects)
        except BaseException:
            self.discard()
            raise

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(member.name for member in self._members)

    @property
    def title(self) -> str:
        return named(self.names)

    @property
    def objects(self) -> list[bpy.types.Object]:
        return [obj for member in self._members if (obj := member.object) is not None]

    def member(self, number: int) -> bpy.types.Object | None:
        """One of the objects, by its original number; None if it is gone."""
        return self._members[number].object

    def reworded(self, message: str) -> str:
        """The core's message about the link and what it avoids, with the splines named by their objects."""
        return in_blenders_words(message, spline_names(self.names, self.link.counts))

    def spots(self, place: Place | None, curve: Curve) -> list[Spot]:
        """The spots on the objects of a place on the link, or on the same link with other vertices."""
        return [] if place is None else spots(place, curve, self.link)

    @property
    def modified(self) -> bool:
        """Whether any of the objects is shown with modifiers."""
        return any(modifier.show_viewport or modifier.show_render for obj in self.objects for modifier in obj.modifiers)

    def fits(self, options: KeyOptions) -> bool:
        """Whether any of the objects is drawn as a tube that is to be fitted."""
        return any(member.fits(options) for member in self._members)

    @property
    def size(self) -> Similarity:
        """How the link is shown that the run begins with."""
        return self._members[0].size if self.continues else Similarity()

    @property
    def replaced(self) -> int:
        """The number of keys that those written take the place of."""
        return max(member.replaced for member in self._members)

    def equals(self, other: "CurveGroup") -> bool:
        """Whether the same polygons are stored in the same places, bit for bit."""
        pairs = zip(self.link.placements, other.link.placements, strict=False)
        return (
            self.link.counts == other.link.counts
            and self.curve.mesh == other.curve.mesh
            and np.array_equal(self.curve.vertices, other.curve.vertices)
            and all(one.equals(another) for one, another in pairs)
        )

    def lost(self, alone: bool = True) -> Message | None:
        """Say what was done to one of the objects that makes it impossible to go on.

        What is proved of a single object holds wherever it goes, if it is ``alone``, and avoids nothing.
        """
        reason = next((reason for member in self._members if (reason := member.lost())), None)
        if reason is None and not (alone and len(self._members) == 1):
            there = ((member, placement(member.object)) for member in self._members)
            moved = next((member for member, here in there if not here.equals(member.placement)), None)
            reason = Message("'{name}' was moved against the others", name=moved.name) if moved else None
        return reason

    @property
    def pins(self) -> tuple[int, ...]:
        """The link's vertices that are pinned; raises CurveError as `pinned_vertices`."""
        return pinned_vertices(self.objects, self.curve.mesh)

    @property
    def stored(self) -> Frame:
        """The splines' vertices as Blender stores them; shape (n, 3)."""
        return np.concatenate([coordinates(spline) for obj in self.objects for spline in obj.data.splines])

    def show(self, start: Curve, frame: Frame, options: KeyOptions, radius: float | None) -> None:
        """Move all points, (n, 3) in each object's own coordinates; ``start``: the start with as many vertices.

        Tubes that are to be fitted are given the radius, in the common space.
        """
        if self._shown is None or self._shown[0].mesh != start.mesh:
            self.make_polygons(start)
        self._shown = start, frame, options, radius
        for member, vertices, scale in zip(self._members, self.link.slices(start.mesh), self.link.scales, strict=True):
            member.move(frame[vertices], radius / scale if radius is not None and member.fits(options) else None)

    @property
    def in_view(self) -> Curve | None:
        """The link where it is shown now, which for a single object may be elsewhere; None if there is none."""
        if self._shown is None or len(self.objects) < len(self._members):
            return None
        start, frame = self._shown[:2]
        parts = zip(self._placements, self.link.slices(start.mesh), strict=True)
        return start.with_vertices(np.concatenate([each.to_world(frame[s].astype(np.float64)) for each, s in parts]))

    def unmoved(self, component: int, point: FloatArray) -> FloatArray:
        """Where a point in view, shape (3,), would be on a component if no object had been moved."""
        member = int(np.searchsorted(np.cumsum(self.link.counts), component, side="right"))
        local = self._placements[member].to_local(point[None])
        return np.asarray(self.link.placements[member].to_world(local)[0])

    @property
    def _placements(self) -> list[Placement]:
        return [Placement.from_matrix(obj.matrix_world) for obj in self.objects]

    def mark_pins(self, vertices: Sequence[int]) -> None:
        """Let vertices of the link that is shown be the pinned points, and no others."""
        first = 0
        for spline in (spline for obj in self.objects for spline in obj.data.splines):
            chosen = np.isin(np.arange(first, first + len(spline.points)), vertices)
            first += len(chosen)
            pin(spline, chosen)
            unpin(spline, ~chosen)

    def make_polygons(self, refined: Curve) -> None:
        """Give all splines the points of the refined link; their positions are left open."""
        pieces = zip(self._members, self.link.split(self.curve), self.link.split(refined), strict=True)
        for member, drawn, part in pieces:
            member.make_polygons(drawn, part)

    def hide(self) -> None:
        """Show the originals for a moment, because the file is being saved or something is undone."""
        for member in self._members:
            member.hide()

    def resume(self) -> None:
        for member in self._members:
            member.resume()
        if self._shown is not None:
            shown, self._shown = self._shown, None
            self.show(*shown)

    def writing(
        self, mesh: Mesh, keys: Keys, frames: FloatArray, options: KeyOptions, radii: FloatArray | None
    ) -> Iterator[None]:
        """Write keys to all objects in short pieces; ``radii``: of the tube in the common space, (keys,)."""
        for member, vertices, scale in zip(self._members, self.link.slices(mesh), self.link.scales, strict=True):
            own = None if radii is None else radii / scale
            yield from member.writing(keys.part(vertices), frames, options, own)

    def keep(self, keys: Keys, frames: FloatArray, options: KeyOptions, course: Course) -> None:
        """Make what was written final."""
        for member in self._members:
            member.keep(keys, frames, options, course)

    def discard(self) -> bool:
        """Show the originals for good, unless somebody else changed something; return whether all is as it was."""
        restored: list[bool] = []
        with ExitStack() as everything:
            # close curves that may just have been opened for editing, and reopen them afterwards
            if mode := next((obj.mode for obj in self.objects if obj.mode != "OBJECT"), None):
                bpy.ops.object.mode_set(mode="OBJECT")
                everything.callback(bpy.ops.ed.undo_push, message="Relaxation Ended")
                everything.callback(bpy.ops.object.mode_set, mode=mode)
            for member in self._members:  # each of them, even if one fails
                everything.callback(lambda each: restored.append(each.discard()), member)
        return all(restored)
