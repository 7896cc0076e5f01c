"""The settings that a map was made with, as the command line has them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from gmds.cli.choices import DISTANCES, LOSSES, METRICS, ChosenDistance, chosen_loss
from gmds.cli.output import note
from gmds.errors import BadSetting
from gmds.maps.npz_format import read_meta
from gmds.provenance import in_words

NEEDED = {"n_samples", "orientation", "rng", "loss", "distance"}  # the parameters that every map records
BEFORE_PARTS = "neither"  # what stands for `parts` in maps that were made before there was a choice


def map_settings(path: Path) -> dict[str, dict[str, Any]]:
    """Settings by table; the version that made the map is named on stderr where it is another one.

    Raises `FormatError` when it is no map, `BadSetting` (E603) for a distance or a loss of a user's own, which the
    command line has no name for.
    """
    from gmds._version import __version__

    meta = read_meta(path)
    made, versions = meta.get("parameters"), meta.get("versions")
    if not isinstance(made, dict) or not made.keys() >= NEEDED:
        raise BadSetting(f"{path} was not made by matching and holds no settings")
    version = versions.get("gmds") if isinstance(versions, dict) else None
    if version != __version__:
        note(f"{path} was made by gmds {version}; this is {__version__}, and the map may become another")
    matching = {"samples": made["n_samples"], "orientation": made["orientation"], "seed": made["rng"]}
    matching["parts"] = made.get("parts", BEFORE_PARTS)
    matching["loss"] = _named(path, "loss", made["loss"], ((name, chosen_loss(name)) for name in LOSSES))
    if made["distance"] is not None:
        pairs = (((m, d), ChosenDistance(m, d)) for m in METRICS for d in DISTANCES)
        matching["metric"], matching["distance"] = _named(path, "distance", made["distance"], pairs)
    return {"matching": matching, "match": {"landmarks": [str(path)]} if "landmarks" in made else {}}


def _named(path: Path, what: str, words: object, known: Iterable[tuple[Any, Any]]) -> Any:
    """The name of the thing that these words describe."""
    for name, thing in known:
        if in_words(thing) == words:
            return name
    raise BadSetting(f"{path} was made with the {what} {words!s:.200}, which has no name on the command line")
