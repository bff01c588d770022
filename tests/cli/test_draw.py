"""``mobius-flow draw`` from the terminal's point of view."""

import re

import numpy as np
import pytest
from mobius_flow.core import write_curve
from mobius_flow.core.knots import knot

TEXTS = re.compile(r"<tspan dy=\"0\"[^>]*>([^<]*)<")


@pytest.fixture
def drawn(room, run):
    def draw(*inputs, options=()):
        status, _, said = run("draw", *inputs, *options, "out.svg")  # options may stand anywhere
        assert status == 0, said
        return (room / "out.svg").read_text(encoding="utf-8")

    return draw


def test_curves_codes_names_and_ranges_on_one_sheet(drawn, room):
    (room / "code.pd").write_text("PD[X[1,5,2,4], X[3,1,4,6], X[5,3,6,2]]", encoding="utf-8")
    sheet = drawn("trefoil.txt", "code.pd", "DT: [4 6 2]", "hopf", "3_1..4_1", options=("--labels", "a,b,c,d,e,f"))
    assert sheet.count("<path") == 3 + 3 + 3 + 2 + 3 + 4
    assert TEXTS.findall(sheet) == list("abcdef")


def test_single_drawings_have_no_caption_unless_asked(drawn):
    assert "<text" not in drawn("4_1")
    assert "<text" not in drawn("3_1", "4_1", options=("--labels", "none"))
    assert ">3<" in drawn("3_1", "4_1")


def test_layouts_of_curves_are_simplified(drawn, room):
    write_curve("loops.txt", knot("braid(1,1,1,2,-3)"))
    assert drawn("loops.txt", options=("--layout",)).count("<path") == 3


def test_trajectories_are_rows_of_frames(drawn, room):
    curve = knot("3_1")
    frames = np.stack([scale * curve.vertices for scale in (1.0, 1.1, 1.2)])
    np.savez(room / "path.npz", stage_000=frames, component_sizes_000=[len(curve)])
    sheet = drawn("path.npz", options=("--frames", "3"))
    assert sheet.count("<path") == 9
    width, height = map(float, re.findall(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', sheet)[0])
    assert width > 2 * height


@pytest.mark.parametrize("suffix", [".svg", ".pdf", ".tex"])
def test_every_paper(room, run, suffix):
    status, _, said = run("draw", "4_1", f"out{suffix}", "--arrows", "--numbers", "--line", "dotted")
    assert (status, f"out{suffix}" in said) == (0, True)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("3_1", "out.png"), "out.png"),
        (("no-such", "out.svg"), "no knot is called"),
        (("../no-such", "out.svg"), "no knot is called '../no-such'"),
        (("missing.txt", "out.svg"), "missing.txt"),
        (("bad.pd", "out.svg"), "bad.pd"),
        (("PD[X[1,2,3,4]]", "out.svg"), "twice"),
        (("Gauss: 1 -2 -1 2", "out.svg"), "no planar diagram"),
        (("3_1", "out.svg", "--labels", "a,b"), "2 captions for 1 drawing"),
        (("3_1", "out.svg", "--size", "-1"), "size is -1"),
        (("4_1..3_1", "out.svg"), "comes before"),
        (("missing.npz", "out.svg", "--frames", "1"), "frames is 1"),
        (("missing.npz", "out.svg", "--layout"), "--layout is for curves"),
    ],
)
def test_bad_input_is_one_line(room, refused, words, said):
    (room / "bad.pd").write_text("PD[X[1,5,2,4]]", encoding="utf-8")
    assert said in refused("draw", *words)
    assert not (room / "out.svg").exists()
