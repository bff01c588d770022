"""The live relaxation: a worker process that computes, a run that shows, and operators that listen.

Nothing here is numerical, and nothing that the worker needs imports bpy.
"""
