"""What the reference takes from the program itself: the help of its commands, the codes of its errors."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Iterator

import click

import geodesics.check
import geodesics.io
import gmds.appearance.keeping
import gmds.matching.notes
from gmds.cli import main

WIDTH = 100
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
