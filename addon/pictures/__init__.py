"""Scenes, stills and films of a relaxation, rendered without a window."""
