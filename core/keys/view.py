"""Curves and motions as pictures that can be turned in a browser or a notebook, with Plotly."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from typing import Any

import numpy as np

from ..base import CurveError, MobiusFlowError, OptionError, checked
from ..collision import check_embedded
from ..curve import Curve, Mesh, evenly
from ..curve.tube import tubes
from ..descent.task import centred
from ..energies.hierarchy import moebius_energy
from ..proof import Archive, stages
from ..proof.checker import TrajectoryError
from .placement import framed
from .tube import free_radius, thickest_radius

COLOURS = ("#3b6fb6", "#d1663f", "#4b9b6e", "#9b5fb0", "#c9a227", "#5aa7b8", "#b8436d", "#7a7a7a")
EYE = (0.26, -0.42, 1.36)  # from where figures are seen at first
FRAMES = 60  # of a motion


@dataclass(frozen=True)
class Motion:
    """Successive curves on one mesh, in space, with their energies; or one curve, with the energies of a whole run."""

    curves: tuple[Curve, ...]
    energies: tuple[float, ...] = ()
    rope: float = 0.0  # its radius, if the curve is one all along

    @property
    def radius(self) -> float:
        """Radius of tubes: that of the rope, or as thick as strands leave room; never too thin to be seen."""
        fits = self.rope or min(free_radius(curve, thickest_radius(curve)) for curve in self.curves)
        return max(fits, 0.002 * max(curve.length for curve in self.framed))

    @cached_property
    def framed(self) -> list[Curve]:
        """What pictures are made around: the ends of ropes with a knot in them leave them."""
        return [curve.with_vertices(framed(curve)) for curve in self.curves]


@checked
def motion(path: str | os.PathLike[str], frames: int = FRAMES) -> Motion:
    """At most ``frames`` frames of a trajectory file, about equally far apart, with the first and the last.

    All have the same number of vertices.  Raises MobiusFlowError if there is no trajectory, or a frame touches itself;
    it is for `verify` to say that the motion is free of contact.
    """
    path = os.fspath(path)
    if not 2 <= frames <= 1000:
        raise OptionError(f"frames is {frames}; give 2 to 1000")
    try:
        # frames between which vertices move about equally far
        moved, last = [0.0], None
        for curve in _curves(path):
            if last is not None:
                step = curve.vertices - last.vertices if curve.mesh == last.mesh else np.zeros((1, 1))
                moved.append(moved[-1] + float(np.sqrt(np.square(step).sum(axis=1).mean())))
            last = curve
        numbers = np.searchsorted(moved, np.linspace(0.0, moved[-1], frames))
        chosen = {*numbers[:-1].tolist(), len(moved) - 1}
        curves = [curve for number, curve in enumerate(_curves(path)) if number in chosen]
        for curve in curves:
            check_embedded(curve)
        with Archive(path) as archive:
            rope = min(archive.radius(), default=0.0)
    except (TrajectoryError, CurveError) as error:
        raise MobiusFlowError(f"{path}: {error}") from error
    energies = tuple(moebius_energy(centred(curve))[0] for curve in curves)
    return Motion(tuple(_on_one_mesh(curves)), energies, rope)


def _curves(path: str) -> Iterator[Curve]:
    """All frames but the first ones of later stages, which repeat the last ones before on another mesh."""
    for number, (sizes, closed, frames) in enumerate(stages(path)):
        mesh = Mesh(tuple(sizes), tuple(closed))
        yield from (Curve(frame, mesh) for frame in islice(frames, number > 0, None))


def _on_one_mesh(curves: Sequence[Curve]) -> list[Curve]:
    """Points evenly along the curves; on a closed component they begin where they are nearest to the previous ones."""
    share = curves[-1].component_lengths / curves[-1].length
    counts = np.maximum(np.round(400 * share), 12).astype(int).tolist()  # around a curve
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
    largest = 20_000
    if curve.dimension > 3 or len(curve) > largest:
        what = f"{len(curve)} vertices in dimension {curve.dimension}"
        raise CurveError(f"the curve has {what}; shown are curves in the plane or in space with at most {largest}")
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
    line = [{"type": "scatter", "y": list(energies), "mode": "lines", "line": {"color": COLOURS[0]}}]
    made = tubes(shown.curves, radius)

    def changing(k: int) -> list[dict[str, Any]]:
        """Traces of a frame: tubes, and of a motion a mark on the line of energies."""
        corners = (frames[k].points.T.astype(np.float32) for frames in made)
        marked, dot = energies[k : k + moves], {"size": 11, "color": COLOURS[1]}
        mark = {"type": "scatter", "x": [k], "y": list(marked), "marker": dot, "cliponaxis": False}
        surfaces = [{"type": "mesh3d", **dict(zip("xyz", xyz, strict=True))} for xyz in corners]
        return [*surfaces, mark] if marked else surfaces

    traces = [*changing(0), *(line if energies else [])]
    light = {"ambient": 0.55, "diffuse": 0.8, "specular": 0.3, "roughness": 0.4}
    for k, (first, *_) in enumerate(made):  # what does not change of a component's surface
        traces[k] |= dict(zip("ijk", first.faces.T.astype(np.int32), strict=True))
        traces[k] |= {"color": COLOURS[k % len(COLOURS)], "lighting": light}
        traces[k] |= {
            "lightposition": {"x": 1e4, "y": 2e4, "z": 3e4},
            "hoverinfo": "name",
            "name": f"component {k + 1}",
        }
    frames = [{"data": changing(k), "name": str(k)} for k in range(len(shown.curves))] if moves else []
    built = go.Figure({"data": traces, "frames": frames, "layout": _layout(shown, radius, title)})
    display = built._ipython_display_

    def with_picture() -> None:
        """Pages made of notebooks, and browsers without Plotly's extension, show a picture that does not move."""
        bundle = built._repr_mimebundle_()
        if not bundle:  # another program shows it
            display()
            return
        from IPython.display import display as show

        show(bundle | {"image/svg+xml": drawing(shown.curves[-1])}, raw=True)

    built._ipython_display_ = with_picture
    return built


@checked
def drawing(curve: Curve, size: int = 480) -> str:
    """The curve from the figure's first point of view, as an SVG picture: what is near covers what is far.

    ``size`` is the picture's side in pixels.
    """
    nearer = np.array(EYE) / np.linalg.norm(EYE)
    right = np.cross((0.0, 1.0, 0.0), nearer)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(nearer, right), nearer], axis=1)
    parts = _on_one_mesh([curve])[0]
    points = parts.vertices @ axes
    low, high = points.min(axis=0), points.max(axis=0)
    flat = (points[:, :2] - 0.5 * (low + high)[:2]) * (0.9 * size / ((high - low)[:2].max() or 1.0)) * (1.0, -1.0)
    flat = np.round(flat + 0.5 * size, 1)
    tails, heads = parts.mesh.tails, parts.mesh.heads
    depths = 0.5 * (points[tails, 2] + points[heads, 2])
    pale = 0.5 * (depths.max() - depths) / (np.ptp(depths) or 1.0)
    lines = []
    for edge in np.argsort(depths):
        colour = COLOURS[parts.mesh.component[tails[edge]] % len(COLOURS)]
        red, green, blue = (round(c + (255 - c) * pale[edge]) for c in bytes.fromhex(colour[1:]))
        (a, b), (c, d) = flat[tails[edge]], flat[heads[edge]]
        line = f'<line x1="{a}" y1="{b}" x2="{c}" y2="{d}" stroke='
        lines += [f'{line}"#fff" stroke-width="14" stroke-linecap="butt"/>', f'{line}"rgb({red},{green},{blue})"/>']
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size} {size}" width="{size}" height="{size}"'
    return f'{head} stroke-width="7" stroke-linecap="round">{"".join(lines)}</svg>'


@checked
def page(shown: Motion, radius: float | None = None, title: str = "") -> str:
    """The figure as one HTML file that needs no network."""
    made = figure(shown, radius, title)
    return str(made.to_html(include_plotlyjs=True, auto_play=False, default_height="96vh"))


def _layout(shown: Motion, radius: float, title: str) -> dict[str, Any]:
    """No axes, and room for every frame; beside it the energies, if any, and what plays frames and slides through."""
    points = np.concatenate([np.pad(each.vertices, ((0, 0), (0, 3 - each.dimension))) for each in shown.framed])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    half = 0.5 * float(np.ptp(points, axis=0).max()) + 2.0 * radius
    scene: dict[str, Any] = {
        f"{name}axis": {"visible": False, "range": [float(c) - half, float(c) + half]}
        for name, c in zip("xyz", middle, strict=True)
    }
    camera = {"eye": dict(zip("xyz", EYE, strict=True)), "up": {"x": 0, "y": 1, "z": 0}}
    scene |= {"aspectmode": "cube", "camera": camera, "domain": {"x": [0.0, 0.74 if shown.energies else 1.0]}}
    layout = {"scene": scene, "title": {"text": title}, "template": "plotly_white", "showlegend": False}
    layout["margin"] = {"l": 10, "r": 20, "t": 40, "b": 10}
    if not shown.energies:
        return layout
    moves, log = len(shown.curves) > 1, max(shown.energies) > 3.0 * min(shown.energies) > 0.0
    layout["xaxis"] = {"domain": [0.8, 1.0], "title": {"text": "frame" if moves else "iterate"}}
    name = "Möbius energy" if moves else "objective"
    layout["yaxis"] = {"title": {"text": name}, "type": "log" if log else "linear"}
    if not moves:
        return layout

    def step(label: str, names: list[str | None] | None, duration: int) -> dict[str, Any]:
        timing = {"frame": {"duration": duration, "redraw": True}, "transition": {"duration": 0}, "mode": "immediate"}
        return {"method": "animate", "label": label, "args": [names, timing | {"fromcurrent": True}]}

    buttons = [step("▶", None, 80), step("❚❚", [None], 0)]
    menu = {"type": "buttons", "direction": "left", "x": 0.0, "y": 0.0, "xanchor": "left", "yanchor": "bottom"}
    steps = [step(str(k), [str(k)], 0) for k in range(len(shown.curves))]
    slider = {"steps": steps, "currentvalue": {"prefix": "frame "}, "x": 0.12, "len": 0.58, "y": 0.02}
    return layout | {"updatemenus": [menu | {"buttons": buttons, "showactive": False}], "sliders": [slider]}
