"""The Blender side: settings, operators, panel, keyframes and pictures; nothing numerical.

Nothing is imported before Blender registers the extension or the command line asks for a picture,
so that the library works where there is no Blender.
"""


def register() -> None:
    from . import registration

    registration.register()


def unregister() -> None:
    from . import registration

    registration.unregister()
