"""A local minimum of the energy to many digits: a saddle is noticed, and left downhill."""

import bpy

settings = bpy.context.scene.mobius_flow

settings.method = "trust-region"
settings.tolerance = 1e-08
settings.max_iterations = 5000
settings.escape_saddles = True
