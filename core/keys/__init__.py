"""From iterates to what is keyed, drawn or exported; nothing here knows Blender."""
