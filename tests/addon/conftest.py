"""A fresh file for every test, with the add-on registered from the installed package."""

import pytest

try:
    import bpy
except ImportError:
    bpy = None


@pytest.fixture(scope="session")
def addon():
    """The add-on, registered once; tests that unregister it register it again."""
    import mobius_flow

    mobius_flow.register()
    yield mobius_flow
    mobius_flow.unregister()


@pytest.fixture(autouse=True)
def empty_file(request):
    """Start every test from factory settings."""
    if bpy is not None:
        request.getfixturevalue("addon")
        bpy.ops.wm.read_factory_settings(use_empty=True)


@pytest.fixture
def operator():
    """A double of the Relax operator; whatever a test did with it, no worker stays behind."""
    from mobius_flow.addon.live import registry
    from modal_operator import Operator

    double = Operator(vertices=120)
    yield double
    if double.loop is not None:
        double.run.cancel()
        assert not double.run._worker._thread.is_alive()
    assert registry.current() is None
