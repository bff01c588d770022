"""``mobius-flow atlas``: the minima that batches have found, as pages to read and as a data package."""

import argparse
import hashlib
import json
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...cli.options import DEFAULT
from ...cli.places import check_directory, export
from ...cli.progress import live
from ...cli.terminal import emit, quoted, report
from ...core.base.errors import MobiusFlowError, counted
from . import data, pages
from .entries import curve_of, entry
from .folder import Folder
from .runs import Runs

LARGE, SMALL = (640, 480), (240, 180)
SAMPLES = 8  # of a pixel: more make no visible difference after denoising
NO_LOOK = "none"


def make(options: argparse.Namespace) -> int:
    """Make what is missing, entry by entry."""
    style, room = usable(options.look), pages.environment()
    check_directory(options.output)
    folder = Folder(Path(options.output))
    runs = Runs.of(map(Path, options.results))
    entries = []
    with live() as show:
        for k, (name, each) in enumerate(runs.by_type.items(), start=1):
            show(f"type {k} of {len(runs.by_type)}: {name}")
            found, doubtful = entry(folder, name, each)
            for reason, names in doubtful.items():
                runs.left_out[reason] += names
            for minimum in found["minima"] if found else ():
                minimum["picture"] = picture(folder, name, minimum, style)
            entries += [found] if found else []
    if not entries:
        raise MobiusFlowError(f"there is nothing for an atlas: {runs.missing}")
    data.write(folder, entries)
    pages.write(folder, entries, room)
    folder.close()
    source = f"from {counted(sum(each['runs'] for each in entries), 'run')}"
    rows = [("left out", str(runs.missing or "")), ("wrote", [quoted(folder.path / "index.html")])]
    emit(report((f"✓ {counted(len(entries), 'type')}", source), rows, sys.stdout))
    return 0


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
    return look or DEFAULT
