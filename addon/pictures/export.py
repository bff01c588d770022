"""Keyframed scenes, movies and pictures of a relaxation: what the command line calls.

Each starts from an empty factory scene, so what is open in Blender is lost; writes the whole file
or none; and returns whether everything it shows was proved free of contact, in Blender's own numbers.
"""

import os
import shutil
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...core import Curve, Iterate, Mesh, MobiusFlowError
from ...core.base import FloatArray, OutputError, atomic_write, termination_raises
from ...core.collision import is_rope
from ...core.keys.key_options import Playing
from ...core.keys.motion import check_dimension, recorded
from ...core.keys.placement import Measure, Origin, framed
from ...core.keys.recording import Key, Keys
from ...core.keys.tube import rope_radii, rounded, tube_radii
from .looks import DEFAULT, LOOKS

ONCE = Playing()
Target = str | os.PathLike[str]
Progress = Callable[[int, int], None]

_PICTURE = (800, 450)  # width, height
_FILM = (640, 360)
_FILM_SAMPLES = 12
_FILM_WITHOUT_DRIVER = (384, 216, 3)


def require_blender() -> None:
    """Raise a MobiusFlowError that says what to install if Blender's Python module, or a library of it, is missing."""
    try:
        import bpy  # noqa: F401
    except ModuleNotFoundError as error:
        raise MobiusFlowError(
            "writing .blend, .mp4 and .png needs Blender's Python module, which is not installed; "
            'install it with pip install bpy, or in a clone pip install ".[blender]" (Python 3.11 or 3.13)'
        ) from error
    except ImportError as error:
        raise MobiusFlowError(f"Blender's Python module, which is installed, cannot be loaded: {error}") from error


def write_blend(path: Target, iterates: Sequence[Iterate], playing: Playing = ONCE) -> bool:
    """Write a .blend in which the relaxation plays, ready to render even where the extension is not installed.

    ``iterates`` are those of a run, from the start to the last. Raises MobiusFlowError if
    Blender's module is missing or the file cannot be written.
    """
    require_blender()
    from . import rendering

    style = LOOKS[playing.look or DEFAULT]
    _, certified = _played(iterates, lambda scene: rendering.use_cycles(scene, style, *_PICTURE), playing, True)
    _make(path, rendering.save)
    return certified


def write_movie(
    path: Target, iterates: Sequence[Iterate], progress: Progress | None = None, playing: Playing = ONCE
) -> bool:
    """Render the relaxation to an .mp4 of a few seconds, or half a minute where strands are moved one after the other.

    ``progress`` gets the number of frames done and of all frames; without a look it is drawn plainly, in little
    time. Otherwise as `write_blend`.
    """
    require_blender()
    from . import movie, rendering

    def set_up(scene: Any) -> None:
        if playing.look is not None:
            rendering.use_cycles(scene, LOOKS[playing.look], *_FILM, _FILM_SAMPLES)
        elif rendering.workbench_works():
            rendering.use_workbench(scene, *_FILM)
        else:
            rendering.use_cycles(scene, LOOKS[DEFAULT], *_FILM_WITHOUT_DRIVER)
            scene.frame_step, scene.render.fps = 2, scene.render.fps // 2

    scene, certified = _played(iterates, set_up, playing)
    _make(path, lambda temporary: movie.render_movie(scene, temporary, progress))
    return certified


def _played(
    iterates: Sequence[Iterate], set_up: Callable[[Any], None], playing: Playing, in_place: bool = False
) -> tuple[Any, bool]:
    """A scene that plays a relaxation, and whether all it shows is proved.

    ``in_place``: in its own size and place, with its corners; otherwise these are rounded.
    """
    from . import rendering

    motion, origin = recorded(iterates, Measure.LENGTH if in_place else Measure.RADIUS)
    playing = playing.timed(motion.way)
    timing = playing.timing
    keys = motion.keys(is_rope, timing.length, timing)
    frames = timing.frames(motion.course(keys))
    scene = rendering.empty_scene()
    set_up(scene)
    certified = compose(scene, keys, frames, motion.start.mesh, playing, origin if in_place else None)
    scene.frame_start, scene.frame_end = timing.scene_range(frames)
    return scene, certified


def compose(
    scene: Any,
    keys: Keys,
    frames: FloatArray,
    mesh: Mesh,
    playing: Playing,
    origin: Origin | None = None,
    cut_out: bool = False,
) -> bool:
    """Put a keyed curve on a look's stage, by default near the scene's origin, and fit the scene's frames to it.

    Its tube is the rope, or else as thick as there is room, and its corners are rounded unless there is an origin.
    ``cut_out``: it is seen down the third axis, and nothing of the floor is in the picture but shadows.  Returns
    whether all that is shown is proved.
    """
    import bpy

    from ..curves import keyframes
    from ..curves.assets import bundled
    from ..curves.splines import new_curve_data, write_points
    from . import stage
    from .materials import colour_components

    radii = rope_radii(mesh, keys)
    if radii is None and origin is None:
        mesh, keys = rounded(mesh, keys, is_rope)
    points, look = [key.points for key in keys.keys], playing.look or DEFAULT
    if radii is None:
        radii = tube_radii(mesh, [each.astype(np.float64) for each in points], frames)
    radii = np.full_like(radii, radii.min()) if playing.constant_radius else radii
    data = new_curve_data("Curve", mesh)
    data.bevel_depth, data.bevel_resolution = float(radii.max()), 5
    data.use_fill_caps = True  # at the ends of arcs
    obj = stage.add(scene.collection, "Curve", data)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    write_points(data, points[-1])
    if len(points) > 1:
        keyframes.write(obj, keys, frames, radii / radii.max(), playing.timing)
    along = None
    if len(mesh.component_sizes) == 1:
        # the share of the length at each vertex, and at its end; the mean of all keys
        lengths = np.array([Curve(each.astype(np.float64), mesh).edge_lengths for each in points])
        passed = np.cumsum((lengths / lengths.sum(axis=1, keepdims=True)).mean(axis=0))
        along = np.concatenate([[0.0], passed / passed[-1]])
    colour_components(data, look=look, along=along)
    views = [framed(Curve(each.astype(np.float64), mesh)) for each in points]
    # up is where the last shape extends least, along the third axis if no other is better, and rather up than down
    spread = np.cov(views[-1].T)
    spread[2, 2] *= 1.0 - 1e-3
    least = np.linalg.eigh(spread)[1][:, 0]
    ground = stage.Ground.around(views, None if cut_out else least * np.sign(least[np.abs(least).argmax()]))
    size = scene.render.resolution_x, scene.render.resolution_y
    floor = stage.build(scene.collection, ground, LOOKS[look])
    floor.is_shadow_catcher = scene.render.film_transparent = cut_out
    seen = views, points, radii.max(axis=1), frames
    scene.camera = stage.follow(scene.collection, size, ground, floor, *seen, playing.timing)
    scene.world = bundled("worlds", LOOKS[look].label)
    scene.world.name = "World"
    stage.light_workbench(scene, scene.collection)
    if origin is not None and (origin.scale != 1.0 or origin.location.any()):
        # move and scale everything from the curve's coordinates to the world's
        objects = list(scene.objects)
        root = stage.add(scene.collection, "Stage", None)
        root.location, root.scale = origin.location, 3 * [origin.scale]
        for each in objects:
            each.parent = root
            if each.type == "LIGHT":
                each.data.energy *= origin.scale**2
            elif each.type == "CAMERA":
                each.data.clip_start *= origin.scale
                each.data.clip_end *= origin.scale
                each.data.dof.aperture_fstop /= origin.scale
    scene.frame_start, scene.frame_end = round(frames[0]), int(np.ceil(frames[-1]))
    scene.frame_set(scene.frame_start)
    return keys.certified


def write_still(path: Target, iterates: Sequence[Iterate], look: str | None = None) -> bool:
    """Render the relaxed curve, the last iterate, to a .png; otherwise as `write_blend`."""
    motion, _ = recorded(iterates)
    keys = motion.result(is_rope)
    return _render(path, keys, motion.start.mesh, _PICTURE, look)


def write_picture(
    path: Target,
    curve: Curve,
    width: int,
    height: int,
    look: str | None = None,
    samples: int | None = None,
    cut_out: bool = False,
) -> None:
    """Render a curve to a .png or .jpg of so many pixels; raises as `write_blend` does.

    ``samples`` of each pixel, by default the look's: fewer are denoised less well, in less time.  ``cut_out``: a .png
    with the curve, seen down its third axis, and its shadow, and nothing behind them.
    """
    check_dimension(curve)
    link = Origin.of(curve).link(curve.mesh)
    points = link.to_stored(curve.mesh, curve.vertices).astype(np.float32)
    _render(path, Keys((Key(0.0, points),), 0), curve.mesh, (width, height), look, samples, cut_out)


def _render(
    path: Target,
    keys: Keys,
    mesh: Mesh,
    size: tuple[int, int],
    look: str | None,
    samples: int | None = None,
    cut_out: bool = False,
) -> bool:
    require_blender()
    from . import rendering

    scene = rendering.empty_scene()
    rendering.use_cycles(scene, LOOKS[look or DEFAULT], *size, samples)
    certified = compose(scene, keys, np.ones(1), mesh, Playing(look), cut_out=cut_out)
    _make(path, lambda temporary: rendering.render_still(scene, temporary))
    return certified


def _make(path: Target, write: Callable[[Path], None]) -> None:
    """Let Blender write a file in a directory of its own, and move it to its place when it is whole."""
    try:
        with (
            termination_raises(SystemExit(143)),  # what a shell gives to a process ended by SIGTERM
            atomic_write(path) as temporary,
            tempfile.TemporaryDirectory(dir=temporary.parent) as room,
        ):
            made = Path(room) / temporary.name.lstrip(".")
            write(made)
            shutil.copymode(temporary, made)
            made.replace(temporary)
    except (OSError, RuntimeError) as error:
        raise OutputError(os.fspath(path), error) from error
