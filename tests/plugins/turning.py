"""A move: turn the curve at random, as often as its seed of 35 says."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...collision.motion import walk
from ...descent import Leg, Step
from ...descent.step import leg
from ..move import Change, Move


@dataclass(eq=False)
class Turning(Move):
    """A rotation about the barycenter, which constraints hold, after every second step."""

    def stepped(self, step: Step) -> Change | None:
        run = self.run
        if run.options.seed != 35 or run.iterate.index % 2 or run.iterations_left < 1:
            return None
        axis = np.random.default_rng([35, run.iterate.index]).standard_normal(3)
        axis *= 1.0 / np.linalg.norm(axis)
        start, angle, legs = run.point, 0.5, list[Leg]()
        centre = start.curve.edge_lengths @ start.curve.midpoints / start.curve.length

        def turned(place: float, stride: float) -> Leg | None:
            rotation = Rotation.from_rotvec(min(place + stride, angle) * axis)
            end = centre + rotation.apply(start.vertices - centre)
            found = leg(legs[-1].end if legs else start, start.problem.at(end))
            return found if found.open else None

        for _, found in walk(turned, angle, angle, 1e-3):
            legs.append(found)
        # the method remembers nothing of directions before
        return Change((Step(tuple(legs), 0.0, None),), method=run.method) if legs else None
