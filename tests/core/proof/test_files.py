"""Files that are no trajectories are refused, before memory is taken for what they claim."""

import json
import struct
import tracemalloc
import zipfile
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core.proof import Verdict, verify
from shapes import regular_polygon
from trajectory_files import archive, checked, trajectory


def npy(shape, data, descr="<f8", fortran=False):
    return headed(repr({"descr": descr, "fortran_order": fortran, "shape": shape}), data)


def headed(header, data):
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + data


SIZES = npy((1,), struct.pack("<q", 4), "<i8")
SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]).tobytes()
FORGED = Path(__file__).parents[4] / "shared/audit"


def verdict(folder, stage, sizes=SIZES, packed=zipfile.ZIP_STORED, **more):
    """On a file of these arrays."""
    members = {"stage_000": stage, "component_sizes_000": sizes} | more
    return verify(archive(folder / "T.npz", {f"{name}.npy": data for name, data in members.items()}, packed))


@pytest.mark.parametrize(
    ("stage", "sizes", "reason"),
    [
        (npy((10**12, 4, 3), SQUARE), SIZES, "shorter than its header says"),
        (npy((1, 4, 3), SQUARE[:-1]), SIZES, "shorter"),
        (npy((1, 4, 3), SQUARE + b"x"), SIZES, "longer"),
        (npy((1, 10**9, 3), SQUARE), npy((1,), struct.pack("<q", 10**9), "<i8"), "more than this program takes"),
        (npy((1, 4, 10**12), SQUARE), SIZES, "dimension 2 or 3"),
        (npy((0, 4, 3), b""), SIZES, "frames there must be"),
        (npy((1, -4, -3), SQUARE), SIZES, "negative"),
        (npy((4, 3), SQUARE), SIZES, "must be (k, n, m)"),
        (npy((1, 4, 3), SQUARE, "|O"), SIZES, "of float64"),
        (npy((1, 4, 3), SQUARE, "<i8"), SIZES, "of float64"),
        (npy((10**9, 4, 3), SQUARE, fortran=True), SIZES, "Fortran"),
        (npy((2, 4, 3), SQUARE, fortran=True), SIZES, "shorter"),
        (npy((1, 4, 3), SQUARE + b"x", fortran=True), SIZES, "longer"),
        (npy((1, 4, 3), SQUARE, "nonsense"), SIZES, "of float64"),
        (b"\x93NUMPY\x01\x00\xff\xff" + b"(" * 65535, SIZES, "too long"),
        (b"\x93NUMPY\x01\x00\xe7\x03" + b"(" * 999, SIZES, "header that cannot be read"),
        (b"\x93NUMPY\x03\x00", SIZES, "NumPy's format"),
        (b"", SIZES, "shorter"),
        (npy((1, 4, 3), SQUARE.replace(struct.pack("<d", 1.0), struct.pack("<d", np.nan), 1)), SIZES, "not finite"),
        (npy((1, 4, 3), SQUARE), npy((1,), struct.pack("<q", 5), "<i8"), "its components have 5"),
        (npy((1, 4, 3), SQUARE), npy((2,), struct.pack("<qq", 2, 2), "<i8"), "3 or more"),
        (npy((1, 4, 3), SQUARE), npy((2,), struct.pack("<qq", 8, -4), "<i8"), "3 or more"),
        (npy((1, 4, 3), SQUARE), npy((0,), b"", "<i8"), "is empty"),
        (npy((1, 4, 3), SQUARE), npy((10**15,), b"", "<i8"), "more than this program takes"),
        (npy((1, 4, 3), SQUARE), npy((1,), struct.pack("<d", 4.0)), "whole numbers"),
    ],
)
def test_arrays(tmp_path, stage, sizes, reason):
    assert verdict(tmp_path, npy((1, 4, 3), SQUARE)).accepted
    assert reason in verdict(tmp_path, stage, sizes).reason


HEADERS = {
    "a shape of no whole numbers": "{'descr': '<f8', 'fortran_order': False, 'shape': (1e400, 4, 3)}",
    "a fraction": "{'descr': '<f8', 'fortran_order': False, 'shape': (1.9, 4, 3)}",
    "text": "{'descr': '<f8', 'fortran_order': False, 'shape': ('1', 4, 3)}",
    "a truth value": "{'descr': '<f8', 'fortran_order': False, 'shape': (True, 4, 3)}",
    "a list": "{'descr': '<f8', 'fortran_order': False, 'shape': [1, 4, 3]}",
    "no order": "{'descr': '<f8', 'shape': (1, 4, 3)}",
    "an order of its own": "{'descr': '<f8', 'fortran_order': 0, 'shape': (1, 4, 3)}",
    "letters of a type": "{'descr': ['<', 'f8'], 'fortran_order': False, 'shape': (1, 4, 3)}",
    "more than there is": "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 4, 3), 'x': 1}",
    "no dictionary": "['descr', 'fortran_order', 'shape']",
}


@pytest.mark.parametrize("header", HEADERS.values(), ids=HEADERS)
def test_headers_that_numpy_does_not_write(tmp_path, header):
    assert "stage_000 has a header that cannot be read" in verdict(tmp_path, headed(header, SQUARE)).reason


@pytest.mark.parametrize("descr", ["=f8", "f8", "|f8", "<d", ">f8", "<f4", "float64"])
def test_types_other_than_the_one_of_the_format(tmp_path, descr):
    assert "it must be (k, n, m) of float64" in verdict(tmp_path, npy((1, 4, 3), SQUARE, descr)).reason


@pytest.mark.parametrize("shape", [(3, 0), (10**12, 0), (-1, -3), (0, 0)])
def test_pins_in_no_space(tmp_path, shape):
    pins = npy(shape, SQUARE[: 24 * (shape[0] < 0)])
    assert "pins has " in verdict(tmp_path, npy((1, 4, 3), SQUARE), pins=pins).reason


def test_what_is_no_file_of_arrays(tmp_path):
    (tmp_path / "text.npz").write_text(json.dumps({"stage_000": []}))
    for path in (tmp_path, tmp_path / "none", tmp_path / "text.npz", "a\0b", ""):
        assert "cannot be read" in verify(path).reason
    (tmp_path / "pointer.npz").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n")
    assert "git lfs pull" in verify(tmp_path / "pointer.npz").reason
    assert "numbered" in verify(archive(tmp_path / "empty.npz", {})).reason


def test_fortran_order_is_the_same_trajectory(tmp_path):
    """As numpy.savez writes a transposed array; small whole numbers in it are read, too."""
    frames = np.stack([regular_polygon(8).vertices * k for k in (1.0, 1.1, 1.3)])
    obstacle = {"obstacle_000_vertices": 9.0 + np.eye(3), "obstacle_000_faces": np.array([[0, 1, 2], [2, 1, 0]])}
    turned = {name: np.asfortranarray(array) for name, array in obstacle.items()}
    turned["obstacle_000_faces"] = turned["obstacle_000_faces"].astype(np.uint8)
    for change in (1.0, -1.0):  # the second one moves half of the octagon through the rest
        frames[2, :4] *= change
        arrays = trajectory(frames, **obstacle)
        verdicts = [
            checked(tmp_path, each) for each in (arrays, arrays | turned | {"stage_000": np.asfortranarray(frames)})
        ]
        assert verdicts[0] == verdicts[1]
        assert verdicts[0].accepted == (change > 0)
    frames[1, 2, 0] = np.nan
    arrays["stage_000"] = np.asfortranarray(frames)
    assert "stage_000, frame 1: a coordinate is not finite" in checked(tmp_path, arrays).reason


@pytest.mark.parametrize("fortran", [False, True])
@pytest.mark.parametrize("claimed", [10**9, 2**62])
def test_claims_and_bombs_take_no_memory(tmp_path, fortran, claimed):
    """Claims of many frames or vertices, with 16 MB of zeros that compress to nothing."""
    zeros, vertices = bytes(1 << 24), struct.pack("<q", claimed)
    for shape, sizes in (((claimed, 4, 3), SIZES), ((1, claimed, 3), npy((1,), vertices, "<i8"))):
        stage = npy(shape, zeros, fortran=fortran)
        tracemalloc.start()
        base = tracemalloc.get_traced_memory()[0]
        found = verdict(tmp_path, stage, sizes, zipfile.ZIP_DEFLATED)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert not found.accepted
        assert peak - base < 1 << 23


@pytest.mark.parametrize("scale", [1e300, 1.5e308, 1e-300])
def test_numbers_near_the_end_of_the_range(tmp_path, scale):
    square = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    fine = np.stack([square, 0.5 * (square + np.roll(square, -1, axis=0))], axis=1).reshape(-1, 3)
    assert checked(tmp_path, trajectory([scale * square], [scale * fine, 0.5 * scale * fine])).accepted


def test_damaged_files_never_crash_it(tmp_path):
    frames = [regular_polygon(8).vertices * k for k in (1.0, 1.1, 1.3)]
    checked(tmp_path, trajectory(frames), np.savez_compressed)
    path, rng = tmp_path / "T.npz", np.random.default_rng(9)
    data = bytearray(path.read_bytes())
    for _ in range(150):
        broken = data.copy()
        for at in rng.integers(len(data), size=rng.integers(1, 4)):
            broken[at] = rng.integers(256)
        path.write_bytes(broken if rng.random() < 0.8 else broken[: rng.integers(len(data))])
        assert isinstance(verify(path), Verdict)


def test_edges_too_short_to_place_vertices_on(tmp_path):
    square = np.array([[0.0, 0, 0], [1e-320, 0, 0], [1, 1, 0], [0, 1, 0]])
    finer = np.insert(square, 1, [[0.5, 0.5, 0]], axis=0)
    assert not checked(tmp_path, trajectory([square], [finer])).accepted


def test_what_a_few_bytes_may_unpack_to(tmp_path):
    """Motions that stand still, of which a file of 80 kB has enough for an hour."""
    for count, said in ((10, ""), (1 << 18, "unpacks to more than 20 times its size; write it with numpy.savez")):
        found = verdict(tmp_path, npy((count, 4, 3), SQUARE * count), packed=zipfile.ZIP_DEFLATED)
        assert (tmp_path / "T.npz").stat().st_size < 100_000
        assert found.accepted == (not said)
        assert said in found.reason


@pytest.mark.parametrize("path", sorted(FORGED.glob("z*.npz")), ids=lambda path: path.stem)
def test_forgeries_of_an_audit(path):
    assert not verify(path).accepted
