"""The Blender side: settings, operators, panel, keyframes and pictures; nothing numerical.

Nothing is imported before Blender registers the extension or the command line asks for a picture,
so that the library works where there is no Blender.
"""


def register() -> None:
    """Add Möbius Flow's classes, settings and menu entry to Blender."""
    from . import registration

    registration.register()


def unregister() -> None:
    """Remove everything that `register` added."""
    from . import registration

    registration.unregister()
