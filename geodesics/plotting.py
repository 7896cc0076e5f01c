"""A surface, and values on it, as a figure to be turned."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arguments import real_numbers
from geodesics.arrays import Floats
from geodesics.distance import as_points
from geodesics.errors import BadArgument, BadShape, MissingExtra
from geodesics.extras import how_to_install
from geodesics.mesh import Mesh
from geodesics.plotted import figure_class
from geodesics.points import SurfacePoints

# all set by hand
COLOURS = "Cividis"  # told apart by people who confuse red and green
PLAIN = "rgb(190,200,215)"
POINT_COLOUR = "rgb(200,60,0)"
POINT_SIZE = 5  # pixels
LINE_WIDTH = 6  # pixels
BAR = {"len": 0.85, "thickness": 18}  # of the height, so that its last number is not cut; pixels
LIGHT = {"ambient": 0.55, "diffuse": 0.6, "specular": 0.1, "roughness": 0.8}


def plot(
    mesh: Mesh,
    values: ArrayLike | None = None,
    *,
    points: SurfacePoints | ArrayLike | None = None,
    paths: Sequence[SurfacePoints | ArrayLike] | SurfacePoints | None = None,
    label: str = "",
    title: str = "",
    up: tuple[float, float, float] = (0, 0, 1),
) -> Any:
    """A surface coloured by values at its vertices, to be turned with the mouse: last in a notebook cell it is shown.

    Parameters
    ----------
    mesh : Mesh
        The surface, of n vertices.
    values : array_like of shape (n,), (1, n) or (n, 3), optional
        A number for each vertex (an eigenfunction, a signature at one time, the field of one point), with a bar of
        colours; what is not finite is drawn at the lower end. Or red, green and blue for each, from 0 to 1.
    points : SurfacePoints or array_like of int, optional
        Points, or vertices, to be marked.
    paths : sequence of SurfacePoints or array_like of shape (k, 3), optional
        Lines to be drawn, each from point to point; or one alone.
    label : str
        What the values are, and in which unit, beside the bar of colours.
    title : str
        Above it.
    up : three floats
        What is up in the coordinates of the mesh.

    Returns
    -------
    plotly.graph_objects.Figure
        ``.show()`` opens it in a browser, ``.write_html(path)`` keeps it.

    Raises
    ------
    MeshError
        E108 when there is not one value for each vertex, or a path is no row of positions; E105 for points that do
        not exist.
    ValueError
        For colours that are not from 0 to 1, and an `up` that is no direction.
    MissingExtra
        E602, without the extra `viz`.

    See Also
    --------
    gmds.pictures.write_values : A picture in a file, of several surfaces side by side.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> figure = geodesics.plot(sphere, sphere.vertices[:, 2], points=[0, 1])
    >>> [trace.type for trace in figure.data]
    ['mesh3d', 'scatter3d']
    """
    try:
        import plotly.graph_objects as go
    except ImportError as error:
        raise MissingExtra(f"a plot needs plotly; install it with: {how_to_install('viz')}") from error

    mesh = Mesh.from_object(mesh)
    corners = {name: mesh.faces[:, k] for k, name in enumerate("ijk")}
    looks = {"lighting": LIGHT, "flatshading": False, "hovertemplate": "vertex %{text}<extra></extra>"}
    surface = go.Mesh3d(**_axes(mesh.vertices), **corners, text=np.arange(mesh.n_vertices), **looks)
    surface.update(_colours(values, mesh.n_vertices))
    surface.update(colorbar={"title": {"text": label, "side": "right"}, **BAR})
    figure = figure_class()(surface)
    if points is not None:
        marker = {"size": POINT_SIZE, "color": POINT_COLOUR}
        figure.add_scatter3d(**_axes(as_points(mesh, points).positions), mode="markers", marker=marker, name="points")
    lines = _several(paths)
    if lines:
        line = {"width": LINE_WIDTH, "color": POINT_COLOUR}
        figure.add_scatter3d(**_axes(_broken_line(lines)), mode="lines", line=line, name="paths")
    hidden = {f"{axis}axis": {"visible": False} for axis in "xyz"}
    camera = {"up": dict(zip("xyz", _direction(up), strict=True))}
    figure.update_layout(title=title, scene={"aspectmode": "data", "camera": camera, **hidden})
    figure.update_layout(margin={"l": 0, "r": 0, "t": 40 if title else 0, "b": 0}, showlegend=False)
    return figure


def _direction(up: Any) -> list[float]:
    found = real_numbers(up, "up")
    if found.shape != (3,) or not np.isfinite(found).all() or not found.any():
        raise BadArgument(f"up must be a direction of three numbers, as (0, 0, 1), not {up!r:.60}")
    return [float(x) for x in found]


def _several(paths: Any) -> list[Any]:
    """The paths in a list, one of them alone too."""
    if paths is None:
        return []
    if isinstance(paths, SurfacePoints) or (isinstance(paths, np.ndarray) and paths.ndim == 2):
        return [paths]
    if not isinstance(paths, Iterable):
        raise BadArgument(f"paths must be lines, each of positions of shape (k, 3), not {paths!r:.40}")
    return list(paths)


def _broken_line(paths: Sequence[SurfacePoints | ArrayLike]) -> Floats:
    """Positions (k, 3) along all paths, with a row of NaN after each, where plotly lifts the pen."""
    rows = []
    for path in paths:
        places = path.positions if isinstance(path, SurfacePoints) else real_numbers(path, "paths")
        if places.ndim != 2 or places.shape[1] != 3:
            raise BadShape(f"a path must be positions of shape (k, 3), not {places.shape}")
        rows += [places, np.full((1, 3), np.nan)]
    return np.concatenate(rows)


def _axes(positions: Any) -> dict[str, Any]:
    return dict(zip("xyz", positions.T, strict=True))


def _colours(values: ArrayLike | None, count: int) -> dict[str, Any]:
    """What tells plotly the colours of the vertices."""
    if values is None:
        return {"color": PLAIN}
    v = real_numbers(values, "values")
    v = v[0] if v.shape == (1, count) else v
    if v.shape == (count, 3):
        if not ((v >= 0) & (v <= 1)).all():
            raise BadArgument("colours must be numbers from 0 to 1; divide those from 0 to 255 by 255")
        return {"vertexcolor": [f"rgb({r:.0f},{g:.0f},{b:.0f})" for r, g, b in 255 * v]}
    if v.shape != (count,):
        raise BadShape(f"values must be {count} numbers, one for each vertex, or {count} colours, not shape {v.shape}")
    finite = v[np.isfinite(v)]
    low = finite.min() if len(finite) else 0.0
    told = "vertex %{text}: %{intensity:.4g}<extra></extra>"
    return {"intensity": np.where(np.isfinite(v), v, low), "colorscale": COLOURS, "hovertemplate": told}
