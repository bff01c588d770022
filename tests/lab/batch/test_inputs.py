"""Words of the command line, and the runs they stand for."""

import os
from dataclasses import replace
from pathlib import Path

import pytest
from mobius_flow.core import MobiusFlowError, RelaxOptions
from mobius_flow.lab.batch.job import Input, inputs, jobs

STILL = {"avoid": [], "pins": [], "pin_tangents": False}


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("b.txt", "a.obj", "notes.md", "more/c.txt", "empty/notes.md"):
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text("0 0 0\n")


def names(*words):
    return [each.name for each in inputs(words)]


def test_files_directories_and_patterns():
    assert names("b.txt") == ["b"]
    assert names(".") == ["a", "b"]
    assert names("more", "*.obj") == ["c", "a"]
    assert names("**/*.txt") == ["b", "c"]
    assert inputs(["b.txt"]) == [Input("b", Path("b.txt").absolute())]


@pytest.mark.parametrize(
    ("file", "name"), [("..txt", "..txt"), ("...txt", "...txt"), (b"n\xff.txt", "n\\xff"), ("a b ü.txt", "a b ü")]
)
def test_any_file_has_a_name_for_its_results(file, name):
    try:
        Path(os.fsdecode(file)).write_text("0 0 0\n")
    except OSError:
        pytest.skip("the file system has no such names")
    assert names(os.fsdecode(file)) == [name]


def test_knots_and_ranges_in_the_table_s_order():
    assert names("3_1..6_1") == ["3_1", "4_1", "5_1", "5_2", "6_1"]
    assert names("8_21..9_2") == ["8_21", "9_1", "9_2"]
    assert names("trefoil..4_1") == ["3_1", "4_1"]
    assert names("T(3,5)", "goeritz", "3_1#m3_1", "hopf") == ["T(3,5)", "goeritz", "3_1#m3_1", "hopf"]


def test_nothing_comes_twice():
    assert names("a.obj", ".", "*.txt", "3_1", "3_1..4_1") == ["a", "b", "3_1", "4_1"]


def test_a_file_comes_before_a_knot():
    Path("3_1").write_text("0 0 0\n")
    assert inputs(["3_1"])[0].file is not None


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("none.txt", "none.txt: there is no such file"),
        ("no/file", "there is no such file"),
        ("*.vect", "matches no file"),
        ("empty", "holds no curve files"),
        ("3_l", "did you mean 3_1"),
        ("4_1..3_1", "3_1 comes before 4_1 in the table"),
        ("3_1..m4_1", "no mirror images"),
        ("3_1..T(2,9)", "none of the table"),
        ("..", "holds no curve files"),
        ("DT:", "a code cannot name a folder"),
        ("DT: [4 6 2]", "a code cannot name a folder; put it in a .pd"),
        ("[[1,5,2,4],[3,1,4,6],[5,3,6,2]]", "a code cannot name a folder; put it in a .pd"),
        ("[4, 6, 2]", "a code cannot name a folder"),
        ("Gauss: O1+U2+ / U1+O2+", "a code cannot name a folder"),
        ("PD[X[1,5,2,4], X[3,1,4,6], X[5,3,6,2]]", "a code cannot name a folder"),
    ],
)
def test_words_that_name_nothing(word, told, tmp_path, monkeypatch):
    (tmp_path / "empty/empty").mkdir()
    if word == "..":
        monkeypatch.chdir(tmp_path / "empty/empty")
    with pytest.raises(MobiusFlowError, match=told):
        inputs([word])


def test_starts_have_folders_and_seeds(tmp_path):
    plan = jobs(inputs(["3_1", "b.txt"]), 3, tmp_path, RelaxOptions(seed=10), STILL, False)
    made = list(plan)
    assert len(plan) == len(made)
    assert [(job.start, job.seed) for job in made] == [(1, None)] * 2 + [(2, 12)] * 2 + [(3, 13)] * 2
    assert [os.path.basename(job.folder) for job in made] == ["3_1", "b", "3_1-2", "b-2", "3_1-3", "b-3"]
    assert all(job.sha256 is None for job in made[::2])
    assert len({job.sha256 for job in made[1::2]}) == 1


def test_a_billion_starts_are_planned_when_their_turn_comes(tmp_path):
    plan = jobs(inputs(["3_1", "b.txt"]), 999_999_999, tmp_path, RelaxOptions(seed=10), STILL, False)
    assert len(plan) == 1_999_999_998
    assert next(iter(plan)).name == "3_1"
    for folder in ("b-777777777", "b-0777777778", "b-1000000000", "b-1", "b-0", "c-2", "3_1"):
        (tmp_path / "out" / folder).mkdir(parents=True)
    standing = sorted(replace(plan, directory=tmp_path / "out").standing(), key=lambda job: job.start)
    assert [(job.name, job.start, job.seed) for job in standing] == [("3_1", 1, None), ("b", 777_777_777, 777_777_787)]


@pytest.mark.parametrize("other", ["more/b.txt", "B.obj", "results.csv.txt", "b-2.txt"])
def test_results_do_not_share_a_folder(other, tmp_path):
    Path(other).write_text("0 0 0\n")
    with pytest.raises(MobiusFlowError, match="rename it"):
        jobs(inputs(["b.txt", other]), 2, tmp_path, RelaxOptions(), STILL, False)
