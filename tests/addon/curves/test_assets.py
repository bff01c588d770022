"""The bundled nodes are what their text says."""

import json
from pathlib import Path
from runpy import run_path

import bpy
import pytest
from mobius_flow.addon.curves.assets import bundled

TOOL = Path(__file__).resolve().parents[3] / "tools" / "nodes.py"


@pytest.mark.skipif(bpy.app.version[:2] != (4, 2), reason="later versions add settings to nodes")
def test_the_text_describes_the_nodes():
    """python tools/nodes.py makes them again, and --write their text."""
    for name, group in json.loads(TOOL.with_suffix(".json").read_text(encoding="utf-8")).items():
        assert run_path(str(TOOL))["told"](bundled("node_groups", name)) == group
