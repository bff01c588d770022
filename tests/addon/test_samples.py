"""The sample files: the button of each works there."""

import sys
from pathlib import Path

import pytest
from processes import finished

bpy = pytest.importorskip("bpy")
TOOL = Path(__file__).resolve().parents[2] / "tools/samples.py"


@pytest.mark.slow
def test_the_button_that_a_sample_is_named_after_works(tmp_path):
    done = finished([sys.executable, "-P", str(TOOL), str(tmp_path)])
    assert done.returncode == 0, done.stdout + done.stderr
    few = {"Relax": "max_iterations=2", "Separate": "", "Tighten": "time_limit=0.3"}
    assert {path.stem for path in tmp_path.iterdir()} == few.keys()
    press = "".join(
        f"bpy.ops.wm.open_mainfile(filepath={str(tmp_path / f'{name}.blend')!r})\n"
        f"assert bpy.ops.curve.mobius_flow_{name.lower()}({options}) == {{'FINISHED'}}\n"
        "assert bpy.context.object.data.shape_keys or bpy.context.object.data.animation_data\n"
        for name, options in few.items()
    )
    done = finished([sys.executable, "-P", "-c", f"import bpy, mobius_flow\nmobius_flow.register()\n{press}"])
    assert done.returncode == 0, done.stdout + done.stderr
