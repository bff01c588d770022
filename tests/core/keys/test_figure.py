"""Figures of diagrams: gaps that nothing touches, the views that are best to see, and files that others read."""

import re
import zlib
from xml.etree import ElementTree

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, OptionError
from mobius_flow.core.keys.arcs import seen, widest
from mobius_flow.core.keys.figure import INKS, Pen, figure
from mobius_flow.core.keys.paper import PAPERS
from mobius_flow.core.knots import KNOTS, knot, smooth_knot
from mobius_flow.core.knots.drawings import Drawing
from mobius_flow.core.knots.layout import laid_out
from mobius_flow.core.knots.names import named_diagram
from scipy.spatial import cKDTree


def along(stroke, count=6):
    """Points on the Bézier curves of a stroke."""
    p, t = stroke.controls, np.linspace(0.0, 1.0, count)[None, :, None]
    a, b, c, d = (p[k : len(p) - 3 + k : 3, None] for k in range(4))
    return ((1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d).reshape(-1, 2)


def least_gap(sheet):
    """The least space between strokes, which have round ends, in widths."""
    points = [along(stroke) for stroke in sheet.strokes]
    gaps = [np.inf]
    for k, stroke in enumerate(sheet.strokes):
        others = [each for i, each in enumerate(points) if i != k]
        if others:
            gaps.append(cKDTree(np.concatenate(others)).query(points[k])[0].min() / stroke.width - 1.0)
    return min(gaps)


NAMES = ("3_1", "6_3", "9_40", "10_1", "L6a4", "L7n1", "goeritz")


@pytest.mark.parametrize(
    "name", [*NAMES, *(pytest.param(name, marks=pytest.mark.slow) for name in KNOTS if name not in ("0_1", *NAMES))]
)
def test_nothing_touches_at_gaps(name):
    diagram = named_diagram(name)
    sheet = figure([laid_out(diagram)], pen=Pen(size=60.0, width=1.3))
    assert len(sheet.strokes) == diagram.crossings
    assert least_gap(sheet) > 0.7 * Pen().gap
    points = np.concatenate([along(stroke) for stroke in sheet.strokes])
    assert points.min() > 0.0
    assert (points < sheet.size).all()
    assert min(stroke.width for stroke in sheet.strokes) > 0.5


@pytest.mark.kernels
def test_views_are_those_of_fewest_crossings_with_room_between():
    for curve, crossings in ((knot("overhand"), 3), (smooth_knot("4_1"), 4), (knot("hopf"), 2)):
        (drawing,) = seen([curve])
        assert len(drawing.passes) == crossings
        sheet = figure([drawing])
        assert least_gap(sheet) > 0.7 * Pen().gap
        assert all(stroke.width == Pen().width for stroke in sheet.strokes)


def test_frames_that_one_view_does_not_serve_have_their_own():
    t = 2.0 * np.pi * np.arange(24) / 24
    lying = np.column_stack([np.cos(t), np.sin(t), 0.0 * t])
    rings = Curve.from_components([lying, 0.96 * lying])  # which have room between them as seen from above alone
    stood = rings.with_vertices(rings.vertices[:, [0, 2, 1]])
    for drawing in seen([rings, stood], trials=19):
        size = float(np.ptp(drawing.curve.vertices, axis=0).max())
        assert widest(drawing, 0.021 * size, 1.5)[0] > 0.3 * 0.021 * size


def test_upper_strands_are_never_cut_away():
    """Two strands that twist by half a turn, so slim that gaps of wide ones would reach over both crossings."""
    t = 2.0 * np.pi * np.arange(240) / 240
    x, y = np.cos(t), np.sin(t)
    drawing = Drawing.seen(Curve(np.column_stack([x, y * (x * x - 0.05), x * y])))
    arcs = widest(drawing, 0.2, 1.5)[1]
    upper = np.rint(np.where(drawing.first_over, *drawing.passes.T)).astype(int)
    assert (len(upper), len(arcs)) == (2, 2)
    assert cKDTree(np.concatenate([arc.points for arc in arcs])).query(drawing.curve.vertices[upper])[0].max() < 1e-9


def test_colours_arrows_and_numbers():
    link = laid_out(named_diagram("L6a4"))
    sheet = figure([link], ["L6a4"], Pen(arrows=True, numbers=True))
    assert {stroke.colour for stroke in sheet.strokes} == {head.colour for head in sheet.heads} == set(INKS[:3])
    assert [label.text for label in sheet.labels] == [*"123456", "L6a4"]
    ink = cKDTree(np.concatenate([along(stroke) for stroke in sheet.strokes]))
    assert min(ink.query(label.place)[0] for label in sheet.labels) > 2.5
    assert {stroke.colour for stroke in figure([link], pen=Pen(colours="black")).strokes} == {INKS[0]}
    assert len({stroke.colour for stroke in figure([link], pen=Pen(colours="along")).strokes}) > 40


def ellipses(*axes):
    angle = 2.0 * np.pi * np.arange(200) / 200
    return Curve.from_components(
        [np.column_stack([a * np.cos(angle), b * np.sin(angle), c * np.sin(2 * angle)]) for a, b, c in axes]
    )


@pytest.mark.parametrize("axes", [((1.0, 0.5, 0.1), (0.9, 0.55, -0.1)), ((1.0, 1.0, 0.0), (0.96, 0.96, 0.0))])
def test_strands_that_cross_at_small_angles_or_run_side_by_side(axes):
    sheet = figure([Drawing.seen(ellipses(*axes))])
    assert sheet.strokes[0].width < Pen().width
    assert least_gap(sheet) > 0.7 * Pen().gap


SHEET = figure(
    [laid_out(named_diagram(name)) for name in ("3_1", "L2a1")],
    ["3_1#m3_1 ⊔ <&>", "50 % $x^2_1"],
    Pen(arrows=True, numbers=True, line="dashed", colours="along"),
)


def test_svg_is_well_formed():
    tree = ElementTree.fromstring(PAPERS[".svg"](SHEET))
    paths = [each for each in tree.iter() if each.tag.endswith("path")]
    assert len(paths) == len(SHEET.strokes) + len(SHEET.heads)
    texts = ["".join(each.itertext()) for each in tree.iter() if each.tag.endswith("text")]
    assert texts == ["1", "2", "3", "31#m31 ⊔ <&>", "1", "2", "50 % $x^21"]


def test_pdf_has_its_objects_where_it_says():
    made = PAPERS[".pdf"](SHEET)
    start = int(re.search(rb"startxref\n(\d+)\n%%EOF", made)[1])
    places = [int(line[:10]) for line in made[start:].split(b"\n")[3:] if line.endswith(b"n ")]
    assert [made[place:].split(b" ")[0] for place in places] == [b"1", b"2", b"3", b"4"]
    length = int(re.search(rb"/Length (\d+)", made)[1])
    content = zlib.decompress(made[made.index(b"stream\n") + 7 :][:length]).decode()
    assert content.count("\nS\n") == len(SHEET.strokes)
    assert content.count("BT ") == len(SHEET.labels)


def test_signs_that_fonts_of_texts_lack_are_set_as_mathematics():
    assert rb"m3$_{1}$ $\sqcup$ $<$\char`\&{}$>$" in PAPERS[".tex"](SHEET)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"size": -1.0}, "size is -1.0"),
        ({"width": float("nan")}, "width is nan"),
        ({"width": 1e-9}, "width is 1e-09"),
        ({"colours": "red"}, "colours is 'red'"),
        ({"line": "wavy"}, "line 'wavy' is unknown"),
        ({"arrows": 1}, "arrows is 1"),
        ({"columns": 0}, "columns is 0"),
    ],
)
def test_bad_pens(fields, said):
    with pytest.raises(OptionError, match=said):
        Pen(**fields)


def test_what_cannot_be_drawn():
    with pytest.raises(CurveError, match="nothing to draw"):
        figure([])
    with pytest.raises(CurveError, match="has dimension 4"):
        seen([Curve(np.eye(5)[:, :4])])
    with pytest.raises(CurveError, match="too near to each other"):
        figure([laid_out(named_diagram("10_1"))], pen=Pen(gap=100.0))
