"""Blender's curve objects: read as one link, shown as they move, keyed, and put back bit for bit."""
