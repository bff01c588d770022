"""Folders of results: whole or not there."""

import json
import os
from concurrent.futures import ThreadPoolExecutor

import pytest
from mobius_flow.lab.batch.folder import new_folder, sweep, write_report
from mobius_flow.lab.batch.job import Job
from mobius_flow.lab.batch.table import Row


def fill(path, text):
    with new_folder(path) as room:
        write(room, text)


def write(room, text):
    job = Job(text, 1, None, None, None, "", {}, False)
    for name in ("curve.txt", "trajectory.npz"):
        (room / name).write_text(text)
    write_report(room, job, Row.failure(job, ""), {})


def contents(path):
    return [(path / "curve.txt").read_text(), json.loads((path / "report.json").read_text())["row"]["name"]]


def test_it_appears_whole(tmp_path):
    with new_folder(tmp_path / "a") as room:
        write(room, "new")
        assert not (tmp_path / "a").exists()
    assert contents(tmp_path / "a") == ["new", "new"]
    assert len(list(tmp_path.iterdir())) == 1


def test_a_failure_leaves_nothing(tmp_path):
    with pytest.raises(KeyboardInterrupt), new_folder(tmp_path / "a"):
        raise KeyboardInterrupt
    assert not list(tmp_path.iterdir())


def test_two_at_once_make_one(tmp_path):
    with ThreadPoolExecutor(2) as pool, new_folder(tmp_path / "a") as room:
        write(room, "late")
        pool.submit(fill, tmp_path / "a", "early").result()
    assert contents(tmp_path / "a") == ["late", "late"]
    assert len(list(tmp_path.iterdir())) == 1


def test_sweeping_leaves_what_another_batch_may_be_filling(tmp_path):
    fill(tmp_path / "a", "done")
    for name in ("other.partial", ".mobius-flow-x.partial", ".mobius-flow-y.partial"):
        (tmp_path / name).mkdir()
    blocks = [new_folder(tmp_path / name) for name in "bcd"]
    killed, visited, filled = (block.__enter__() for block in blocks)
    (tmp_path / ".mobius-flow-y.partial/note").write_bytes((killed / "note").read_bytes())  # a copy of a mark
    (killed / ".0123456789abcdef.npz").touch()
    (visited / "thesis.tex").touch()
    left = {*tmp_path.iterdir()} - {killed}
    for room in left - {filled} | {killed}:
        os.utime(room, (0, 0))
    sweep(tmp_path)
    assert {*tmp_path.iterdir()} == left
    assert [path.name for path in visited.iterdir()] == ["thesis.tex"]
