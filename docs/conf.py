"""How the documentation is built: `make docs`."""

import logging
import sys
from pathlib import Path

import nullpose

DOCS = Path(__file__).parent
sys.path[:0] = [str(DOCS), str(DOCS / "_ext")]

project = "nullpose"
author = "The nullpose developers"
release = nullpose.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "docstrings",
    "offline_math",
    "tables",
    "twins_of_figures",
    "validation",
]
exclude_patterns = ["_build", "_ext"]

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 300  # seconds for a cell, compiling included
logging.getLogger("traitlets").setLevel(logging.WARNING)  # what the notebook's client is doing
html_math_renderer = "mathml"
math_eqref_format = "({number})"

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_type_aliases = {name: name for name in ("ArrayLike", "FloatArray", "IntArray", "PlainTable")}
python_use_unqualified_type_names = True
# Types of other packages have no pages here, and the build asks no network for theirs.
nitpick_ignore_regex = [
    (
        r"py:.*",
        r"(numpy|np|pydantic|typing|collections|matplotlib|rich|pandas|pd|xarray|xr|pyarrow|pa|pathlib|os|enum|abc)(\..*)?",
    ),
    (
        r"py:.*",
        r".*(ArrayLike|NDArray|FloatArray|IntArray|PlainTable|AnyAntenna|float64|Axes|Details|Path|PathLike|Callable|Sequence|Mapping|Iterable|_Called|_Numbers)",
    ),
]

html_theme = "furo"
html_title = "nullpose"
html_static_path = ["_static"]
html_favicon = "_static/logo.svg"
html_theme_options = {"light_logo": "logo.svg", "dark_logo": "logo-dark.svg"}
html_css_files = ["nullpose.css"]
html_copy_source = False
html_show_copyright = False
html_show_sourcelink = False
