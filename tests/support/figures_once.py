"""Built-in animals and people that one run makes once: each takes a third of a second, and many tests use the same."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from gmds.shapes.figure import Figure, figure
from gmds.shapes.skeleton import Body, Move

MAKERS = ("gmds.shapes.quadruped", "gmds.shapes.humanoid")  # modules that call `figure`
PARTS = ("vertices", "faces", "rest")


def kept_in(folder: Path) -> Callable[..., Figure]:
    """`figure` that keeps what it made in a folder; what it gives is another object every time, with the same bits."""

    def kept(body: Body, moves: Mapping[str, Move], **given: float) -> Figure:
        known = repr((body, sorted(moves.items()), sorted(given.items())))
        path = folder / f"{hashlib.sha256(known.encode()).hexdigest()}.npz"
        if not path.exists():
            made = figure(body, moves, **given)  # type: ignore[arg-type]
            handle, half = tempfile.mkstemp(dir=folder)
            with os.fdopen(handle, "wb") as stream:
                np.savez(stream, **{part: getattr(made, part) for part in PARTS})  # type: ignore[arg-type]
            os.replace(half, path)  # whole or not there, whatever another worker of the run does
        with np.load(path) as stored:
            return Figure(*(stored[part] for part in PARTS))

    return kept


def use(make: Callable[..., Figure], patch: pytest.MonkeyPatch) -> None:
    """Let the built-in shapes be made by `make`."""
    for name in MAKERS:
        patch.setattr(import_module(name), "figure", make)
