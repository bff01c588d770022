"""Section 6 of Reiter and Schumacher (2021) to the letter, shown in the flow's own time."""

import bpy

settings = bpy.context.scene.mobius_flow

settings.method = "paper"
settings.tolerance = 0.001
settings.max_iterations = 2000
settings.keyframes = "SHAPE_KEYS"
settings.timing = "FLOW_TIME"
