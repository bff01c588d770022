"""
A melt in which rings cross
===========================

Simulated rings in a melt must not pass through each other; did they? Here eight rings shiver in a periodic box. One of
them is carried through another, and `audit` finds where and when.
"""

import matplotlib.pyplot as plt
import numpy as np
from drawing import draw
from mobius_flow.core import Curve, audit

rng, box, beads = np.random.default_rng(4), 12.0, 60
angle = np.linspace(0.0, 2.0 * np.pi, beads, endpoint=False)
circle = 2.0 * np.stack([np.cos(angle), np.sin(angle), 0.2 * np.sin(3 * angle)], axis=1)
centres = np.stack(np.meshgrid([3.0, 9.0], [3.0, 9.0], [3.0, 9.0]), axis=-1).reshape(8, 3)
start = np.concatenate([circle @ np.linalg.qr(rng.normal(size=(3, 3)))[0] + centre for centre in centres])
frames = [start + 0.02 * rng.normal(size=start.shape) for _ in range(9)]
for number, frame in enumerate(frames):
    frame[:beads, 1] += 0.9 * number
    frame %= box  # as simulations write it

report = audit(frames, chains=beads, box=[box] * 3)
for each in report.meetings():
    print(f"rings {each.chains}: {each.passings} passings, linking {each.linking:+d}, {each.before} → {each.after}")
assert {each.chains for each in report.meetings()} == {(0, 4)}
for leg, time, place in report.passings[["leg", "time", "place"]]:
    print(f"between frames {leg} and {leg + 1}, at {time:.3f}, near {np.round(place, 2)}")

# %%
# The two rings, put together across the sides of the box, before and after.
figure, axes = plt.subplots(1, 2, figsize=(7, 3.5), layout="constrained")
for ax, frame, title in zip(axes, (report.first, report.last), ("first frame", "last frame"), strict=True):
    pair = [frame.places[k * (beads + 1) :][:beads] for k in (0, 4)]
    draw(ax, Curve.from_components(pair), title)
plt.show()
