"""The ways of colouring: what they are called, what they mean, and where their scales end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from geodesics.arrays import Floats
from gmds.maps.words import WORDS
from gmds.pictures.colours import few_known
from gmds.pictures.scales import FINE, SIGNED, TOPS
from gmds.report.packing import levels

UNMATCHED_COLOUR = (0.93, 0.60, 0.20)  # sRGB, orange: without a counterpart
MATCHED_COLOUR = (0.28, 0.47, 0.72)  # sRGB, blue: with one
MATCH = (
    "A point and its partner on the other surface have the same colour. Look for a part that has the colour of "
    "another part, a left leg that of a right leg, say: there the map is wrong."
)
VALID = "Which points of either surface have a partner. Those without are on a part that the other surface lacks."
LOOK = {
    "confidence": " Yellow is where to look first.",
    "distortion": " Where one animal has a longer neck than the other, they have to. Yellow changes most.",
    "growth": " Orange became longer than the whole did, blue shorter; white grew as the whole did.",
    "error": " Dark blue is right, yellow is wrong.",
}
SPARSE = " The error is known at {} points, drawn as dots; elsewhere it is not, and the surface is grey."
AXES = {
    "confidence": "confidence",
    "distortion": "distortion",
    "growth": "growth: log of the change of length, beside that of the whole",
    "error": "error: distance from the true point / √area",
}
UNITS = {"confidence": "confidence", "distortion": "distortion", "growth": "log growth", "error": "error / √area"}


def modes(known: Sequence[str], errors: Floats | None = None) -> list[dict[str, Any]]:
    """The ways of colouring: what they are called, what they mean, and where their scale ends."""
    swatches = levels(np.array([UNMATCHED_COLOUR, MATCHED_COLOUR])).tolist()
    found: list[dict[str, Any]] = [{"key": "match", "label": "Matching colours", "help": MATCH}]
    for key in known:
        few = len(few_known(errors[0])) if errors is not None and key == "error" else 0
        sparse = SPARSE.format(f"{few:,}") if few else ""
        about = {"key": key, "label": key.capitalize(), "help": WORDS[key] + LOOK[key] + sparse, "axis": AXES[key]}
        counted = "points" if sparse else "vertices"
        found.append(
            {
                **about,
                "unit": UNITS[key],
                "counted": counted,
                "high": TOPS[key],
                "fine": FINE.get(key, 0),
                "reversed": key == "confidence",
                "signed": key in SIGNED,
            }
        )
    judged = sum(key in known for key in ("confidence", "distortion"))
    found.insert(1 + judged, {"key": "valid", "label": "Counterparts", "help": VALID, "swatches": swatches})
    return found
