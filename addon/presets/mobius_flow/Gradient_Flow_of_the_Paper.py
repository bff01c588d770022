"""The explicit projected flow of Reiter and Schumacher (2021), Section 6, shown in the flow's own time."""

import bpy

settings = bpy.context.scene.mobius_flow

settings.method = "flow-moebius"
settings.tolerance = 0.001
settings.max_iterations = 2000
settings.keyframes = "SHAPE_KEYS"
settings.timing = "FLOW_TIME"
