"""Tests of methods and moves are of the flow alone; what users get, a rope, is tested in some files and above."""

import pytest
from mobius_flow.core import RelaxOptions

AS_USERS_GET_IT = ("test_option.py", "test_rope.py", "test_tube.py", "test_untangling.py")


@pytest.fixture(autouse=True, scope="module")
def without_a_rope(request):
    """The default radius is none."""
    with pytest.MonkeyPatch.context() as patch:
        if request.path.name not in AS_USERS_GET_IT:
            patch.setitem(RelaxOptions.__init__.__kwdefaults__, "radius", "none")
        yield
