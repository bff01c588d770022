"""Moving segments, and a proof by separating planes that one does not meet another, or a triangle, for some time.

A segment x₀ + s e and a segment y₀ + r f, or a triangle y₀ + r f + q g, D = x₀ − y₀, whose vertices move linearly in
time. For a *fixed* direction n the numbers ⟨n, x_i(t) − y_j(t)⟩ at the four, or six, pairs of vertices are linear in t;
if all are positive at two times, a plane orthogonal to n separates the two at every time between.
"""

import numpy as np

from ..base import PLANE_ROUNDING, PLANE_UNDERFLOW, TINY, BoolArray, FloatArray, IntArray
from ..base import column_cross as cross
from ..base import column_dot as dot

_PARALLEL = 1e-14  # sin² of the angle below which a cross product is mostly rounding


def march(
    start: FloatArray,
    end: FloatArray,
    vertices: IntArray,
    reached: FloatArray,
    limit: float,
    distance: FloatArray | None = None,
) -> FloatArray:
    """Prove each pair free of contact from plane to plane, for as long as planes make good progress.

    ``start`` and ``end`` are the vertices of the leg, shape (m, n), entries of at most 1 in size, ``vertices`` those of
    the pairs, x₀, x₁, y₀, y₁ and y₂ of triangles, shape (4 or 5, pairs).  Pairs are known to be free up to the times
    ``reached``, shape (pairs,); the new times are at least ``limit`` where nothing stands in the way.  With a
    ``distance``, shape (pairs,), they are proved further apart than that; no exact decision follows on these.
    """
    reached = reached.copy()
    active = np.flatnonzero(reached < limit)
    motion = relative_motion(start, end, vertices[:, active])
    size = np.abs(motion).sum(axis=1)
    t = reached[active]
    # so few pairs are not worth another round where the exact decision is as quick
    rounds, worth, least = (20, 3, 0.01) if distance is None else (40, 40, 1e-4)
    width = np.zeros(len(reached)) if distance is None else distance
    for k in range(rounds):
        if worth * active.size <= k:
            break
        planes = Separation(motion, size, closest_chord(at_time(motion, t)), width[active])
        further = np.minimum(t + (1 - 2.0**-6) * planes.time_left(t), 1.0)  # there still apart, for the next plane
        moved = planes.proves(t) & planes.proves(further)
        further = np.where(moved, further, t)
        reached[active] = further
        go_on = moved & (further < limit) & (further - t > least * further)
        active, motion, size, t = active[go_on], motion[..., go_on], size[..., go_on], further[go_on]
    return reached


def relative_motion(start: FloatArray, end: FloatArray, vertices: IntArray) -> FloatArray:
    """D = x₀ − y₀, e and f, for triangles g too, at both times; shape (2, 3 or 4, m, pairs) from points (m, n)."""
    motion = np.empty((2, len(vertices) - 1, len(start), vertices.shape[1]))
    for k, points in enumerate((start, end)):
        x0, x1, y0, *others = points.take(vertices, axis=1).swapaxes(0, 1)
        np.subtract(x0, y0, out=motion[k, 0])
        np.subtract(x1, x0, out=motion[k, 1])
        for span, y in zip(motion[k, 2:], others, strict=True):
            np.subtract(y, y0, out=span)
    return motion


def at_time(values: FloatArray, t: FloatArray) -> FloatArray:
    """Interpolate values at the two times, stacked along the first axis; ``t`` has shape (pairs,)."""
    return np.asarray((1 - t) * values[0] + t * values[1])


class Separation:
    """The linear functions ⟨n, x_i − y_j⟩ of each pair for fixed directions, lowered by their rounding errors.

    ``motion`` is as `relative_motion` gives it, ``size`` the sum of its vectors' absolute values at both times, shape
    (2, m, pairs), ``direction`` n, shape (m, pairs).  With a distance, functions are lowered by it times |n|, too.
    """

    def __init__(
        self, motion: FloatArray, size: FloatArray, direction: FloatArray, distance: FloatArray | float = 0.0
    ) -> None:
        D, e, *spans = np.einsum("tkmp,mp->ktp", motion, direction)
        width = distance * np.sqrt(dot(direction, direction))
        error = PLANE_ROUNDING * (np.einsum("tmp,mp->tp", size, np.abs(direction)) + width)
        D = D - (width + error + PLANE_UNDERFLOW)
        ends = (D, D + e)
        self.values = np.stack([*ends, *(x - y for y in spans for x in ends)], axis=1)  # (2, 4 or 6, pairs)

    def proves(self, t: FloatArray) -> BoolArray:
        """Whether each pair is separated at its time ``t``, and so between any two times where this is true."""
        return np.asarray((at_time(self.values, t) > 0).all(axis=0))

    def time_left(self, t: FloatArray) -> FloatArray:
        """Time from ``t`` until the first of the functions vanishes; infinite if none falls."""
        fall = self.values[0] - self.values[1]
        with np.errstate(divide="ignore", invalid="ignore"):
            left = np.where(fall > 0, at_time(self.values, t) / fall, np.inf)
        return np.asarray(left.min(axis=0))


def doubtful(points: FloatArray, vertices: IntArray, radius: float = 0.0) -> BoolArray:
    """Still pairs no further apart than the radius, or without a plane that surely separates them; shape (pairs,)."""
    motion = relative_motion(points, points, vertices)
    chord = closest_chord(motion[0])
    planes = Separation(motion, np.abs(motion).sum(axis=1), chord)
    near = dot(chord, chord) <= radius**2
    return np.asarray(near | ~planes.proves(np.zeros(chord.shape[1])))


def closest_chord(motion: FloatArray) -> FloatArray:
    """Return the vector from the closest point of y to the closest point of x: the normal of a plane that may separate.

    ``motion`` holds D, e, f, and g for triangles, at one time, shape (3 or 4, m, pairs); the result has shape
    (m, pairs). It is 0 where segments in the plane cross, and useless where a segment pierces a triangle. No proof
    depends on its accuracy.
    """
    if len(motion) == 3:
        return _to_segment(*motion)
    D, e, f, g = motion
    edges = [np.concatenate(each, axis=1) for each in ((D, D, D - f), (e, e, e), (f, g, g - f))]
    to_edges = np.split(_to_segment(*edges), 3, axis=1)
    return _shortest(np.stack([*to_edges, _to_face(D, f, g), _to_face(D + e, f, g)]))


def _to_segment(D: FloatArray, e: FloatArray, f: FloatArray) -> FloatArray:
    """From the closest point of a segment to that of the other; 0 where segments in the plane cross."""
    ee, ef, ff = (dot(u, v) for u, v in ((e, e), (e, f), (f, f)))
    De, Df = dot(D, e), dot(D, f)
    # The nearest point of the other edge to each of the four end points.
    r = np.stack([Df, Df + ef]) / np.maximum(ff, TINY)
    s = np.stack([-De, ef - De]) / np.maximum(ee, TINY)
    s, r = s.clip(0.0, 1.0), r.clip(0.0, 1.0)
    chords = np.empty((4, *D.shape))
    chords[0] = D - r[0] * f
    chords[1] = D + e - r[1] * f
    chords[2] = D + s[0] * e
    chords[3] = D - f + s[1] * e
    chord = _shortest(chords)
    sine = ee * ff - ef * ef
    s, r = ef * Df - ff * De, ee * Df - ef * De
    inner = (sine > _PARALLEL * ee * ff) & (s > 0) & (s < sine) & (r > 0) & (r < sine)
    if inner.any():
        chord[:, inner] = _along(cross(e[:, inner], f[:, inner]), D[:, inner]) if len(D) == 3 else 0.0
    return chord


def _to_face(D: FloatArray, f: FloatArray, g: FloatArray) -> FloatArray:
    """From the foot of x₀ in a triangle to x₀; D, no shorter than the chord, where the foot is not in the triangle."""
    normal = cross(f, g)
    whole = dot(normal, normal)
    r, q = dot(cross(D, g), normal), dot(cross(f, D), normal)
    inside = (whole > _PARALLEL * dot(f, f) * dot(g, g)) & (r > 0) & (q > 0) & (r + q < whole)
    return np.where(inside, _along(normal, D), D)


def _shortest(chords: FloatArray) -> FloatArray:
    """The shortest of several vectors of each pair; shapes (k, m, pairs) -> (m, pairs)."""
    nearest = np.einsum("kmp,kmp->kp", chords, chords).argmin(axis=0)
    return np.asarray(np.take_along_axis(chords, nearest[None, None], axis=0)[0])


def _along(normal: FloatArray, D: FloatArray) -> FloatArray:
    """The part of D along a normal: a good direction even where the difference of close points is mostly rounding."""
    return np.asarray(normal * (dot(normal, D) / np.maximum(dot(normal, normal), TINY)))
