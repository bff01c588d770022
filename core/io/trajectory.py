"""What a relaxation yields, and its certified path as a file that others can check."""

import json
import os
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base import BoolArray, FloatArray, IntArray, MobiusFlowError, atomic_write, checked, checked_fields, counted
from ..curve import Curve, Mesh, Obstacle


class StrandMoves(NamedTuple):
    """Crossings seen before and after strand moves, what these have taken so far, and whether they are complete."""

    before: int
    left: int
    moves: int = 0
    seconds: float = 0.0
    iterates: int = 0
    done: bool = False

    def report(self) -> dict[str, object]:
        """The plain values that ``--report`` writes."""
        return {"crossings": self.before, "left": self.left, "moves": self.moves, "seconds": self.seconds}


@checked_fields
@dataclass(frozen=True, eq=False)
class Iterate:
    """One accepted curve of a relaxation, immutable, in the user's units."""

    index: int  #: 0 for the (refined) start, then 1, 2, ...
    curve: Curve  #: the polygon; the iterates of a run have the same vertices where the mesh is ``fixed``
    #: The objective, which is the energy that is minimised, plus the barrier.  All iterates of a strand move have the
    #: ``energy``, ``gradient_norm`` and ``edge_length_error`` of its end.
    energy: float
    #: Norm of the projected gradient (dimensionless), in the metric in which the method takes it, which is that of this
    #: curve, or of one up to two steps before.
    gradient_norm: float
    step_size: float  #: τ that led here, 0 for the start, for motions of moves, and where the mesh changes
    #: The motion from the previous iterate, as vertices, each (n, m), at the ends of its straight legs, the last of
    #: which is this curve.  Empty for the start, and where the mesh changes: there this is the previous curve with
    #: other vertices on its edges.
    path: tuple[FloatArray, ...]
    certified: bool  #: whether every leg from the start of the run to here was proved free of contact
    edge_length_error: float  #: max |log ℓ/ℓ⁰| over the edges
    method: str  #: name of the one that took the step, which is another where the requested one was stuck
    grown: float = 1.0  #: factor by which target lengths have grown since the start
    pins: tuple[int, ...] = ()  #: pinned vertices, counted from 0, and those between them that cannot move
    strand_moves: StrandMoves | None = None  #: those so far; None before the first one
    symmetry: str = ""  #: name of the symmetry group that is kept, if any
    radius: tuple[float, ...] | None = None  #: of each component as a rope, in the user's units; None if it is none

    def __repr__(self) -> str:
        proved = "certified" if self.certified else "not certified"
        return f"<Iterate {self.index}: objective {self.energy:.9g}, gradient {self.gradient_norm:.2g}, {proved}>"


class Trajectory:
    """Frames between which all vertices move on straight lines, collected from iterates.

    Arrays ``stage_000``, ``stage_001``, … of shape (k, n, m), each with ``component_sizes_000``, … and, unless all
    components are closed, ``component_closed_000``, … of booleans; a new stage begins where the mesh changes.
    Obstacles are in ``obstacle_000_vertices``, shape (k, 3), and ``obstacle_000_faces``, shape (f, 3) or (f, 2), ….
    ``pins``, shape (k, m), are the places of the vertices that were held, if there were any; ``radius``, shape
    (components,), those of the thinnest rope that the curve was, if it always was one.  Coordinates are the
    user's, in double precision: the proofs are about exactly these numbers.  ``provenance`` records in plain values
    where the run came from, as JSON in an array of one string; `verify` ignores it, and None leaves it out.
    """

    @checked
    def __init__(self, provenance: Mapping[str, object] | None = None, obstacles: Sequence[Obstacle] = ()) -> None:
        self._provenance, self._obstacles = provenance, obstacles
        self._stages: list[tuple[Mesh, list[FloatArray]]] = []
        self._pins: FloatArray = np.empty((0, 0))
        self._radius: FloatArray | None = None
        self._last: Curve | None = None
        self._last_index = -1

    def __repr__(self) -> str:
        frames = sum(len(frames) for _, frames in self._stages)
        return f"<Trajectory: {counted(len(self._stages), 'stage')}, {counted(frames, 'frame')}>"

    @checked
    def add(self, iterate: Iterate) -> None:
        """Append the motion that led to an iterate (for the first one: the start).

        Raises MobiusFlowError if its number or mesh does not follow the last iterate: nobody has proved the motion
        between them.  It is up to the caller that all iterates are from one run; `verify` finds out.
        """
        fits = not iterate.path or (self._last is not None and iterate.curve.mesh == self._last.mesh)
        if iterate.index != self._last_index + 1 or not fits:
            raise MobiusFlowError(
                f"iterate {iterate.index} does not follow the {self._last_index + 1} iterates of this trajectory; "
                "it takes all iterates of one run, in order: make a new Trajectory for another run"
            )
        if iterate.path:
            self._stages[-1][1].extend(iterate.path)
        else:  # the start, or the same curve on another mesh
            self._stages.append((iterate.curve.mesh, [iterate.curve.vertices]))
        if self._last is None:
            self._pins = iterate.curve.vertices[list(iterate.pins)]
            self._radius = None if iterate.radius is None else np.array(iterate.radius)
        elif self._radius is not None:
            self._radius = None if iterate.radius is None else np.minimum(self._radius, iterate.radius)
        self._last, self._last_index = iterate.curve, iterate.index

    def arrays(self) -> dict[str, FloatArray | IntArray | BoolArray | NDArray[np.str_]]:
        """The arrays of the file, by name."""
        named: dict[str, FloatArray | IntArray | BoolArray | NDArray[np.str_]] = {}
        if self._provenance is not None:
            named["provenance"] = np.array(json.dumps(self._provenance))
        for k, obstacle in enumerate(self._obstacles):
            named[f"obstacle_{k:03d}_vertices"] = obstacle.vertices
            named[f"obstacle_{k:03d}_faces"] = obstacle.faces
        if len(self._pins):
            named["pins"] = self._pins
        if self._radius is not None:
            named["radius"] = self._radius
        for k, (mesh, frames) in enumerate(self._stages):
            named[f"stage_{k:03d}"] = np.stack(frames)
            named[f"component_sizes_{k:03d}"] = np.array(mesh.component_sizes, dtype=np.intp)
            if not mesh.all_closed:  # so that files of closed curves stay as they have always been
                named[f"component_closed_{k:03d}"] = np.array(mesh.closed)
        return named

    @checked
    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the trajectory as .npz, whole or not at all; an OutputError says why that fails."""
        with atomic_write(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
            # as numpy.savez_compressed does, which leaves the archive open, and loud, when the disk is full
            for name, array in self.arrays().items():
                with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                    np.lib.format.write_array(member, array, allow_pickle=False)
