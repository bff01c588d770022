"""Curves and motions as pictures that can be turned in a browser or a notebook, with Plotly."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np

from .arguments import checked
from .collision import check_embedded, minimal_gap
from .curve import Curve, Mesh
from .curve.smooth import evenly
from .errors import CurveError, MobiusFlowError
from .hierarchy import moebius_energy
from .task import centred
from .tube import tubes
from .types import IntArray
from .verify.trajectory import TrajectoryError, stages

COLOURS = ("#3b6fb6", "#d1663f", "#4b9b6e", "#9b5fb0", "#c9a227", "#5aa7b8", "#b8436d", "#7a7a7a")
FRAMES = 60  # of a motion
_STATIONS = 400  # around a curve
_LARGEST = 20_000  # vertices of a single curve
_THICKEST, _THINNEST = 0.012, 0.002  # radius of tubes in lengths of the curve


@dataclass(frozen=True)
class Motion:
    """Successive curves on one mesh, in space, with their energies; or one curve, with the energies of a whole run."""

    curves: tuple[Curve, ...]
    energies: tuple[float, ...] = ()

    @property
    def radius(self) -> float:
        """Radius of tubes that are easy to see, but thinner where strands are near each other."""
        length = max(curve.length for curve in self.curves)
        gap = min(minimal_gap(curve)[0] for curve in self.curves)
        return float(np.clip(0.45 * gap, _THINNEST * length, _THICKEST * length))


@checked
def motion(path: str | os.PathLike[str], frames: int = FRAMES) -> Motion:
    """At most ``frames`` frames of a trajectory file, about equally far apart, with the first and the last.

    All have the same number of vertices.  Raises MobiusFlowError if there is no trajectory, or a frame touches itself;
    it is for `verify` to say that the motion is free of contact.
    """
    path = os.fspath(path)
    try:
        chosen = _evenly_apart(path, frames)
        curves = [curve for number, curve in enumerate(_curves(path)) if number in chosen]
        for curve in curves:
            check_embedded(curve)
    except (TrajectoryError, CurveError) as error:
        raise MobiusFlowError(f"{path}: {error}") from error
    energies = tuple(moebius_energy(centred(curve))[0] for curve in curves)
    return Motion(tuple(_on_one_mesh(curves)), energies)


def _curves(path: str) -> Iterator[Curve]:
    """All frames but the first ones of later stages, which repeat the last ones before on another mesh."""
    for number, stage in enumerate(stages(path)):
        mesh = Mesh(*zip(*((each.size, each.closed) for each in stage.components), strict=True))
        yield from (Curve(frame, mesh) for frame in islice(stage.frames, number > 0, None))


def _evenly_apart(path: str, count: int) -> set[int]:
    """Numbers of frames between which vertices move about equally far."""
    moved, last = [0.0], None
    for curve in _curves(path):
        if last is not None:
            step = curve.vertices - last.vertices if curve.mesh == last.mesh else np.zeros((1, 1))
            moved.append(moved[-1] + float(np.sqrt(np.square(step).sum(axis=1).mean())))
        last = curve
    numbers = np.searchsorted(moved, np.linspace(0.0, moved[-1], count))
    return {*numbers[:-1].tolist(), len(moved) - 1}


def _on_one_mesh(curves: Sequence[Curve]) -> list[Curve]:
    """Points evenly along the curves; on a closed component they begin where they are nearest to the previous ones."""
    share = curves[-1].component_lengths / curves[-1].length
    counts = np.maximum(np.round(_STATIONS * share), 12).astype(int).tolist()
    made: list[Curve] = []
    for curve in curves:
        parts = []
        for k, (part, closed, count) in enumerate(zip(curve.components, curve.mesh.closed, counts, strict=True)):
            points = np.pad(evenly(part, closed, count), ((0, 0), (0, 3 - curve.dimension)))
            if made and closed:
                before = made[-1].components[k]
                products = np.fft.ifft(np.conj(np.fft.fft(before, axis=0)) * np.fft.fft(points, axis=0), axis=0)
                points = np.roll(points, -int(products.real.sum(axis=1).argmax()), axis=0)
            parts.append(points)
        made.append(Curve.from_components(parts, curve.mesh.closed))
    return made


@checked
def still(curve: Curve, energies: Sequence[float] = ()) -> Motion:
    """A curve that does not move, and the objective of a run that led to it; a CurveError if it cannot be shown."""
    if curve.dimension > 3 or len(curve) > _LARGEST:
        what = f"{len(curve)} vertices in dimension {curve.dimension}"
        raise CurveError(f"the curve has {what}; shown are curves in the plane or in space with at most {_LARGEST}")
    return Motion((curve,), tuple(energies))


@checked
def figure(shown: Motion, radius: float | None = None, title: str = "") -> Any:
    """A ``plotly.graph_objects.Figure``: tubes, a slider through the motion, and the energy beside it.

    ``radius`` is that of the tubes, in the curve's units.  Raises MobiusFlowError if Plotly is not installed.
    """
    try:
        from plotly import graph_objects as go
    except ImportError as error:
        raise MobiusFlowError('pictures need Plotly: pip install plotly (the extra "view")') from error
    radius = shown.radius if radius is None else radius
    energies, moves = shown.energies, len(shown.curves) > 1
    line = (
        [{"type": "scatter", "y": list(energies), "mode": "lines", "line": {"color": COLOURS[0]}}] if energies else []
    )

    made = tubes(shown.curves, radius)

    def changing(k: int) -> list[dict[str, Any]]:
        """Traces of a frame: tubes, and of a motion a mark on the line of energies."""
        corners = (frames[k].points.T.astype(np.float32) for frames in made)
        marked = energies[k : k + moves]
        mark = {
            "type": "scatter",
            "x": [k],
            "y": list(marked),
            "marker": {"size": 11, "color": COLOURS[1]},
            "cliponaxis": False,
        }
        surfaces = [{"type": "mesh3d", **dict(zip("xyz", xyz, strict=True))} for xyz in corners]
        return [*surfaces, mark] if marked else surfaces

    first, mark = changing(0)[: len(made)], changing(0)[len(made) :]
    surfaces = [trace | _surface(k, made[k][0].faces.T) for k, trace in enumerate(first)]
    frames = [{"data": changing(k), "name": str(k)} for k in range(len(shown.curves))] if moves else []
    traces = [*surfaces, *mark, *line]
    return go.Figure({"data": traces, "frames": frames, "layout": _layout(shown, radius, title)})


@checked
def page(shown: Motion, radius: float | None = None, title: str = "") -> str:
    """The figure as one HTML file that needs no network."""
    made = figure(shown, radius, title)
    return str(made.to_html(include_plotlyjs=True, auto_play=False, default_height="96vh"))


def _surface(k: int, corners: IntArray) -> dict[str, Any]:
    """The properties of a component's surface that do not change."""
    light = {"ambient": 0.55, "diffuse": 0.8, "specular": 0.3, "roughness": 0.4}
    look = {"color": COLOURS[k % len(COLOURS)], "lighting": light, "lightposition": {"x": 1e4, "y": 2e4, "z": 3e4}}
    faces = dict(zip("ijk", corners.astype(np.int32), strict=True))
    return {**faces, **look, "hoverinfo": "name", "name": f"component {k + 1}"}


def _layout(shown: Motion, radius: float, title: str) -> dict[str, Any]:
    """No axes, and room for every frame; beside it the energies, if there are any."""
    points = np.concatenate([np.pad(each.vertices, ((0, 0), (0, 3 - each.dimension))) for each in shown.curves])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    half = 0.5 * float(np.ptp(points, axis=0).max()) + 2.0 * radius
    scene: dict[str, Any] = {
        f"{name}axis": {"visible": False, "range": [float(c) - half, float(c) + half]}
        for name, c in zip("xyz", middle, strict=True)
    }
    camera = {"eye": {"x": 0.26, "y": -0.42, "z": 1.36}, "up": {"x": 0, "y": 1, "z": 0}}
    scene |= {"aspectmode": "cube", "camera": camera, "domain": {"x": [0.0, 0.74 if shown.energies else 1.0]}}
    layout = {"scene": scene, "title": {"text": title}, "template": "plotly_white", "showlegend": False}
    layout["margin"] = {"l": 10, "r": 20, "t": 40, "b": 10}
    if not shown.energies:
        return layout
    moves, log = len(shown.curves) > 1, max(shown.energies) > 3.0 * min(shown.energies) > 0.0
    layout["xaxis"] = {"domain": [0.8, 1.0], "title": {"text": "frame" if moves else "iterate"}}
    name = "Möbius energy" if moves else "objective"
    layout["yaxis"] = {"title": {"text": name}, "type": "log" if log else "linear"}
    return layout | (_controls(len(shown.curves)) if moves else {})


def _controls(frames: int) -> dict[str, Any]:
    """Buttons that play the frames and stop, and a slider through them."""

    def step(label: str, names: list[str | None] | None, duration: int) -> dict[str, Any]:
        timing = {"frame": {"duration": duration, "redraw": True}, "transition": {"duration": 0}, "mode": "immediate"}
        return {"method": "animate", "label": label, "args": [names, timing | {"fromcurrent": True}]}

    buttons = [step("▶", None, 80), step("❚❚", [None], 0)]
    menu = {"type": "buttons", "direction": "left", "x": 0.0, "y": 0.0, "xanchor": "left", "yanchor": "bottom"}
    steps = [step(str(k), [str(k)], 0) for k in range(frames)]
    slider = {"steps": steps, "currentvalue": {"prefix": "frame "}, "x": 0.12, "len": 0.58, "y": 0.02}
    return {"updatemenus": [menu | {"buttons": buttons, "showactive": False}], "sliders": [slider]}
