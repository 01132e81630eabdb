"""How Sphinx makes the site; tools/docs.sh runs it on the pages that docs/site/stage.py has put together."""

import pathlib
import re
import sys
import textwrap

from docutils import nodes
from sphinx.directives.code import LiteralInclude

root = pathlib.Path(__file__).resolve().parent.parent
build = root / "build/docs"
sys.path.insert(0, str(root / "bindings/python"))

project = "twinray"
copyright = "the authors of twinray, MIT licence"
release = re.search(r"VERSION (\d+\.\d+\.\d+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
version = release
root_doc = "index"

extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 4

breathe_projects = {"twinray": str(build / "cpp/xml")}
breathe_default_project = "twinray"
breathe_show_include = False

# The package's Python is the reference; its extension module is not needed to read it.
autodoc_mock_imports = ["twinray._core", "dask"]
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # docstrings say more: shapes and dtypes
napoleon_google_docstring = False

smartquotes = False  # options begin with two hyphens

html_theme = "furo"
html_title = "twinray"
html_static_path = [str(root / "docs/site/static")]
html_js_files = ["site.js"]
html_show_sphinx = False
html_copy_source = False
html_show_search_summary = False  # it would be fetched, which a page without a server cannot
html_last_updated_fmt = None
pygments_style = "a11y-light"
pygments_dark_style = "a11y-dark"


class Region(LiteralInclude):
    """`{region} FILE NAME`: lines of a file in the folder of a tutorial, from the comment [NAME] to the next such
    comment, which is [/NAME] or begins another region, or to the end."""

    required_arguments = 2
    final_argument_whitespace = True

    def run(self):
        file, name = self.arguments
        languages = {".comp": "glsl", ".glsl": "glsl", ".py": "python", ".sh": "sh", ".txt": "cmake"}
        language = languages.get(pathlib.Path(file).suffix, "cpp")
        mark = "//" if language in ("cpp", "glsl") else "#"
        self.arguments = [f"../../samples/{self.env.docname}/{file}"]
        self.options |= {"language": language, "start-after": f"{mark} [{name}]"}
        [block] = super().run()
        block.rawsource = textwrap.dedent(re.split(rf"^ *{mark} \[", block.astext(), flags=re.M)[0]).rstrip()
        block[:] = [nodes.Text(block.rawsource)]
        return [block]


def setup(app):
    app.add_directive("region", Region)
