"""A fresh file for every test, with the add-on registered from the installed package."""

import pytest
from processes import PATIENCE

try:
    import bpy
except ImportError:
    bpy = None


@pytest.fixture(scope="session")
def addon():
    """The add-on, registered once; tests that unregister it register it again."""
    import mobius_flow

    bpy.ops.wm.read_factory_settings(use_empty=True)
    mobius_flow.register()
    yield mobius_flow
    mobius_flow.unregister()


@pytest.fixture(autouse=True)
def empty_file(request):
    """Start every test from an empty file; the preferences stay, which takes a fifth of the time.

    Keys are the flow's own iterates, a frame each, so that they can be compared with the library's. Those in between,
    which make longer motions smooth, and ropes take most of the time to prove: tests ask for them that are about them.
    """
    if bpy is not None:
        request.getfixturevalue("addon")
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        settings = bpy.context.scene.mobius_flow
        settings.keep_size, settings.timing, settings.radius = "LENGTH", "ITERATE", "none"


@pytest.fixture
def defaults(empty_file):
    """The timing and the ropes of a new scene."""
    settings = bpy.context.scene.mobius_flow
    settings.options = ""
    settings.property_unset("timing")


@pytest.fixture
def operator(request):
    """A double of the Relax operator; whatever a test did with it, no worker stays behind.

    The worker is a thread, which starts at once, or a process as in Blender if the fixture is given the parameter.
    """
    from mobius_flow.addon.live import registry
    from modal_operator import Operator

    double = Operator(vertices=120)
    double.in_process = getattr(request, "param", None) == "process"
    yield double
    if double.events is not None:
        double.run.cancel()
        thread = double.run._worker._thread
        if not double.in_process:
            thread.join(PATIENCE)  # at the end of its iteration
        assert not thread.is_alive()
    assert registry.current() is None
