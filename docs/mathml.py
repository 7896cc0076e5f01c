"""Formulas are typeset when the site is built, as MathML, which browsers draw by themselves: no script, no network.

`:math:` and `.. math::` in docstrings; in pages also {math} of MyST. A command that does not exist is a warning, and so
fails the build. On a system without a font for mathematics formulas are plainer, not absent.
"""

from __future__ import annotations

import html
import re
from typing import Any

from docutils import nodes
from math_core import LatexError, LatexToMathML
from sphinx.util import logging

CONVERTER = LatexToMathML()
TERMINAL_COLOURS = re.compile(r"\x1b\[[\d;]*m")
log = logging.getLogger(__name__)


def setup(app: Any) -> None:
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    app.config.html_math_renderer = "mathml"


def _inline(writer: Any, node: nodes.math) -> None:
    writer.body.append(mathml(node, block=False))
    raise nodes.SkipNode


def _block(writer: Any, node: nodes.math_block) -> None:
    number = f'<span class="eqno">({node["number"]})</span>' if node.get("number") else ""
    writer.body.append(writer.starttag(node, "div", CLASS="math") + number + mathml(node, block=True) + "</div>\n")
    raise nodes.SkipNode


def mathml(node: nodes.Element, *, block: bool) -> str:
    """The formula of a node; where it has several lines they are aligned at &."""
    tex = node.astext()
    if block and r"\\" in tex and r"\begin" not in tex:
        tex = rf"\begin{{aligned}}{tex}\end{{aligned}}"
    try:
        return CONVERTER.convert_with_local_state(tex, displaystyle=block)
    except LatexError as error:
        log.warning("formula %r: %s", tex, TERMINAL_COLOURS.sub("", str(error)), location=node)
        return f"<code>{html.escape(tex)}</code>"
