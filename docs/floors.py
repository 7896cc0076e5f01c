"""docs/floors.svg, and the table of rooms in docs/architecture.md, from the code; a test compares.

    python docs/floors.py         # writes both anew

Floors are those of the import-linter contract of that name in pyproject.toml; what a room is for is the first paragraph
of its docstring; what it uses are its imports, without those that follow from others.
"""

from __future__ import annotations

import ast
import functools
import html
import re
import textwrap
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PICTURE = ROOT / "docs" / "floors.svg"
PAGE = ROOT / "docs" / "architecture.md"
TABLE = re.compile(r"(<!-- rooms: begin -->\n).*?(<!-- rooms: end -->)", re.DOTALL)
HIDDEN = {"gmds", "gmds.__main__", "gmds._version", "gmds.moved_paths"}  # the public names; what is no room
GROUND = "geodesics"
LOWEST = "gmds.errors"  # on its floor stand the rooms that the contract does not name

WIDTH, GAP, LINE, COLUMNS = 230, 12, 15, 5  # of boxes and lines of text, in pixels
LETTERS = 33  # in a line of a box
COLOURS = ("#eef3fb", "#f6f1e7")  # of floors of gmds, and of geodesics


@functools.cache
def modules() -> dict[str, ast.Module]:
    """Every module of both packages, parsed, by its dotted name."""
    found = {}
    for package in ("gmds", "geodesics"):
        for path in sorted((ROOT / package).rglob("*.py")):
            name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
            found[name] = ast.parse(path.read_text(encoding="utf-8"))
    return found


def imported(tree: ast.Module, known: dict[str, ast.Module]) -> set[str]:
    """The modules among those `known` that a module imports, wherever in it."""
    names = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names += [f"{node.module}.{alias.name}" for alias in node.names]
    found = set()
    for name in names:
        while name and name not in known:
            name = name.rpartition(".")[0]
        found |= {name} - {""}
    return found


def room(module: str) -> str:
    """The room that a module is in: a folder or a file of the top of gmds, or geodesics as a whole."""
    package, _, rest = module.partition(".")
    return package if package == GROUND or not rest else f"{package}.{rest.partition('.')[0]}"


def rests_on(parsed: dict[str, ast.Module]) -> dict[str, set[str]]:
    """The rooms that each room uses, without those it also reaches by another."""
    uses: dict[str, set[str]] = {room(name): set() for name in parsed if room(name) not in HIDDEN}
    for name, tree in parsed.items():
        if room(name) in uses:
            uses[room(name)] |= {room(other) for other in imported(tree, parsed)} - HIDDEN - {room(name)}

    def reached(start: str) -> set[str]:
        return uses[start].union(*(reached(other) for other in uses[start]))

    return {one: others - set().union(*(reached(other) for other in others)) for one, others in uses.items()}


def floors(rooms: set[str]) -> list[list[str]]:
    """Rooms in the order of the contract, highest floor first."""
    table = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    layers = next(c["layers"] for c in table["tool"]["importlinter"]["contracts"] if c["name"] == "Floors")
    found = [[name.strip() for name in layer.split("|")] for layer in layers]
    unnamed = rooms - {name for floor in found for name in floor}
    return [[*floor, *sorted(unnamed)] if LOWEST in floor else floor for floor in found]


def role(tree: ast.Module) -> str:
    return " ".join((ast.get_docstring(tree) or "").split("\n\n")[0].split()).rstrip(".")


def folder(module: str) -> str:
    """The path of a module, without an ending."""
    return module.replace(".", "/")


def is_folder(module: str) -> bool:
    return (ROOT / folder(module)).is_dir()


def table() -> str:
    """The rooms that are folders, and the folders in them, in the order of the floors: a line each."""
    parsed = modules()
    rows = ["| folder | what for |", "|---|---|"]
    for floor in floors(set(rests_on(parsed))):
        for name in floor:
            folders = [path for path in sorted(parsed) if f"{path}.".startswith(f"{name}.") and is_folder(path)]
            rows += [
                f"| [`{folder(path)}/`](../{folder(path)}/__init__.py) | {role(parsed[path])} |" for path in folders
            ]
    return "\n".join([*rows, ""])


def page() -> str:
    """The text of docs/architecture.md, its table as it should be."""
    return TABLE.sub(lambda found: found[1] + table() + found[2], PAGE.read_text(encoding="utf-8"))


def picture() -> str:
    """The text of docs/floors.svg."""
    parsed = modules()
    uses = rests_on(parsed)
    inner = sorted({".".join(name.split(".")[:2]) for name in parsed if name.count(".") > 1 and room(name) == GROUND})
    drawn, top = [], GAP
    for floor in floors(set(uses)):
        ground = floor == [GROUND]
        boxes = [
            (
                name.replace(".", "/"),
                role(parsed[name]),
                sorted(other.rpartition(".")[2] for other in uses.get(name, ())),
            )
            for name in ([GROUND, *inner] if ground else floor)
        ]
        svg, top = _floor(boxes, top, COLOURS[ground])
        drawn.append(svg)
    width = COLUMNS * (WIDTH + GAP) + 2 * GAP
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {top}" font-family="sans-serif" font-size="12">'
    )
    ground = f'<rect width="{width}" height="{top}" fill="white"/>'
    return "\n".join(
        [head, "<title>The rooms of gmds and geodesics, floor by floor</title>", ground, *drawn, "</svg>", ""]
    )


def _floor(boxes: list[tuple[str, str, list[str]]], top: int, colour: str) -> tuple[str, int]:
    """One floor, and where the next begins."""
    svg, y = [], top + GAP
    for start in range(0, len(boxes), COLUMNS):
        row = [_lines(*box) for box in boxes[start : start + COLUMNS]]
        height = max(len(lines) for lines in row) * LINE + GAP
        left = GAP + GAP // 2 + (COLUMNS - len(row)) * (WIDTH + GAP) // 2
        for i, lines in enumerate(row):
            svg += _box(lines, left + i * (WIDTH + GAP), y, height)
        y += height + GAP
    width = COLUMNS * (WIDTH + GAP) + GAP
    band = f'<rect x="{GAP // 2}" y="{top}" width="{width}" height="{y - top}" rx="6" fill="{colour}"/>'
    return "\n".join([band, *svg]), y + GAP // 2


def _lines(name: str, role: str, below: list[str]) -> list[tuple[str, str]]:
    """The lines of a box, with how each is set."""
    return [
        ('font-weight="bold"', name),
        *(("", line) for line in textwrap.wrap(role, LETTERS)),
        *(('fill="#777"', line) for line in textwrap.wrap("uses " + ", ".join(below), LETTERS) if below),
    ]


def _box(lines: list[tuple[str, str]], x: int, y: int, height: int) -> list[str]:
    frame = f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{height}" rx="4" fill="white" stroke="#8aa"/>'
    text = [
        f'<text x="{x + 8}" y="{y + LINE * (i + 1) + 2}" {style}>{html.escape(line)}</text>'
        for i, (style, line) in enumerate(lines)
    ]
    return [frame, *text]


if __name__ == "__main__":
    PICTURE.write_text(picture(), encoding="utf-8")
    PAGE.write_text(page(), encoding="utf-8")
