"""What every test needs before it starts."""

import re
import signal
from importlib.util import find_spec
from pathlib import Path

import scipy.linalg  # noqa: F401 (a pool can be bounded once it is there)
import threadpoolctl
from hypothesis import HealthCheck, settings
from mobius_flow.core import proof as verification
from second_opinion import agreeing

verification.verify = agreeing(verification.verify)  # before the tests, and the command line, take it from there

# as `relax` does around its work: tests also call parts of it, and spinning threads would make them crawl
threadpoolctl.threadpool_limits(1, "blas")

# where Ctrl-C is ignored, as in a shell's background jobs, tests could not raise it; children would inherit that
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# the same examples every time, however slow the machine; --hypothesis-profile=explore looks for new ones
settings.register_profile("explore", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("same", settings.get_profile("explore"), derandomize=True)
settings.load_profile("same")

# curves of other people's, which are tested too where somebody has put them beside the project
collect_ignore = [] if Path(__file__).parents[2].joinpath("shared").is_dir() else ["core/knots/test_shared_inputs.py"]
collect_ignore.append("plugins")  # modules for a copy of the package, see test_plugins.py


def pytest_ignore_collect(collection_path):
    """Leave out what needs Blender's module where there is none."""
    if collection_path.suffix != ".py" or find_spec("bpy"):
        return None
    needed = re.search(r"^(import bpy|from blender_scenes)", collection_path.read_text(encoding="utf-8"), re.MULTILINE)
    return None if needed is None else True


def pytest_addoption(parser):
    """Long tests run when asked for."""
    parser.addoption("--slow", action="store_true", help="run the tests marked slow, too")


def pytest_collection_modifyitems(config, items):
    """Leave them out otherwise."""
    if not config.getoption("--slow"):
        slow = [item for item in items if item.get_closest_marker("slow")]
        config.hook.pytest_deselected(items=slow)
        items[:] = [item for item in items if not item.get_closest_marker("slow")]
