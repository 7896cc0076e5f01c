"""Landmarks, and landmark files as texts."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from gmds.landmarks.files import ENDINGS, Landmarks

AT = np.array([[1.25, -2.5, 3.0], [0.1, 1e-7, -1e6], [1 / 3, 2.0, 5.0]])
MARKS = Landmarks(("nose tip", 'left, "ear"', "Größe;3"), AT)
IN_SPACE = [ending for ending in ENDINGS if ending != ".vts"]
NAMED = [".csv", ".mrk.json", ".fcsv"]
AVIZO = """# Avizo 3D ASCII 2.0
define Markers 2
Parameters { NumSets 1, ContentType "LandmarkSet" }
Markers { float[3] Coordinates } @1

# Data section follows
@1
1e+00 2 3
4 5 6
"""
HEAD = "# Markups fiducial file version = 4.13\n# CoordinateSystem = LPS\n# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n"  # noqa: E501


def markups(*points: object, frame: str | None = "LPS", schema: str = "1.0.0") -> str:
    markup = {"type": "Fiducial", "controlPoints": list(points), **({"coordinateSystem": frame} if frame else {})}
    return json.dumps({"@schema": f"https://x/markups-schema-v{schema}.json#", "markups": [markup]})


def written(folder: Path, name: str, text: str) -> Path:
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name
