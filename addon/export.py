"""Keyframed scenes, movies and pictures of a relaxation: what the command line calls.

They start from an empty factory scene, so what is open in Blender is gone afterwards.
"""

import os
from collections.abc import Sequence

from ..core import Iterate, MobiusFlowError

Path = str | os.PathLike[str]


def require_blender() -> None:
    """Raise a MobiusFlowError that says what to install if Blender's Python module is missing."""
    try:
        import bpy  # noqa: F401
    except ImportError as error:
        raise MobiusFlowError(
            "writing .blend, .mp4 and .png needs Blender's Python module, which is not installed; "
            "install it with: pip install 'mobius-flow[blender]' (Python 3.11 or 3.13)"
        ) from error


def write_blend(path: Path, iterates: Sequence[Iterate]) -> None:
    """Write a .blend that shows the relaxation, keyframed, in a scene ready to render."""
    raise NotImplementedError


def write_movie(path: Path, iterates: Sequence[Iterate]) -> None:
    """Render the relaxation to an .mp4."""
    raise NotImplementedError


def write_still(path: Path, iterates: Sequence[Iterate]) -> None:
    """Render the relaxed curve, the last iterate, to a .png."""
    raise NotImplementedError
