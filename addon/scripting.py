"""Relaxations for scripts: what the buttons do, with values in place of a selection and errors in place of reports.

In Blender, where the extension is installed::

    from bl_ext.user_default.mobius_flow import Relaxation

and with the Python package beside `bpy`::

    from mobius_flow import Relaxation
"""

import os
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import bpy

from ..core import Curve, Hand, Iterate, MobiusFlowError
from ..core.keys.key_options import Pace
from ..core.keys.placement import Measure
from ..core.ropes import SeparateOptions, TightenOptions
from .curves import bake, bevel, doors, sizes
from .curves.recorded import BakedKeys
from .curves.report import Report
from .curves.session import Session
from .curves.sizes import placement
from .curves.splines import SOURCE, Reference, depth, radii
from .curves.strands import KINDS
from .curves.surroundings import Surroundings
from .live.requirements import BAKED, CLEARABLE, ENTERABLE, POLYGONS, READABLE, TUBED, UNEDITED, idle, require
from .pictures import staging
from .pictures.movie import Filming
from .properties import DEFAULTS, check, key_options, relax_options


class Relaxation:
    """Curve objects that are relaxed together, never through themselves or each other.

    The scene's settings and the selection are ignored. Every method does its whole job before it returns,
    or leaves all as it was and raises an error.

    Parameters
    ----------
    objects
        Curve objects in Object Mode, none of them twice.
    sample_splines
        Whether Bézier and NURBS splines may become the polygons that are drawn for them.

    Examples
    --------
    Relax the active object in 300 iterations at most, and film it:

    >>> relaxation = Relaxation(bpy.context.object)  # doctest: +SKIP
    >>> report = relaxation.relax(max_iterations=300, length=120)  # doctest: +SKIP
    >>> print(report.sentence)  # doctest: +SKIP
    >>> relaxation.set_up_stage()  # doctest: +SKIP
    >>> relaxation.film("/tmp/film.mp4", look="QUICK")  # doctest: +SKIP
    """

    def __init__(self, *objects: bpy.types.Object, sample_splines: bool = False) -> None:
        if not objects:
            raise MobiusFlowError("give at least one curve object")
        for obj in objects:
            if getattr(obj, "type", None) not in {"CURVE", *KINDS}:
                raise MobiusFlowError(f"'{getattr(obj, 'name', obj)}' is not a curve object")
            if objects.count(obj) > 1:
                raise MobiusFlowError(f"'{obj.name}' is given twice")
        self.objects = objects
        self.sample_splines = sample_splines

    def relax(
        self,
        avoid: Iterable[bpy.types.Object] = (),
        drag: Callable[[Hand, Iterate], object] | None = None,
        **settings: Any,
    ) -> Report:
        """Relax from how the curves are, or were before they were baked, and keep the motion as keyframes.

        Parameters
        ----------
        avoid
            Objects that the curves never touch, as they are shown at the current frame; those that are relaxed
            themselves are left out.
        drag
            Called with a `Hand` and every iterate, in the world; it may tell the hand what to do next.
        **settings
            The settings of the operator ``curve.mobius_flow_relax``, by the same names; defaults for those left out.
            Also ``pins``: points that stay where they are, besides those pinned already. They are counted from 0
            through all splines of all objects; for Bézier and NURBS splines the points are those that are drawn.

        Returns
        -------
        Report
            What was done, described in its ``sentence``; ``certified`` says whether all of it was proved. Anything that
            cannot be relaxed, or is not a setting, raises a MobiusFlowError.
        """
        return self._run(complete(settings) | {"avoid": avoid}, drag)

    def morph(self, *goals: bpy.types.Object, avoid: Iterable[bpy.types.Object] = (), **settings: Any) -> Report:
        """Become another curve, or one after the other, by a motion that is proved, and keep it as keyframes.

        The goals are curve objects with splines of the same kinds, and are hidden once they are reached.  Raises
        MobiusFlowError if no motion leads there, or none is found; otherwise as `relax`.
        """
        return self._run(complete(settings) | {"avoid": avoid}, goals=Relaxation(*goals).objects)

    def separate(
        self,
        avoid: Iterable[bpy.types.Object] = (),
        over: str | None = None,
        lengths: str = "free",
        free_ends: bool = False,
        **settings: Any,
    ) -> Report:
        """Become ropes that keep clear, as thick as their bevels, and keep the motion as keys; otherwise as `relax`.

        ``over``, ``lengths`` and ``free_ends`` are those of `mobius_flow.core.separate`.
        """
        ropes = {"over": over, "lengths": lengths, "free_ends": free_ends}
        return self._run(complete(settings) | {"avoid": avoid}, ropes=ropes)

    def tighten(self, starts: int = 1, **settings: Any) -> Report:
        """Pull curves tight, open ones by their ends, as ropes as thick as their bevels, and keep the motion as keys.

        Without bevels, or where curves are thinner, the radius is nine tenths of their thickness.

        Of several ``starts`` the shortest goes on; of the settings of `relax`, ``vertices``, ``seed`` and
        ``time_limit`` count, and those of keys.  Otherwise as `relax`.
        """
        return self._run(complete(settings) | {"avoid": ()}, starts=starts)

    def relax_further(self, avoid: Iterable[bpy.types.Object] = (), **settings: Any) -> Report:
        """Go on from the end of the animation, with new keys after the old ones; otherwise as `relax`.

        ``balance=True`` leads to the image of the same energy that bends least, ``escape_saddles=True`` downhill from a
        saddle, and with ``stability=True`` the report says whether the curves rest at a minimum.
        """
        return self._run(complete(settings) | {"avoid": avoid}, continues=True)

    def _run(
        self, values: Mapping[str, Any], drag: Callable[[Hand, Iterate], object] | None = None, **more: Any
    ) -> Report:
        session = begin(self.objects, values, sample_splines=self.sample_splines, **more)
        report = session.run(drag)
        self.objects = tuple(session.objects)
        return report

    def clear(self) -> None:
        """Take the keys away, and give the curves back as they were before; raises MobiusFlowError as `relax`."""
        require(idle() or CLEARABLE.of(self.objects) or UNEDITED.of(self.objects))
        for obj in self.objects:
            bake.clear(obj)
            sizes.release(obj)
            if SOURCE in obj.data:
                doors.leave(obj.data)

    @property
    def curves(self) -> list[Curve]:
        """The link in the world at each key, the last of them being the result; raises MobiusFlowError without keys."""
        require(BAKED.of(self.objects))
        return BakedKeys(self.objects).curves

    def set_up_stage(
        self, use_camera: bool = True, use_world: bool = True, look: str = "SCENE", hide_others: bool = True
    ) -> bpy.types.Collection:
        """Put a camera, lights and a floor around the curves for as long as they move; see `staging.set_up`.

        The scene is the open one; the look is one of those of `film`. Raises MobiusFlowError if splines cannot be read.
        """
        bpy.context.view_layer.update()
        require(idle() or READABLE.of(self.objects))
        return staging.set_up(bpy.context.scene, self.objects, use_camera, use_world, look, hide_others)

    def film(self, path: str | os.PathLike[str], look: str = "SCENE", overwrite: bool = False) -> Path:
        """Render the frames that the open scene plays to an MP4, and return where it is.

        The look is ``"SCENE"`` for the scene's own settings, ``"QUICK"``, ``"STUDIO"``, ``"PAPER"``, ``"NEON"``,
        ``"ROPE"`` or ``"GLASS"``. Raises MobiusFlowError if it cannot be made, or is there already and may not be
        overwritten.
        """
        require(idle())
        filming = Filming(bpy.context.scene, os.fspath(path), look, overwrite)
        filming.render()
        return filming.path


def begin(
    objects: Sequence[bpy.types.Object],
    values: Mapping[str, Any],
    continues: bool = False,
    sample_splines: bool = False,
    goals: Sequence[bpy.types.Object] = (),
    ropes: Mapping[str, Any] | None = None,
    starts: int = 0,
) -> Session:
    """A session with the values of all settings, which becomes the goals if there are any; raises MobiusFlowError.

    ``ropes``: the options of `separate` but for the radii, which are the tubes', if curves are to be separated.
    ``starts``: their number if curves are to be pulled tight.
    """
    bpy.context.view_layer.update()  # of where objects are that a script has just moved
    require(
        idle() or ENTERABLE.of(objects) or READABLE.of(goals),
        BAKED.of(objects) if continues else None,
        UNEDITED.of(objects),
        None if sample_splines else POLYGONS.of(objects),
        None if ropes is None else TUBED.of(objects),
    )
    options = key_options(values)
    options = bake.continued(objects, options) if continues else options
    constant = options.constant_radius or any(bevel.is_constant(obj.data) for obj in objects if obj.type == "CURVE")
    options = replace(options, constant_radius=constant)
    if not isinstance(values["avoid"], Iterable):
        raise MobiusFlowError(f"avoid is of type {type(values['avoid']).__name__}; give a list of objects")
    avoid = list(values["avoid"])
    if wrong := [each for each in avoid if not isinstance(each, bpy.types.Object)]:
        raise MobiusFlowError(f"avoid has {wrong[0]!r:.40}, which is not an object")
    surroundings = Surroundings(avoid, [*objects, *goals])
    pins, tangents = values.get("pins", ()), values["pin_tangents"]
    job: SeparateOptions | TightenOptions | None = None
    with ExitStack() as undone:
        carriers = []
        for obj in objects:
            carriers.append(obj if obj.type == "CURVE" else doors.enter(obj))
            undone.callback(lambda made: doors.withdraw(made.get()), Reference(carriers[-1]))
        if ropes is not None:  # sizes are what is asked for: nothing is scaled, and no tube fitted
            options = replace(options, keep_size=Measure.LENGTH, fit_bevel=False)
            splines = [(obj, each) for obj in carriers for each in obj.data.splines]
            widths = [placement(obj).stretch * depth(obj.data) * float(radii(each).max()) for obj, each in splines]
            job = SeparateOptions(radius=widths, time_limit=relax_options(values).time_limit, **ropes)
        elif starts:  # the rope gets shorter, not thicker
            options = replace(options, keep_size=options.keep_size or Measure.LENGTH, constant_radius=True)
            wanted = relax_options(values)
            facts: dict[str, Any] = {"vertices": wanted.vertices} if wanted.vertices else {}
            if own := () if options.any_bevel else bevel.own_radii(carriers):
                facts["radius"] = max(own)
            job = TightenOptions(starts=starts, seed=wanted.seed, time_limit=wanted.time_limit, **facts)
        session = Session(carriers, relax_options(values), options, continues, surroundings, pins, tangents, goals, job)
        undone.pop_all()
    return session


def implied(given: Collection[str]) -> dict[str, Any]:
    """Settings that the given ones imply: frames for an iterate mean that pace, and a fit applies to any tube."""
    by_iterate = "frames_per_iterate" in given and "timing" not in given
    return ({"timing": Pace.ITERATE.name} if by_iterate else {}) | {"any_bevel": "fit_bevel" in given}


def complete(given: Mapping[str, Any]) -> dict[str, Any]:
    """All settings, with defaults for those not given; raises OptionError for unknown settings and wrong values."""
    for name, value in given.items():
        if name not in ("any_bevel", "pins"):
            check(name, value)
    return {**DEFAULTS, **implied(given), **given}
