"""The computing part: the worker process and its wire, where vertices are stored, and which keys a motion needs.

Nothing here knows Blender: the worker runs these modules in a Python of its own.
"""
