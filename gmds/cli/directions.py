"""What is up in a mesh."""

from __future__ import annotations

from pathlib import Path

Y_UP = (".obj", ".glb", ".gltf")  # where the format, or the custom, has y pointing up
UP = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}


def upwards(up: str | None, name: str) -> tuple[int, int, int]:
    """What is up in a mesh: the axis that was said, else the one of its format."""
    return UP[up or ("y" if Path(name).suffix.lower() in Y_UP else "z")]
