"""Untangled and nearly at rest, however many steps that takes."""

import bpy

settings = bpy.context.scene.mobius_flow

settings.method = "lbfgs"
settings.tolerance = 0.01
settings.max_iterations = 10000
