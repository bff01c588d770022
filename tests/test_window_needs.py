"""What is missing to test in a window is said in one sentence, before anything is downloaded."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

WINDOW = Path(__file__).resolve().parent / "window"
PLAIN = ("bash", "env", "awk", "dirname", "uniq", "tr", "sed")

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="for Debian")


@pytest.fixture
def needs(tmp_path):
    """Ask on a machine with some tools, so much room, and a network or none."""

    def ask(*tools, user=0, free=9000, network=True, tree=False):
        path = tmp_path / "bin"
        path.mkdir()
        for name in PLAIN:
            (path / name).symlink_to(shutil.which(name))
        says = {"id": f"echo {user}", "df": f"echo; echo / 1 1 {free}", "wget": f"exit {0 if network else 4}"}
        for name in ("id", "df", *tools):
            (path / name).write_text(f"#!{shutil.which('bash')}\n{says.get(name, '')}\n")
            (path / name).chmod(0o755)
        blender = tmp_path / "tree/usr/bin/blender"
        if tree:
            blender.parent.mkdir(parents=True)
            blender.write_text("")
            blender.chmod(0o755)
        command = [str(WINDOW / "needs"), str(tmp_path / "tree"), "sid"]
        done = subprocess.run(command, env={"PATH": str(path)}, capture_output=True, text=True, check=False)
        assert done.stdout == ""
        assert done.stderr.count("\n") == done.returncode
        return done.stderr

    return ask


SHOWN = ("Xvfb", "import", "compare")
ALL = (*SHOWN, "debootstrap", "wget")


def test_where_all_is_there_nothing_is_said(needs):
    assert needs(*ALL) == ""


def test_with_a_tree_neither_debootstrap_nor_a_network_is_wanted(needs):
    assert needs(*SHOWN, tree=True, free=700) == ""


def test_all_that_is_missing_stands_in_one_sentence(needs):
    said = needs("wget", user=1000, free=10, network=False)
    assert said.startswith(
        "tests/window/run lacks root, for chroot; tools (apt-get install xvfb imagemagick debootstrap)"
    )
    assert "room (2000 MB in" in said
    assert "where there are 10)" in said
    assert said.endswith("Release cannot be reached)\n")


def test_a_case_that_there_is_not():
    done = subprocess.run([str(WINDOW / "run"), "tutoriel"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr == "tests/window/run: there is no case tutoriel in tests/window/cases\n"
