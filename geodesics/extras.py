"""Optional parts: the packages of each, and the command that brings them."""

from __future__ import annotations

# as in pyproject.toml
PACKAGES = {
    "viz": ("matplotlib>=3.8", "plotly>=6", "pyvista>=0.44", "pillow>=10"),
    "repair": ("pymeshlab>=2023.12",),
    "batch": ("distributed>=2024.1",),
    "neuro": ("nibabel>=5.2",),
    "notebook": ("anywidget>=0.9",),
}


def how_to_install(extra: str) -> str:
    """The command that brings an optional part into an installation that is there already, wherever it came from."""
    return f"pip install {' '.join(map(repr, PACKAGES[extra]))} (the extra {extra!r})"
