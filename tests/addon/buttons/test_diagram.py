"""Draw Diagram: curves as files for papers."""

import bpy
import pytest
from blender_scenes import add_hopf_link, add_trefoil


def draw(path, **options):
    return bpy.ops.curve.mobius_flow_draw_diagram(filepath=str(path), **options)


def test_selected_curves_are_drawn(tmp_path):
    add_trefoil()
    assert draw(tmp_path / "out.pdf", arrows=True, numbers=True) == {"FINISHED"}
    assert (tmp_path / "out.pdf").read_bytes().startswith(b"%PDF")


def test_links_have_colours(tmp_path):
    add_hopf_link()
    assert draw(tmp_path / "out.svg") == {"FINISHED"}
    assert (tmp_path / "out.svg").read_text(encoding="utf-8").count("<g ") == 2


@pytest.mark.parametrize(("name", "said"), [("out.png", "give 'out.png' one of these"), ("no/out.svg", "no/out.svg")])
def test_other_files_and_places_are_refused(name, said, tmp_path):
    add_trefoil()
    with pytest.raises(RuntimeError, match=said):
        draw(tmp_path / name)
    assert not list(tmp_path.iterdir())
