"""How the site is built: python -m sphinx -W docs build/docs

Add -D plot_gallery=0 to leave the gallery's examples unexecuted.  Nothing is fetched, neither here nor by the pages,
but with -t online the lists of what other projects' documents have, to which names of theirs then lead.
"""

import re
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.ext.autodoc.mock import MockFinder, _MockObject

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "docs" / "_extensions"))

project = "Möbius Flow"
author = "The Möbius Flow authors"
copyright = f"2026 {author}"
release = version = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))["version"]

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "docstrings",
    "mathml",
]
if "online" in tags:  # type: ignore[name-defined]  # noqa: F821  # python -m sphinx -t online …
    extensions.append("sphinx.ext.intersphinx")
    intersphinx_mapping = {
        name: (f"https://{place}/", None)
        for name, place in {
            "python": "docs.python.org/3",
            "numpy": "numpy.org/doc/stable",
            "scipy": "docs.scipy.org/doc/scipy",
        }.items()
    }
exclude_patterns = ["_extensions"]
suppress_warnings = ["config.cache"]  # the gallery's settings hold objects

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
smartquotes = False

default_role = "py:obj"
add_module_names = False
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 100
python_use_unqualified_type_names = True
# Blender's modules are there where the extra "blender" is installed
_BLENDER = ["bl_operators", "bl_ui", "blf", "bpy", "bpy_extras", "gpu", "gpu_extras", "mathutils"]
# annotations such as bpy.types.Object | None are computed
_MockObject.__or__ = _MockObject.__ror__ = lambda one, other: one
autodoc_mock_imports = [] if find_spec("bpy") else _BLENDER
sys.meta_path.insert(0, MockFinder(autodoc_mock_imports))  # the gallery looks up what its scripts import, too
napoleon_google_docstring = False
napoleon_attr_annotations = False
napoleon_use_rtype = False

sphinx_gallery_conf = {
    "examples_dirs": ["../examples"],
    "gallery_dirs": ["gallery"],
    "filename_pattern": r"(?<!blender)\.py$" if autodoc_mock_imports else r"\.py$",  # what runs; the others are shown
    "ignore_pattern": r"drawing\.py$",
    "within_subsection_order": "FileNameSortKey",
    "remove_config_comments": True,
    "download_all_examples": False,
    "show_memory": False,
    "write_computation_times": False,
    "min_reported_time": 1e9,
    "matplotlib_animations": True,
    "abort_on_example_error": True,
}

html_theme = "furo"
html_title = "Möbius Flow"
html_static_path = ["_static"]
html_css_files = ["site.css"]
if (_SITE := ROOT / "build" / "site").is_dir():  # with the pages of mobius-flow atlas
    html_extra_path = [str(_SITE)]
    tags.add("atlas")  # type: ignore[name-defined]  # noqa: F821  # Sphinx's
html_copy_source = html_show_sourcelink = False
html_math_renderer = "mathml"


def link_to_gallery(_app: Sphinx, _page: str, source: list[str]) -> None:
    """Lead links to examples, which are for readers of the repository, to their pages."""
    source[0] = re.sub(r"\]\(\.\./examples/(\w+)\.py\)", r"](gallery/\1)", source[0])


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.connect("source-read", link_to_gallery)
