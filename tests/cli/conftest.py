"""What the tests of the command line have in common."""

import tempfile

import pytest


@pytest.fixture(autouse=True)
def scratch(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Results that are rescued, also by processes of their own, go where pytest clears them away."""
    place = str(tmp_path_factory.mktemp("scratch"))
    monkeypatch.setattr(tempfile, "tempdir", place)
    monkeypatch.setenv("TMPDIR", place)
