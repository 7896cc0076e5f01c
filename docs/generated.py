"""What the reference takes from the program itself: the help of its commands, the codes of its errors."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterator
from pathlib import Path

import click

import geodesics.check
import geodesics.io
import gmds.appearance.keeping
import gmds.matching.notes
from gmds.cli import main

WIDTH = 86
HEAD_LINES = 2  # of a table
NOTES = {
    "on a mesh": geodesics.check,
    "on a file": geodesics.io,
    "on a match": gmds.matching.notes,
    "on a transfer": gmds.appearance.keeping,
}


def every_command() -> str:
    """The help of every command, word for word."""
    top, text = click.Context(main, info_name="gmds"), ""
    for title, names in main.sections.items():
        text += f"\n## {title}\n"
        for name in names:
            context = click.Context(
                main.get_command(top, name), info_name=name, parent=top, terminal_width=WIDTH, max_content_width=WIDTH
            )
            text += f"\n### gmds {name}\n\n```text\n{click.unstyle(context.get_help())}\n```\n"
    return text


def summary_of(package: str) -> str:
    """The pages of a package's reference, each with a table of what is on it: a name, and its first sentence."""
    here, text = Path(__file__).parent / "reference", ""
    pages = re.findall(rf"^{package}/([\w-]+)$", (here / f"{package}.md").read_text(encoding="utf-8"), re.MULTILINE)
    for page in pages:
        source = (here / package / f"{page}.md").read_text(encoding="utf-8")
        title = source.splitlines()[0].removeprefix("# ")
        text += f"\n## [{title}]({package}/{page}.md)\n\n{table_of(source)}"
    return text


def with_summary(source: str) -> str:
    """A page of the reference, with the table of what is on it below its heading; none where that is one thing."""
    heading, _, rest = source.partition("\n")
    table = table_of(source)
    return f"{heading}\n\n{table}\n{rest}" if table.count("\n") > HEAD_LINES + 1 else source


def table_of(source: str) -> str:
    """What is documented on a page: a name, and its first sentence."""
    text = "| name | what it is |\n|---|---|\n"
    for kind, name in re.findall(r"^\.\. auto(function|class|module):: ([\w.]+)$", source, re.MULTILINE):
        role = {"function": "func", "class": "class", "module": "mod"}[kind]
        first = re.sub(r"\s+", " ", (pkgutil.resolve_name(name).__doc__ or "").split("\n\n")[0])
        text += f"| {{py:{role}}}`{name}` | {_in_a_cell(first)} |\n"
    return text


def _in_a_cell(sentence: str) -> str:
    """A sentence of a docstring in a table of Markdown: formulas stay formulas, other roles are names."""
    parts = re.split(r":math:`([^`]*)`", sentence)
    parts[::2] = [re.sub(r":\w+:`([^`]*)`", r"`\1`", text).replace("*", "\\*") for text in parts[::2]]
    parts[1::2] = [f"{{math}}`{formula}`" for formula in parts[1::2]]
    return "".join(parts).replace("|", "\\|")


def error_codes() -> Iterator[tuple[str, type[Exception]]]:
    """Every class of error that has a code, with that code."""
    for package in (geodesics, gmds):
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if found.name.endswith("__main__"):
                continue
            module = importlib.import_module(found.name)
            for _, kind in inspect.getmembers(module, inspect.isclass):
                if kind.__module__ == found.name and issubclass(kind, Exception) and "code" in vars(kind):
                    yield kind.code, kind


def every_code() -> str:
    """A table of the errors, and those of the notes."""
    errors = [
        f"| {code} | `{kind.__module__.partition('.')[0]}` | `{kind.__name__}` | {_sentence(kind)} |"
        for code, kind in sorted(error_codes(), key=lambda row: row[0])
    ]
    text = ["", "## Errors", "", "| code | package | class | when |", "|---|---|---|---|", *errors]
    for title, module in NOTES.items():
        text += ["", f"## Notes {title}", "", *(line for line in _doc(module).splitlines() if line.startswith("|"))]
    return "\n".join([*text, ""])


def _doc(thing: object) -> str:
    return inspect.getdoc(thing) or ""


def _sentence(kind: type[Exception]) -> str:
    return " ".join(_doc(kind).split("\n\n")[0].split())
