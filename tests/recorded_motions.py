"""Motions from iterates that are made up, and what is proved of their keys."""

from itertools import pairwise

import numpy as np
from mobius_flow.core import Curve, Iterate
from mobius_flow.core.collision import free_motion
from mobius_flow.core.keys.motion import Recording
from mobius_flow.core.keys.placement import Link, Placement
from shapes import regular_polygon


def at_rest(*counts):
    """Objects with so many components each, all at the world's origin."""
    return Link(tuple(Placement(np.eye(3), np.zeros(3)) for _ in counts), counts)


def iterate(index, vertices, mesh_of, path=None, **changes):
    curve = mesh_of.with_vertices(vertices)
    path = ((vertices,) if index else ()) if path is None else path
    values = {"energy": 0.0, "gradient_norm": 1.0, "step_size": 0.1, "certified": True, "edge_length_error": 0.0}
    values |= {"method": "lbfgs", "grown": 1.0}
    return Iterate(index=index, curve=curve, path=path, **(values | changes))


def around(angle):
    """Two squares; the second passes over the first, in a half circle of legs whose chord goes through it."""
    still = 4 * regular_polygon(4).vertices
    moving = 0.5 * regular_polygon(4).vertices + np.round([4.0 + 3 * np.cos(angle), 0.0, 3 * np.sin(angle)], 6)
    return Curve.from_components([still, moving])


def followed(iterates, link=None, **shown):
    motion = Recording(link or at_rest(1), **shown)
    for each in iterates:
        motion.add(each)
    return motion


def collected(curves, paths=(), link=None):
    made = (iterate(k, curve.vertices, curve, dict(paths).get(k)) for k, curve in enumerate(curves))
    return followed(made, link or at_rest(len(curves[0].components)))


def assert_proved(keys, mesh):
    assert keys.certified
    for a, b in pairwise(keys.keys):
        assert a.time < b.time
        assert a.points.dtype == b.points.dtype == np.float32
        assert free_motion(mesh, a.points.astype(np.float64), b.points.astype(np.float64)).time == 1.0
