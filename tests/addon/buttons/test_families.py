"""Knots of families from the Add menu."""

import bpy
import numpy as np
import pytest
from blender_scenes import contents, sentence, stored
from mobius_flow.core import Curve
from mobius_flow.core.collision import check_embedded


@pytest.mark.parametrize(
    ("options", "name", "components"),
    [
        ({"kind": "TORUS", "p": 4, "q": 6}, "T(4,6)", 2),
        ({"kind": "BRAID"}, "braid(1,-2,1,-2,1,-2)", 3),
        ({"kind": "BRAID", "word": "1, 1 ,1"}, "braid(1,1,1)", 1),
        ({"kind": "LISSAJOUS"}, "Lissajous(3,4,7)", 1),
        ({"kind": "CABLE"}, "Cable(2,1) of 3_1", 1),
        ({"kind": "CABLE", "companion": "figure-eight", "strands": 3, "turns": 3}, "Cable(3,3) of figure-eight", 3),
        ({"kind": "DOUBLE", "companion": "4_1 Figure-Eight", "twists": 1}, "Double of 4_1", 1),
    ],
)
def test_families(options, name, components):
    assert bpy.ops.curve.mobius_flow_add_knot(**options) == {"FINISHED"}
    obj = bpy.context.object
    assert obj.name == name
    sizes = [len(spline.points) for spline in obj.data.splines]
    assert len(sizes) == components
    points = stored(obj.data).astype(np.float64)
    assert np.ptp(points, axis=0).max() == pytest.approx(2)
    check_embedded(Curve.from_components(np.split(points, np.cumsum(sizes)[:-1])))


@pytest.mark.parametrize(
    "options",
    [
        {"kind": "TORUS", "p": 0},
        {"kind": "TORUS", "p": 101, "q": 2},
        {"kind": "BRAID", "word": "1 x"},
        {"kind": "LISSAJOUS", "frequency_x": 2, "frequency_y": 4},
        {"kind": "LISSAJOUS", "phase_x": 0.0, "phase_y": 0.0},
        {"kind": "CABLE", "companion": "nonsense"},
        {"kind": "DOUBLE", "companion": "L2a1 Hopf Link"},
    ],
)
def test_what_meets_itself_or_is_none_is_refused(options):
    before = contents()
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_add_knot(**options)
    assert len(sentence(error.value)) > 10
    assert contents() == before
