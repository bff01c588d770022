"""Datablocks found again by their identity."""

from typing import Any

import bpy


class Reference:
    """An object or curve data, whatever it is called now; after undo, Python's own references dangle."""

    def __init__(self, block: bpy.types.ID) -> None:
        self.name = block.name  # when it was last looked up
        self._uid, self._blocks = block.session_uid, "objects" if block.id_type == "OBJECT" else "curves"

    def get(self) -> Any:
        """The datablock, or None if it is gone; it is looked up by its last name first, as there may be thousands."""
        blocks = getattr(bpy.data, self._blocks)
        block = blocks.get(self.name)
        if block is None or block.session_uid != self._uid:
            block = next((block for block in blocks if block.session_uid == self._uid), None)
        if block is not None:
            self.name = block.name
        return block
