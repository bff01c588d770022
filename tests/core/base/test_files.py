"""atomic_write: the whole new file or the whole old one."""

import os
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core.base.errors import CurveFileError
from mobius_flow.core.base.files import atomic_write
from mobius_flow.core.curve import Curve
from mobius_flow.core.io import read_curve, write_curve


def _interrupted_write(path):
    path.write_text("half")
    raise KeyboardInterrupt


def test_an_exception_keeps_the_old_file_and_leaves_nothing_else(tmp_path):
    target = tmp_path / "a.txt"
    target.write_text("old")
    with pytest.raises(KeyboardInterrupt), atomic_write(target) as temporary:
        _interrupted_write(temporary)
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_binary_files_and_suffix(tmp_path):
    target = tmp_path / "a.npz"
    with atomic_write(target) as temporary:
        assert temporary.suffix == ".npz"
        np.savez(temporary, x=np.arange(3))
    with np.load(target) as archive:
        assert archive["x"].tolist() == [0, 1, 2]


def test_rights_are_kept_and_defaults_follow_the_umask(tmp_path):
    target = tmp_path / "a.txt"
    plain = tmp_path / "plain.txt"
    plain.write_text("")
    with atomic_write(target) as temporary:
        temporary.write_text("1")
    assert target.stat().st_mode == plain.stat().st_mode
    target.chmod(0o640)
    with atomic_write(target) as temporary:
        temporary.write_text("2")
    assert target.stat().st_mode & 0o777 == 0o640


def test_links_are_followed(tmp_path):
    target, link = tmp_path / "a.txt", tmp_path / "link.txt"
    target.write_text("old")
    link.symlink_to(target)
    with atomic_write(link) as temporary:
        temporary.write_text("new")
    assert link.is_symlink()
    assert target.read_text() == "new"


def test_devices_are_written_to_directly():
    with atomic_write(os.devnull) as temporary:
        temporary.write_text("gone")
    assert not Path(os.devnull).is_file()


@pytest.mark.parametrize("name", ["directory.txt", "missing/curve.txt", "a\0b.txt", "x" * 300 + ".txt"])
def test_targets_that_cannot_be_written_give_one_sentence(tmp_path, name):
    (tmp_path / "directory.txt").mkdir()
    with pytest.raises(CurveFileError, match=r"cannot be written|is a directory") as caught:
        write_curve(tmp_path / name, Curve(np.eye(3)))
    assert "\n" not in str(caught.value)


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write everywhere")
def test_write_protected_file_is_not_replaced(tmp_path):
    target = tmp_path / "curve.txt"
    write_curve(target, Curve(np.eye(3)))
    target.chmod(0o444)
    with pytest.raises(CurveFileError, match="write-protected"):
        write_curve(target, Curve(2 * np.eye(3)))
    assert read_curve(target).vertices[0, 0] == 1


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_full_disk_gives_one_sentence(tmp_path):
    target = tmp_path / "curve.txt"
    target.symlink_to("/dev/full")
    with pytest.raises(CurveFileError, match="cannot be written: No space left"):
        write_curve(target, Curve(np.eye(3)))


@pytest.mark.skipif(os.name != "posix", reason="named pipes")
def test_a_pipe_gets_the_whole_contents_at_the_end(tmp_path):
    pipe = tmp_path / "pipe.txt"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    with atomic_write(pipe) as temporary:
        temporary.write_text("all of it")
        assert temporary.suffix == ".txt"
        assert temporary.is_file()
    assert os.read(reader, 100) == b"all of it"
    os.close(reader)
    assert list(tmp_path.iterdir()) == [pipe]
