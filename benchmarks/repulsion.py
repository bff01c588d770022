"""Times and errors of the repulsion of obstacles: python benchmarks/repulsion.py [vertices ...] [--latitudes N]

One line per obstacle, a sphere of triangles or the net of their sides, and curve, a torus knot well inside or one that
comes near: the simplices, those that an edge sees one by one and the clusters it sees, then the tree, the schedule of a
curve, the test whether it still suits, and R with its derivative, all in milliseconds of processor time; up to 1,000
vertices also the relative error. Run it with one BLAS thread on a quiet machine.
"""

import argparse

import numpy as np
from collision import best, torus_knot
from mobius_flow.core import Curve
from mobius_flow.core.curve.obstacle import Obstacle
from mobius_flow.core.energies.repulsion import Repulsion
from mobius_flow.core.energies.repulsion.repulsion import KEPT
from mobius_flow.core.energies.repulsion.schedule import Schedule

MOST_DENSE = 1_000


def sphere(latitudes: int) -> Obstacle:
    """The unit sphere by its latitudes and as many longitudes: 28,560 triangles of 120."""
    theta = np.pi * (np.arange(latitudes) + 0.5) / latitudes
    phi = 2 * np.pi * np.arange(latitudes) / latitudes
    circles = np.stack(
        np.broadcast_arrays(
            np.sin(theta)[:, None] * np.cos(phi), np.sin(theta)[:, None] * np.sin(phi), np.cos(theta)[:, None]
        ),
        axis=2,
    )
    index = np.arange(latitudes**2).reshape(latitudes, latitudes)
    a, b, c, d = index[:-1], np.roll(index, -1, axis=1)[:-1], index[1:], np.roll(index, -1, axis=1)[1:]
    faces = np.concatenate([np.stack(corners, axis=2).reshape(-1, 3) for corners in ((a, b, d), (a, d, c))])
    return Obstacle(circles.reshape(-1, 3), faces, "sphere")


def net(surface: Obstacle) -> Obstacle:
    """The net of sides of the same triangles."""
    sides = np.sort(np.concatenate([surface.faces[:, [i, i - 1]] for i in range(3)]), axis=1)
    return Obstacle(surface.vertices, np.unique(sides, axis=0), "net")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vertices", nargs="*", type=int, default=[512, 2_048, 8_192])
    parser.add_argument("--latitudes", type=int, default=120, metavar="N", help="of the sphere (default: 120)")
    arguments = parser.parse_args()
    surface = sphere(arguments.latitudes)
    titles = ("simplices", "single", "clusters", "tree", "schedule", "suits", "R and DR", "error")
    print(f"{'obstacle':10}{'curve':8}{'vertices':>9}" + "".join(f"{title:>10}" for title in titles))
    for n in arguments.vertices:
        for obstacle in (surface, net(surface)):
            for name, radius in (("inside", 0.6), ("near", 0.99)):
                curve = Curve(radius / 3.0 * torus_knot(n))
                print(f"{obstacle.name:10}{name:8}{n:9d}" + line(obstacle, curve, 3), flush=True)


def line(obstacle: Obstacle, curve: Curve, repetitions: int) -> str:
    (term,) = Repulsion.of([obstacle])
    frozen = term.frozen_at(curve)
    schedule = Schedule.of(curve, term.clusters, term.theta)
    seen = [sum(len(panels) for _, panels in groups) / len(curve) for groups in (schedule.single, schedule.clustered)]
    times = [
        best(lambda: Repulsion.of([obstacle]), 1),
        best(lambda: Schedule.of(curve, term.clusters, term.theta), repetitions),
        best(lambda: schedule.suits(curve, term.clusters, KEPT), repetitions),
        best(lambda: frozen.value_and_derivative(curve), repetitions),
    ]
    text = f"{len(obstacle.faces):10d}" + "".join(f"{number:10.1f}" for number in (*seen, *times))
    if len(curve) > MOST_DENSE:
        return text
    exact = Repulsion(term.clusters, theta=0.0)
    return text + f"{abs(term.value(curve) / exact.value(curve) - 1.0):10.1e}"


if __name__ == "__main__":
    main()
