"""A new file, Add Knot, Relax: the tangle is in view beside the default cube, falls open and ends as a circle."""

import numpy as np
from case import Steps, picture, until
from hands import button, open_sidebar, window
from scene import is_, obj, points, reaches


def case() -> Steps:
    yield from open_sidebar()
    yield from picture("first-press-0-new")
    yield from button("curve.mobius_flow_add_knot")
    yield from until(lambda: obj().type == "CURVE", "the knot")
    yield from picture("first-press-1-added", differs_from="first-press-0-new")
    window().scene.mobius_flow.view_every = 1
    yield from button("curve.mobius_flow_relax")
    yield from reaches(12)
    yield from picture("first-press-2-falls-open", differs_from="first-press-1-added")
    yield from is_("done")
    yield from picture("first-press-3-circle", differs_from="first-press-2-falls-open")
    radii = np.linalg.norm(points() - points().mean(axis=0), axis=1)
    assert np.ptp(radii) < 1e-2 * radii.mean()
