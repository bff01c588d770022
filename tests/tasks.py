"""Tasks and options from one list of settings, as the command line has them."""

from typing import Any

from mobius_flow.core import Curve, RelaxOptions, Task


def wanted(curve: Curve, **settings: Any) -> tuple[Task, RelaxOptions]:
    """What `relax` is given: the obstacles ``avoid``, ``pins`` and ``pin_tangents`` belong to the task."""
    obstacles, pins = settings.pop("avoid", ()), settings.pop("pins", ())
    tangents = settings.pop("pin_tangents", False)
    return Task(curve=curve, obstacles=obstacles, pins=pins, pin_tangents=tangents), RelaxOptions(**settings)
