"""Files that are no trajectories are refused, before memory is taken for what they claim."""

import io
import json
import struct
import zipfile
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core.verify import Verdict, verify
from shapes import regular_polygon


def npy(shape: tuple[int, ...], data: bytes, descr: str = "<f8", fortran: bool = False) -> bytes:
    header = repr({"descr": descr, "fortran_order": fortran, "shape": shape}).encode()
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + data


SIZES = npy((1,), struct.pack("<q", 4), "<i8")
SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]).tobytes()


def archive(path: Path, members: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w") as file:
        for name, data in members.items():
            file.writestr(name, data)
    return path


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
        (npy((1, 4, 3), SQUARE, "nonsense"), SIZES, "header that cannot be read"),
        (b"\x93NUMPY\x01\x00\xff\xff" + b"(" * 65535, SIZES, "too long"),
        (b"\x93NUMPY\x01\x00\xe7\x03" + b"(" * 999, SIZES, "header that cannot be read"),
        (b"\x93NUMPY\x03\x00", SIZES, "NumPy's format"),
        (b"", SIZES, "shorter"),
        (npy((1, 4, 3), SQUARE.replace(struct.pack("<d", 1.0), struct.pack("<d", np.nan), 1)), SIZES, "not finite"),
        (npy((1, 4, 3), SQUARE), npy((1,), struct.pack("<q", 5), "<i8"), "its components have 5"),
        (npy((1, 4, 3), SQUARE), npy((2,), struct.pack("<qq", 2, 2), "<i8"), "3 or more"),
        (npy((1, 4, 3), SQUARE), npy((2,), struct.pack("<qq", 8, -4), "<i8"), "3 or more"),
        (npy((1, 4, 3), SQUARE), npy((0,), b"", "<i8"), "whole numbers"),
        (npy((1, 4, 3), SQUARE), npy((10**15,), b"", "<i8"), "whole numbers"),
        (npy((1, 4, 3), SQUARE), npy((1,), struct.pack("<d", 4.0)), "whole numbers"),
    ],
)
def test_refuses_wrong_arrays(tmp_path: Path, stage: bytes, sizes: bytes, reason: str) -> None:
    verdict = verify(archive(tmp_path / "T.npz", {"stage_000.npy": stage, "component_sizes_000.npy": sizes}))
    assert not verdict.accepted
    assert reason in verdict.reason


def test_refuses_wrong_files(tmp_path: Path) -> None:
    good = {"stage_000.npy": npy((1, 4, 3), SQUARE), "component_sizes_000.npy": SIZES}
    assert verify(archive(tmp_path / "good.npz", good)).accepted
    gap = good | {"stage_002.npy": good["stage_000.npy"], "component_sizes_002.npy": SIZES}
    assert "numbered" in verify(archive(tmp_path / "gap.npz", gap)).reason
    assert "numbered" in verify(archive(tmp_path / "empty.npz", {})).reason
    del good["component_sizes_000.npy"]
    assert "component_sizes_000 is missing" in verify(archive(tmp_path / "sizes.npz", good)).reason
    assert "cannot be read" in verify(tmp_path / "none.npz").reason
    (tmp_path / "text.npz").write_text(json.dumps({"stage_000": []}))
    assert "cannot be read" in verify(tmp_path / "text.npz").reason


def test_damaged_files_never_crash_it(tmp_path: Path) -> None:
    buffer = io.BytesIO()
    frames = np.stack([regular_polygon(8).vertices * k for k in (1.0, 1.1, 1.3)])
    np.savez_compressed(buffer, stage_000=frames, component_sizes_000=np.array([8]))
    data, rng, path = bytearray(buffer.getvalue()), np.random.default_rng(9), tmp_path / "T.npz"
    for _ in range(150):
        broken = data.copy()
        for at in rng.integers(len(data), size=rng.integers(1, 4)):
            broken[at] = rng.integers(256)
        path.write_bytes(broken if rng.random() < 0.8 else broken[: rng.integers(len(data))])
        assert isinstance(verify(path), Verdict)
