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
TABLE = "| name | what it is |\n|---|---|\n"
NOTES = {
    "on a mesh": geodesics.check,
    "on a file": geodesics.io,
    "on a match": gmds.matching.notes,
    "on a transfer": gmds.appearance.keeping,
}


def every_section() -> str:
    """The sections of the command line, each with a link to its page and a table of its commands.

    A command's name is a place on this page, too: links made when all help stood here lead to its row.
    """
    top, text = click.Context(main, info_name="gmds"), ""
    for title, names in main.sections.items():
        page = f"command-line/{slug(title)}.md"
        text += f"\n## [{title}]({page})\n\n| command | what it does |\n|---|---|\n"
        for name in names:
            short = main.get_command(top, name).get_short_help_str(limit=WIDTH)
            text += f"| [`gmds {name}`]({page}#gmds-{name}){place(f'gmds-{name}')} | {_in_a_cell(short)} |\n"
    return text


def help_of(page: str) -> str:
    """The help of every command of the section that a page is called like, word for word."""
    title = next(title for title in main.sections if slug(title) == page)
    top, text = click.Context(main, info_name="gmds"), ""
    for name in main.sections[title]:
        context = click.Context(
            main.get_command(top, name), info_name=name, parent=top, terminal_width=WIDTH, max_content_width=WIDTH
        )
        text += f"\n## gmds {name}\n\n```text\n{click.unstyle(context.get_help())}\n```\n"
    return text


def slug(title: str) -> str:
    """A title as it is written in addresses."""
    return title.lower().replace(" ", "-")


def place(name: str) -> str:
    """Something to which a link can lead, within a line of Markdown."""
    return f'<span id="{name}"></span>'


def summary_of(page: str, *, places: bool = False) -> str:
    """The pages below one of the reference, each with a table of what is on it: a name, and its first sentence.

    With `places`, links to a name on this page lead to its row, as where all stood here before it was divided.
    """
    text = ""
    for below in pages_below(page):
        source = source_of(f"{Path(page).parent}/{below}")
        rows = [table_of(part, places=places) for part in (source, *parts_of(f"{Path(page).parent}/{below}"))]
        title = source.splitlines()[0].removeprefix("# ")
        here = places_without_rows(source) if places else ""
        text += f"\n## [{title}]({below}.md)\n\n{here}\n\n{TABLE}{''.join(rows)}"
    return text


def places_without_rows(source: str) -> str:
    """Where links lead to the modules of a page, and to what in them is neither a function nor a class."""
    text = ""
    for name in re.findall(r"^\.\. automodule:: (\S+)", source, re.MULTILINE):
        module = importlib.import_module(name)
        others = [member for member in module.__all__ if not callable(getattr(module, member))]
        text += place(f"module-{name}") + "".join(place(f"{name}.{member}") for member in others)
    return text


def source_of(page: str) -> str:
    return (Path(__file__).parent / "reference" / f"{page}.md").read_text(encoding="utf-8")


def pages_below(page: str) -> list[str]:
    """The pages that one of the reference lists, as it names them; none for a page of names."""
    return re.findall(rf"^{Path(page).name}/[\w-]+$", source_of(page), re.MULTILINE)


def parts_of(page: str) -> list[str]:
    """The sources of the pages below a page."""
    return [source_of(f"{Path(page).parent}/{below}") for below in pages_below(page)]


def with_summary(source: str) -> str:
    """A page of the reference, with the table of what is on it below its heading; none where that is one thing."""
    heading, _, rest = source.partition("\n")
    rows = table_of(source)
    return f"{heading}\n\n{TABLE}{rows}\n{rest}" if rows.count("\n") > 1 else source


def table_of(source: str, *, places: bool = False) -> str:
    """What is documented on a page, a row each: a name, and its first sentence."""
    text = ""
    for role, name in documented(source):
        thing = pkgutil.resolve_name(name)
        first = re.sub(r"\s+", " ", (thing.__doc__ or "").split("\n\n")[0])
        members = [*vars(thing), *getattr(thing, "__annotations__", ())] if role == "class" else []
        public = [f"{name}.{member}" for member in dict.fromkeys(members) if not member.startswith("_")]
        here = "".join(map(place, (name, *public))) if places else ""
        text += f"| {{py:{role}}}`{name}`{here} | {_in_a_cell(first)} |\n"
    return text


def documented(source: str) -> Iterator[tuple[str, str]]:
    """Every name that a page documents, with the role that refers to it; of a module whose members it shows, these."""
    directive = re.compile(r"^\.\. auto(function|class|module):: ([\w.]+)\n( +:imported-members:)?", re.MULTILINE)
    for kind, name, members in directive.findall(source):
        if not members:
            yield {"function": "func", "module": "mod"}.get(kind, kind), name
            continue
        module = importlib.import_module(name)
        for member in module.__all__:
            if inspect.isroutine(thing := getattr(module, member)) or inspect.isclass(thing):
                yield "class" if inspect.isclass(thing) else "func", f"{name}.{member}"


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
