"""How the documentation is built, from the top of the repository: `sphinx-build -W -c docs . site`.

The source folder is the repository itself, so that links between README, docs and benchmarks/results hold here and
where the repository is browsed alike. Nothing is downloaded.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy.typing
from docutils import nodes
from sphinx.addnodes import desc_signature
from sphinx.domains.python import PyObject

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE)]


class ArrayLike:
    """Shown by its name; what numpy's stands for fills three lines of every signature."""


class NDArray(Generic[TypeVar("T")]):
    """Likewise."""


numpy.typing.ArrayLike, numpy.typing.NDArray = ArrayLike, NDArray  # type: ignore[misc, assignment]

import geodesics.arrays  # noqa: E402

for word in ("Floats", "Integers", "Bools"):  # shown as these words, which the pages explain
    setattr(geodesics.arrays, word, type(word, (), {"__module__": "geodesics.arrays"}))

import docstrings  # noqa: E402
import generated  # noqa: E402
import live  # noqa: E402
import mathml  # noqa: E402

import gmds  # noqa: E402

GENERATED = {
    "docs/reference/command-line": generated.every_section,
    "docs/reference/errors": generated.every_code,
    "docs/reference/gmds": lambda: generated.summary_of("gmds"),
    "docs/reference/geodesics": lambda: generated.summary_of("geodesics"),
}

WIDE = ("benchmarks/results/", "docs/versions")

project = "gmds"
author = copyright = "the gmds developers"
release = version = gmds.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode", "sphinx_copybutton"]
root_doc = "docs/index"
include_patterns = [
    "README.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "docs/**.md",
    "benchmarks/results/*.md",
    "examples/**.md",
]
exclude_patterns = ["docs/paper/**"]
myst_heading_anchors = 3
myst_enable_extensions = ["dollarmath"]

html_theme = "furo"
html_title = f"gmds {release}"
html_extra_path = ["top"]  # index.html, which leads to docs/index.html
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False

default_role = "py:obj"
add_module_names = False
smartquotes = False
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": True}
autodoc_preserve_defaults = True
napoleon_google_docstring = False
napoleon_use_ivar = True  # attributes have entries of their own already
napoleon_use_rtype = False
maximum_signature_line_length = 96
python_use_unqualified_type_names = True


def complete(_app: Any, docname: str, source: list[str]) -> None:
    """What is generated comes below what the page says; pages of tables take the place of the list of headings."""
    if docname in GENERATED:
        source[0] += GENERATED[docname]()
    folder, _, page = docname.removeprefix("docs/reference/").partition("/")
    if folder == "command-line" and page:
        source[0] += generated.help_of(page)
    elif folder in ("gmds", "geodesics") and page:
        divided = generated.summary_of(f"{folder}/{page}", places=True)
        source[0] = source[0] + divided if divided else generated.with_summary(source[0])
    if docname.startswith(WIDE):
        source[0] = f"---\nhide-toc: true\n---\n{source[0]}"


def page_of_a_map(app: Any) -> None:
    """The page that docs/howto/looking.md holds in a frame."""
    if app.builder.format == "html":
        live.write_page(Path(app.outdir) / "docs" / "live" / "map.html")


def places_for_sources(app: Any, doctree: Any, docname: str) -> None:
    """Where pages of source lead back to: viewcode knows one name of each module, and pages may use another."""
    there = {name for node in doctree.findall(desc_signature) for name in node["ids"]}
    for _, _, used, module in filter(None, getattr(app.env, "_viewcode_modules", {}).values()):
        for node in doctree.findall(desc_signature):
            name, place = node.get("fullname"), f"{module}.{node.get('fullname')}"
            ours = str(node.get("module")).split(".")[0] == module.split(".")[0]
            if ours and used.get(name) == docname and place not in there:
                node["ids"].append(place)
                there.add(place)


def large_at_a_click(app: Any, doctree: Any, docname: str) -> None:
    """A picture leads to itself alone: what is written in it cannot be read at the width of a phone."""
    if app.builder.format != "html":
        return
    for image in list(doctree.findall(nodes.image)):
        if image["uri"] in app.env.images and not isinstance(image.parent, nodes.reference):
            place = "../" * docname.count("/") + f"{app.builder.imagedir}/{app.env.images[image['uri']][1]}"
            image.replace_self(nodes.reference("", "", image.deepcopy(), refuri=place, internal=True))


def setup(app: Any) -> None:
    app.connect("autodoc-process-docstring", docstrings.plain, priority=400)  # before napoleon, which has 500
    mathml.setup(app)
    for field in PyObject.doc_field_types:
        if field.name == "variable":
            field.label = "Attributes"  # as numpydoc heads them
    app.connect("source-read", complete)
    app.connect("doctree-resolved", places_for_sources)
    app.connect("doctree-resolved", large_at_a_click)
    app.connect("builder-inited", page_of_a_map)
