"""Pictures of the minima, by Blender if its module is installed; each is made once."""

import hashlib
import json
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...addon.pictures import export, looks
from ...core import MobiusFlowError
from .entries import curve_of
from .folder import Folder

LARGE, SMALL = (640, 480), (240, 180)
SAMPLES = 8  # of a pixel: more make no visible difference after denoising
NO_LOOK = "none"


def picture(folder: Folder, name: str, minimum: Mapping[str, Any], look: str) -> str | None:
    """The path of a minimum's picture in the folder, rendered unless it is there; the least minimum's is large.

    Its name contains the hash of what it shows, as another curve may take its place.
    """
    if look == NO_LOOK:
        return None
    size = LARGE if minimum["number"] == 1 else SMALL
    shown = json.dumps([minimum["fourier"], look, size, SAMPLES])
    path = f"pictures/{name}-{minimum['number']}-{hashlib.sha256(shown.encode()).hexdigest()[:10]}.jpg"
    if not folder.keep(path):
        curve = curve_of(minimum)
        with tempfile.TemporaryDirectory(prefix="mobius-flow-") as room:
            made = Path(room, "picture.jpg")
            smooth = curve.polygon([2 * n for n in curve.sizes])
            export.write_picture(made, smooth, *size, look, SAMPLES)
            folder.put(path, made.read_bytes())
    return path


def usable(look: str | None) -> str:
    """The look asked for, by default the pictures' own if Blender's module is installed; raises MobiusFlowError."""
    if look == NO_LOOK:
        return look
    try:
        export.require_blender()
    except MobiusFlowError:
        if look is None:
            return NO_LOOK
        raise
    return look or looks.DEFAULT
