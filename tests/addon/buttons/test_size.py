"""Keep Size, and sizes that are kept while curves are baked."""

from itertools import pairwise

import bpy
import numpy as np
import pytest
from blender_scenes import (
    add_curve,
    add_hopf_link,
    add_trefoil,
    contents,
    evaluated,
    fcurves,
    in_world,
    place,
    relax,
    sentence,
    stored,
)
from mobius_flow.addon.buttons import shape
from mobius_flow.addon.curves import bake, recorded
from mobius_flow.addon.curves.recorded import BakedKeys, Recorded
from mobius_flow.core import Curve
from mobius_flow.core.collision import is_free
from mobius_flow.core.keys.placement import Measure
from shapes import lattice_knot

OPS = bpy.ops.curve
KEYED = ["SHAPE_KEYS", "FCURVES"]
MEASURES = [measure.name for measure in Measure]


def baked(keyframes="SHAPE_KEYS", **options):
    """A lattice figure-eight knot that shrinks as seen on the screen."""
    add_curve([lattice_knot("4_1").vertices])
    return relax(**{"max_iterations": 8, "vertices": 120, "keyframes": keyframes} | options)


def shown(obj, frames):
    """The world's curve at some frames."""
    return [Curve(in_world(obj, evaluated(obj, frame))) for frame in frames]


def frames_of(obj):
    owner = obj.data.shape_keys or obj.data
    first, last = owner.animation_data.action.curve_frame_range
    return np.linspace(first, last, 5)


@pytest.mark.parametrize("keyframes", KEYED)
@pytest.mark.parametrize("measure", MEASURES)
def test_a_size_stays(keyframes, measure):
    obj = baked(keyframes)
    place(obj)
    before = shown(obj, frames_of(obj))
    assert OPS.mobius_flow_keep_size(measure=measure) == {"FINISHED"}
    after, measured = shown(obj, frames_of(obj)), Measure[measure].of
    np.testing.assert_allclose(after[0].vertices, before[0].vertices, atol=1e-5)
    sizes = [measured(curve) for curve in BakedKeys([obj]).curves]
    np.testing.assert_allclose(sizes, measured(before[0]), rtol=1e-5)
    for a, b in zip(before, after, strict=True):
        centers = [curve.edge_lengths @ curve.midpoints / curve.length for curve in (a, b)]
        assert np.linalg.norm(centers[1] - centers[0]) < 0.05 * measured(before[0])


@pytest.mark.parametrize("keyframes", KEYED)
def test_the_size_of_the_last_key(keyframes):
    obj = baked(keyframes)
    end = BakedKeys([obj]).curves[-1]
    assert OPS.mobius_flow_keep_size(measure="RADIUS", reference="LAST") == {"FINISHED"}
    curves = BakedKeys([obj]).curves
    np.testing.assert_allclose(curves[-1].vertices, end.vertices, atol=1e-6)
    np.testing.assert_allclose([Measure.RADIUS.of(c) for c in curves], Measure.RADIUS.of(end), rtol=1e-5)
    if keyframes == "SHAPE_KEYS":  # F-curves move the points themselves
        np.testing.assert_array_equal(stored(obj.data), BakedKeys([obj]).frames[-1])


@pytest.mark.parametrize("keyframes", KEYED)
def test_scaled_keys_are_proved_as_they_are_stored(keyframes):
    obj = baked(keyframes)
    OPS.mobius_flow_keep_size(measure="BOX")
    keys = BakedKeys([obj])
    assert keys.unproved == 0
    for a, b in pairwise(keys.frames):
        assert is_free(keys.mesh, a.astype(float), b.astype(float))


def test_motions_that_cannot_be_proved_are_told_of(monkeypatch):
    obj, told = baked(), []
    monkeypatch.setattr(recorded, "is_free", lambda *_: False)
    monkeypatch.setattr(shape, "_report", lambda _, what, unproved: told.append((what, unproved)))
    assert OPS.mobius_flow_keep_size(measure="BOX") == {"FINISHED"}
    count = len(obj.data.shape_keys.key_blocks)
    assert told == [(f"The bounding box of 'Knot' stays at all {count} keys", count - 1)]


class Teller:
    def report(self, *words):
        self.words = words


def test_words_about_proofs():
    teller = Teller()
    shape._report(teller, "It stays", 0)
    assert teller.words == ({"INFO"}, "It stays, proved free of contact")
    shape._report(teller, "It stays", 1)
    assert teller.words == ({"WARNING"}, "It stays; 1 motion between keys is NOT proved free of contact")
    shape._report(teller, "It stays", 2)
    assert teller.words == ({"WARNING"}, "It stays; 2 motions between keys are NOT proved free of contact")


@pytest.mark.parametrize("keyframes", KEYED)
def test_scaled_curves_are_still_baked_and_can_be_cleared(keyframes):
    obj = add_trefoil()
    before = stored(obj.data)
    obj.data.bevel_depth = 0.1
    relax(max_iterations=4, keyframes=keyframes, fit_bevel=True)
    assert OPS.mobius_flow_keep_size(measure="BOX") == {"FINISHED"}
    assert bake.is_baked(obj.data)
    assert not bake.is_edited(obj.data)
    assert OPS.mobius_flow_continue(max_iterations=2, fit_bevel=False) == {"FINISHED"}
    assert OPS.mobius_flow_clear() == {"FINISHED"}
    np.testing.assert_array_equal(stored(obj.data), before)
    assert obj.data.bevel_depth == pytest.approx(0.1)


def test_the_tube_is_scaled_with_the_curve():
    obj = baked(fit_bevel=True)
    radii, lengths = Recorded.of(obj).radii[:, 0], [curve.length for curve in BakedKeys([obj]).curves]
    OPS.mobius_flow_keep_size(measure="BOX")
    factors = [curve.length / old for curve, old in zip(BakedKeys([obj]).curves, lengths, strict=True)]
    assert max(factors) > 1.05 * min(factors)
    np.testing.assert_allclose(Recorded.of(obj).radii[:, 0], np.multiply(radii, factors), rtol=1e-4)


@pytest.mark.parametrize("keyframes", [*KEYED, "RESULT"])
@pytest.mark.parametrize("measure", ["BOX", "RADIUS"])
def test_a_size_stays_while_it_is_baked(keyframes, measure):
    start = add_curve([lattice_knot("4_1").vertices])
    size = Measure[measure].of(Curve(stored(start.data).astype(float)))
    obj = relax(max_iterations=8, vertices=120, keyframes=keyframes, keep_size=measure)
    curves = [Curve(stored(obj.data).astype(float))] if keyframes == "RESULT" else BakedKeys([obj]).curves
    np.testing.assert_allclose([Measure[measure].of(curve) for curve in curves], size, rtol=1e-5)
    if keyframes != "RESULT":
        assert BakedKeys([obj]).unproved == 0


def test_the_length_is_what_the_flow_keeps_bit_for_bit():
    points = []
    for options in ({}, {"keep_size": "LENGTH"}):
        obj = baked(**options)
        points.append(BakedKeys([obj]).frames)
        obj.select_set(False)
    np.testing.assert_array_equal(*points)


def test_a_curve_stays_in_view_by_itself():
    radii = [Measure.RADIUS.of(curve) for curve in BakedKeys([baked(keep_size="AUTO")]).curves]
    np.testing.assert_allclose(radii, radii[0], rtol=1e-5)


def test_a_curve_that_grows_is_not_scaled_by_itself():
    lengths = [curve.length for curve in BakedKeys([baked(keep_size="AUTO", grow=1.1)]).curves]
    assert lengths[-1] > 1.05 * lengths[0]


def test_a_size_that_was_kept_is_kept_on():
    obj = baked(keep_size="BOX")
    size = Measure.BOX.of(BakedKeys([obj]).curves[0])
    assert OPS.mobius_flow_continue(max_iterations=5, keep_size="BOX", fit_bevel=False) == {"FINISHED"}
    np.testing.assert_allclose([Measure.BOX.of(c) for c in BakedKeys([obj]).curves], size, rtol=1e-5)


def test_links_are_scaled_together():
    first = add_hopf_link()
    points = stored(first.data)
    bpy.data.objects.remove(first)
    objects = [add_curve([points[:24]], "A"), add_curve([points[24:] * 2], "B")]
    objects[1].scale = (0.5, 0.5, 0.5)
    for obj in objects:
        obj.select_set(True)
    relax(max_iterations=5)
    size = Measure.RADIUS.of(BakedKeys(objects).curves[0])
    assert OPS.mobius_flow_keep_size(measure="RADIUS") == {"FINISHED"}
    keys = BakedKeys(objects)
    np.testing.assert_allclose([Measure.RADIUS.of(curve) for curve in keys.curves], size, rtol=1e-5)
    assert keys.unproved == 0


def test_curves_that_were_baked_apart_are_refused():
    one = baked()
    one.select_set(False)
    two = add_trefoil()
    relax(max_iterations=2)
    one.select_set(True)
    before = contents()
    with pytest.raises(RuntimeError) as error:
        OPS.mobius_flow_keep_size()
    assert "were not baked together; select one of them at a time" in sentence(error.value)
    assert contents() == before
    assert {one, two} == set(bpy.context.selected_objects)


def test_edited_keys_are_left_alone():
    obj = baked()
    obj.data.shape_keys.key_blocks[2].data[0].co.x += 1
    before = BakedKeys([obj]).frames
    with pytest.raises(RuntimeError, match="were edited"):
        OPS.mobius_flow_keep_size()
    np.testing.assert_array_equal(BakedKeys([obj]).frames, before)


def test_f_curves_with_keys_removed_are_refused():
    obj = baked("FCURVES")
    points = fcurves(obj.data)[0].keyframe_points
    points.remove(points[1])
    with pytest.raises(RuntimeError, match="were edited; undo that, or Bake Again"):
        OPS.mobius_flow_keep_size()
