"""How the documentation is built, from the top of the repository: `sphinx-build -W -c docs . site`.

The source folder is the repository itself, so that links between README, docs and benchmarks/results hold here and
where the repository is browsed alike. Nothing is downloaded.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy.typing

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))


class ArrayLike:
    """Shown by its name; what numpy's stands for fills three lines of every signature."""


class NDArray(Generic[TypeVar("T")]):
    """Likewise."""


numpy.typing.ArrayLike, numpy.typing.NDArray = ArrayLike, NDArray  # type: ignore[misc, assignment]

import click  # noqa: E402

import gmds  # noqa: E402
from gmds.cli import main  # noqa: E402

project = "gmds"
author = copyright = "the gmds developers"
release = version = gmds.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton"]
root_doc = "docs/index"
include_patterns = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/**.md", "benchmarks/results/*.md"]
exclude_patterns = ["docs/paper/**"]
myst_heading_anchors = 3

html_theme = "furo"
html_title = f"gmds {release}"
html_extra_path = ["top"]  # index.html, which leads to docs/index.html
html_copy_source = False
html_show_sphinx = False

default_role = "py:obj"
add_module_names = False
smartquotes = False
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": True}
autodoc_preserve_defaults = True
maximum_signature_line_length = 96
python_use_unqualified_type_names = True


def plain_docstrings(_app: Any, _what: str, _name: str, _thing: Any, _options: Any, lines: list[str]) -> None:
    """Docstrings are plain text with `names` and formulas; what reStructuredText would take for markup is escaped."""
    for number, line in enumerate(lines):
        parts = re.split(r"(`[^`]*`)", line)
        parts[::2] = [re.sub(r"[*|]|_(?!\w)", r"\\\g<0>", part) for part in parts[::2]]
        lines[number] = "".join(parts)


def every_command(_app: Any, docname: str, source: list[str]) -> None:
    """The help of every command, word for word, below what docs/reference/command-line.md says."""
    if docname != "docs/reference/command-line":
        return
    top = click.Context(main, info_name="gmds", max_content_width=100, terminal_width=100)
    for title, names in main.sections.items():
        source[0] += f"\n## {title}\n"
        for name in names:
            command = main.get_command(top, name)
            context = click.Context(command, info_name=name, parent=top, max_content_width=100, terminal_width=100)
            source[0] += f"\n### gmds {name}\n\n```text\n{click.unstyle(context.get_help())}\n```\n"


def setup(app: Any) -> None:
    app.connect("autodoc-process-docstring", plain_docstrings)
    app.connect("source-read", every_command)
