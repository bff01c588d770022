"""Folders of results: whole or not there."""

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from mobius_flow.cli.batch.folder import new_folder, sweep
from mobius_flow.core import MobiusFlowError


def fill(path: Path, text: str) -> None:
    with new_folder(path) as room:
        (room / "report.json").write_text(text)
        (room / "curve.txt").write_text(text)


def contents(path: Path) -> list[str]:
    return [(path / name).read_text() for name in ("curve.txt", "report.json")]


def test_it_appears_whole(tmp_path: Path) -> None:
    with new_folder(tmp_path / "a") as room:
        (room / "report.json").touch()
        assert not (tmp_path / "a").exists()
    assert (tmp_path / "a/report.json").is_file()
    assert len(list(tmp_path.iterdir())) == 1


def test_a_failure_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), new_folder(tmp_path / "a"):
        raise KeyboardInterrupt
    assert not list(tmp_path.iterdir())


def test_new_results_replace_old_ones(tmp_path: Path) -> None:
    fill(tmp_path / "a", "old")
    fill(tmp_path / "a", "new")
    assert contents(tmp_path / "a") == ["new", "new"]
    assert len(list(tmp_path.iterdir())) == 1


def test_what_is_no_result_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a/thesis.tex").touch()
    with pytest.raises(MobiusFlowError, match="holds no results"):
        fill(tmp_path / "a", "new")
    assert [path.name for path in tmp_path.rglob("*")] == ["a", "thesis.tex"]


def test_two_at_once_make_one(tmp_path: Path) -> None:
    with ThreadPoolExecutor(2) as pool, new_folder(tmp_path / "a") as room:
        (room / "report.json").write_text("late")
        (room / "curve.txt").write_text("late")
        pool.submit(fill, tmp_path / "a", "early").result()
    assert contents(tmp_path / "a") == ["late", "late"]
    assert len(list(tmp_path.iterdir())) == 1


def test_sweeping_leaves_what_another_batch_may_be_filling(tmp_path: Path) -> None:
    fill(tmp_path / "a", "done")
    (tmp_path / "other.partial").mkdir()
    blocks = [new_folder(tmp_path / name) for name in "bc"]
    killed, filled = (block.__enter__() for block in blocks)
    for room in (tmp_path / "a", tmp_path / "other.partial", killed):
        os.utime(room, (0, 0))
    sweep(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"a", "other.partial", filled.name}


def test_the_longest_names_have_results(tmp_path: Path) -> None:
    fill(tmp_path / ("n" * 255), "done")
    assert contents(tmp_path / ("n" * 255)) == ["done", "done"]
