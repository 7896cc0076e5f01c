"""Points picked in MeshLab (.pp)."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn
from xml.parsers import expat
from xml.sax.saxutils import quoteattr

import numpy as np

from gmds.landmarks.files.named_points import BadLandmarkFile, Landmarks, Space
from gmds.landmarks.files.reading import Rows, position

NO_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # what no XML file may hold


def parse_pp(path: Path, text: str, _: Space) -> Landmarks:
    """Every point; those that are not active have no place. Entities are refused, so nothing grows or is fetched."""
    rows, parser = Rows(path), expat.ParserCreate()
    opened: list[str] = []

    def refuse(*_: Any) -> NoReturn:
        raise BadLandmarkFile(
            f"{path}, line {parser.CurrentLineNumber}: it declares entities of XML, which are refused"
        )

    def start(tag: str, found: dict[str, str]) -> None:
        opened.append(tag)
        if tag == "point":
            line = parser.CurrentLineNumber
            inactive = found.get("active", "1").strip() == "0"
            at = None if inactive else position(path, line, [found.get(axis, "?") for axis in "xyz"])
            rows.add(f"line {line}", found.get("name"), at, "undefined")

    parser.EntityDeclHandler = refuse
    parser.StartElementHandler = start
    try:
        parser.Parse(text.encode("utf-8", "surrogatepass"), True)
    except expat.ExpatError as error:
        raise BadLandmarkFile(f"{path}, line {error.lineno}: no XML ({expat.ErrorString(error.code)})") from error
    if opened[:1] != ["PickedPoints"]:
        raise BadLandmarkFile(f"{path} holds no PickedPoints of MeshLab")
    return rows.landmarks()


def pp_text(landmarks: Landmarks, _: Space, __: Mapping[str, Sequence[object]]) -> str:
    """As MeshLab writes it; what has no place is not active."""
    lines = []
    for name, at, there in zip(landmarks.names, landmarks.positions, landmarks.defined, strict=True):
        x, y, z = map(repr, np.nan_to_num(at).tolist())
        lines.append(f' <point x="{x}" y="{y}" z="{z}" active="{int(there)}" name={quoteattr(NO_XML.sub("", name))}/>')
    return "\n".join(["<!DOCTYPE PickedPoints>", "<PickedPoints>", *lines, "</PickedPoints>"]) + "\n"
