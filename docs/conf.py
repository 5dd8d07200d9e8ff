"""Sphinx settings of the documentation site; `make docs` writes the generated pages first and checks the links last."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "_ext"), str(HERE.parent)]

from flockana import __version__  # noqa: E402
from tools.site.cache import CACHE, digest  # noqa: E402

project = "flockana"
author = copyright = "The flockana developers"  # Sphinx's name
version = release = __version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "numpydoc",
    "myst_nb",
    "sphinx-mathjax-offline",
    "plain_docstrings",
    "keyboard",
]
templates_path = ["_templates"]
exclude_patterns = ["_ext", "generated/lectures/own_law", "generated/extra", "generated/first.md"]
default_role = "py:obj"
suppress_warnings = ["misc.highlighting_failure", "toc.not_included", "mystnb.unknown_mime_type", "myst-nb.lexer"]

numpydoc_show_class_members = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # numpydoc sections say it in words

myst_enable_extensions = ["amsmath", "dollarmath", "deflist", "colon_fence", "attrs_block", "attrs_inline"]
myst_heading_anchors = 3
nb_execution_mode = "cache"
nb_execution_cache_path = str(CACHE / f"notebooks-{digest(('flockana', 'proofs', 'notebooks'))}")  # of this code
nb_execution_timeout = 600
nb_execution_raise_on_error = True
nb_merge_streams = True
nb_output_stderr = "remove"  # that kernels are compiled, once

html_theme = "pydata_sphinx_theme"
html_title = "flockana"
html_context = {"default_mode": "auto"}
html_static_path = ["_static"]
html_extra_path = ["generated/extra"]  # runs that play, and the report
html_css_files = ["flockana.css"]
html_js_files = ["print.js"]
html_search_scorer = str(HERE / "scorer.js")
html_favicon = "_static/icon.svg"
html_sidebars = {page: [] for page in ("index", "start", "generated/mathematics", "performance")}  # no pages below them
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "show_toc_level": 2,
    "navigation_with_keys": True,
    "header_links_before_dropdown": 4,
    "navbar_align": "left",
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
