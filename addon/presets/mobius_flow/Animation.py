"""Five seconds of even motion, with a rest before and after it."""

import bpy

settings = bpy.context.scene.mobius_flow

settings.method = "lbfgs"
settings.tolerance = 0.001
settings.keyframes = "SHAPE_KEYS"
settings.timing = "EVEN"
settings.length = 120
settings.hold_start = 12
settings.hold_end = 24
