"""Möbius Flow: relax and untangle knotted curves without ever letting them pass through themselves.

The same tree is a Blender extension and a Python package. Nothing is imported here before Blender
asks for it, so the library works where there is no Blender. Scripts in Blender find `Relaxation` here, notebooks
`progress`.
"""

from typing import Any

__version__ = "1.0.0"


def register() -> None:
    """Register the Blender extension (called by Blender)."""
    from . import addon

    addon.register()


def unregister() -> None:
    """Unregister the Blender extension (called by Blender)."""
    from . import addon

    addon.unregister()


def __getattr__(name: str) -> Any:
    """Import what scripts use when they ask for it."""
    if name == "Relaxation":
        from .addon.scripting import Relaxation

        return Relaxation
    if name == "progress":
        from mobius_flow.cli.progress import progress

        return progress
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
