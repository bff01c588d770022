"""Which frames a scene plays, and what it says where they are not those of the animation."""

import bpy
from blender_scenes import add_trefoil, relax


def test_the_scene_plays_what_is_asked_for(capfd):
    add_trefoil()
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 40
    relax(max_iterations=3, timing="EVEN", length=40)
    assert "Set Scene Range" not in capfd.readouterr().out
    relax(max_iterations=3, timing="EVEN", length=40, hold_end=5, start_frame=6)
    said = capfd.readouterr().out
    assert "The scene plays frames 1 to 40 only, the animation has 6 to 45: press Set Scene Range" in said
    assert bpy.ops.curve.mobius_flow_scene_range() == {"FINISHED"}
    assert (scene.frame_start, scene.frame_end) == (6, 45)
    assert not capfd.readouterr().out


def test_nobody_is_told_to_play_negative_frames(capfd):
    add_trefoil()
    scene = bpy.context.scene
    sentence = "only, the animation has -9 to 30: no scene plays negative frames, so bake again with a later Start"
    relax(max_iterations=3, timing="EVEN", length=40, start_frame=-9)
    assert f"The scene plays frames 1 to 250 {sentence}" in capfd.readouterr().out
    bpy.ops.curve.mobius_flow_scene_range()
    assert f"The scene plays frames 0 to 30 {sentence}" in capfd.readouterr().out
    assert (scene.frame_start, scene.frame_end) == (0, 30)
