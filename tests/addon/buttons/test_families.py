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
        ({}, "T(3,4)", 1),
        ({"family": "TORUS", "p": 4, "q": 6}, "T(4,6)", 2),
        ({"family": "BRAID"}, "braid(1,-2,1,-2,1,-2)", 3),
        ({"family": "BRAID", "word": "1, 1 ,1"}, "braid(1,1,1)", 1),
        ({"family": "LISSAJOUS"}, "Lissajous(3,4,7)", 1),
        ({"family": "CABLE"}, "Cable(2,1) of 3_1", 1),
        ({"family": "CABLE", "companion": "figure-eight", "strands": 3, "turns": 3}, "Cable(3,3) of figure-eight", 3),
        ({"family": "DOUBLE", "companion": "4_1 Figure-Eight", "twists": 1}, "Double of 4_1", 1),
    ],
)
def test_families(options, name, components):
    assert bpy.ops.curve.mobius_flow_add_family(**options) == {"FINISHED"}
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
        {"family": "TORUS", "p": 0},
        {"family": "TORUS", "p": 101, "q": 2},
        {"family": "BRAID", "word": "1 x"},
        {"family": "LISSAJOUS", "frequency_x": 2, "frequency_y": 4},
        {"family": "LISSAJOUS", "phase_x": 0.0, "phase_y": 0.0},
        {"family": "CABLE", "companion": "nonsense"},
        {"family": "DOUBLE", "companion": "L2a1 Hopf Link"},
    ],
)
def test_what_meets_itself_or_is_none_is_refused(options):
    before = contents()
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_add_family(**options)
    assert len(sentence(error.value)) > 10
    assert contents() == before
