"""Melts of rings in periodic boxes, passings planted in them, and an oracle that finds passings in another way."""

import numpy as np
from motions import Array
from scipy.spatial import cKDTree

Found = list[tuple[int, int, int, float]]  # two edges, by their first beads; the sign; the time


def melt(rings: int, beads: int, seed: int, density: float = 0.85, bond: float = 0.97) -> tuple[Array, float]:
    """Random closed walks with bonds of one length, and the edge of their box."""
    rng, box = np.random.default_rng(seed), float((rings * beads / density) ** (1 / 3))
    bonds = rng.normal(size=(rings, beads, 3))
    for _ in range(30):
        bonds -= bonds.mean(axis=1, keepdims=True)
        bonds *= bond / np.linalg.norm(bonds, axis=2, keepdims=True)
    bonds -= bonds.mean(axis=1, keepdims=True)
    return (np.cumsum(bonds, axis=1) + rng.uniform(0.0, box, (rings, 1, 3))).reshape(-1, 3), box


def heads(count: int, beads: int) -> Array:
    following = np.arange(1, count + 1)
    following[beads - 1 :: beads] -= beads
    return following


def planted(
    points: Array, box: float, beads: int, count: int, seed: int, noise: float = 0.01
) -> tuple[Array, set[tuple[int, int]]]:
    """Where beads go, with some noise, and pairs of edges that pass through each other at 0.625 of the time.

    A point of one edge of each pair is carried to where a point of the other is by then.
    """
    rng, ahead, time = np.random.default_rng(seed), heads(len(points), beads), 0.625
    moved = points + noise * rng.normal(size=points.shape)
    tree, pairs = cKDTree(points % box, boxsize=box), set[tuple[int, int]]()
    used: set[int] = set()
    while len(pairs) < count:
        a = rng.integers(len(points))
        b = rng.choice(tree.query_ball_point(points[a] % box, 1.5))
        four = {a, ahead[a], b, ahead[b]}
        if len(four) < 4 or four & used:
            continue
        s, t = rng.uniform(0.2, 0.8, 2)
        (p, q), (u, v) = ((1 - time) * points[each] + time * moved[each] for each in ([a, ahead[a]], [b, ahead[b]]))
        way = (1 - t) * u + t * v - (1 - s) * p - s * q
        way -= box * np.round(way / box)
        if np.linalg.norm(way) < 1.0:
            moved[[a, ahead[a]]] += way / time
            used |= four
            pairs.add((min(a, b), max(a, b)))
    return moved, pairs


def passings_by_eigenvalues(before: Array, after: Array, box: float, beads: int) -> Found:
    """Of all pairs of edges of rings that may come near, in nearest images: roots of det(D, e, f) by eigenvalues.

    No edge may move or extend by half a box.  It fails if a case is too near to a degenerate one for this.
    """
    ahead = heads(len(before), beads)
    bonds = [each - box * np.round(each / box) for each in (frame[ahead] - frame for frame in (before, after))]
    ends = np.stack([before, after, before + bonds[0], after + bonds[1]])
    middle = ends.mean(axis=0)
    radius = np.linalg.norm(ends - middle, axis=2).max(axis=0)
    assert radius.max() < box / 4
    i, j = cKDTree(middle % box, boxsize=box).query_pairs(2.0 * radius.max(), output_type="ndarray").T
    keep = (ahead[i] != j) & (ahead[j] != i)
    i, j = i[keep], j[keep]
    shift = box * np.round((middle[i] - middle[j]) / box)
    keep = np.linalg.norm(middle[i] - middle[j] - shift, axis=1) <= radius[i] + radius[j]
    i, j, shift = i[keep], j[keep], shift[keep]

    def at(time: Array | float, k: Array) -> tuple[Array, Array, Array]:
        """D, e and f of some pairs."""
        t, a, b = np.reshape(time, (-1, 1)), i[k], j[k]
        ways = (before[a] - before[b] - shift[k], after[a] - after[b] - shift[k]), (bonds[0][a], bonds[1][a])
        D, e, f = ((1 - t) * start + t * end for start, end in (*ways, (bonds[0][b], bonds[1][b])))
        return D, e, f

    times, every = np.array([0.0, 1 / 3, 2 / 3, 1.0]), np.arange(len(i))
    volumes = np.stack([np.einsum("pm,pm->p", D, np.cross(e, f)) for D, e, f in (at(t, every) for t in times)])
    cubic = np.linalg.solve(np.vander(times, 4), volumes)  # the highest power first
    companion = np.zeros((len(i), 3, 3))
    companion[:, 1, 0] = companion[:, 2, 1] = 1.0
    companion[:, 0] = -(cubic[1:] / cubic[0]).T
    found: Found = []
    for roots in np.linalg.eigvals(companion).T:
        k = np.flatnonzero((abs(roots.imag) < 1e-7) & (roots.real > 0.0) & (roots.real < 1.0))
        t, (p, q, r, c) = roots.real[k], cubic[:, k]
        for _ in range(3):
            slope = (3 * p * t + 2 * q) * t + r
            t = t - (((p * t + q) * t + r) * t + c) / slope
        D, e, f = at(t, k)
        normal = np.cross(e, f)
        parts = np.stack([np.einsum("pm,pm->p", np.cross(v, D), normal) for v in (f, e)])
        parts /= np.einsum("pm,pm->p", normal, normal)
        inside = ((parts > 0.0) & (parts < 1.0)).all(axis=0)
        assert np.abs(np.stack([parts, 1.0 - parts]))[:, :, inside].min(initial=1.0) > 1e-9
        assert np.abs(np.stack([t, 1.0 - t]))[:, inside].min(initial=1.0) > 1e-9
        columns = i[k], j[k], np.sign((3 * p * t + 2 * q) * t + r).astype(int), t
        found += zip(*(column[inside].tolist() for column in columns), strict=True)
    return sorted(found)
