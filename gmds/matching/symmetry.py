"""self_symmetry(): the maps of a surface to itself, other than the identity."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from geodesics import Mesh
from geodesics.errors import BadArgument
from geodesics.threads import on_one_blas_thread
from gmds.correspondence import Correspondence
from gmds.maps.point_map import MatchStatus
from gmds.matching.clean_copies import on_given
from gmds.matching.large_surfaces import WORKING, CoarseCopies, copied
from gmds.matching.result import correspondence_of
from gmds.matching.self_maps import SelfMap, likely, self_maps
from gmds.mds.losses import LeastSquares
from gmds.suggestions import suggest_keywords
from gmds.surface.measured import measure


@suggest_keywords
@on_one_blas_thread
def self_symmetry(
    mesh: Mesh, *, n_vertices: int = WORKING, progress: Callable[[str, float], None] | None = None
) -> list[Correspondence]:
    """The intrinsic symmetries of a surface, best first, the identity excluded; see the abstract: size does not matter.

    One is found whether or not the pose is symmetric, and also where one of two ears or legs is larger than the other:
    proposals come from the scale-invariant metric (2.1) among others, and parts may change size in the registration.
    Most animals have one, from left to right; an ellipsoid has seven. A surface of revolution has more than can be
    listed: some of them are.

    `meta["symmetry"]` says of each whether it is `reversing` orientation, its `stress` (mean change of distances over
    the mean distance), `orientation` (share of the area that keeps it, minus the rest), `energy` of the deformation,
    and `twice`: how far, on average and in root areas, points are from home after the map is done twice - 0 for an
    involution, and then a measure of its error.

    Parameters
    ----------
    mesh : Mesh
        The surface.
    n_vertices : int
        A mesh with more is solved on a decimated copy, and the maps are prolonged to all of it; where it cannot be
        decimated (edges with three faces) the whole is used. At least 100.
    progress : callable, optional
        Called as `progress(stage, fraction)`.

    Returns
    -------
    list of Correspondence
        Of the mesh with itself, with `status` GOOD. On a surface without symmetry the list holds the self-map that
        comes closest, alone, with status POOR; it is empty when there is not even that.

    Raises
    ------
    MeshError
        As `Mesh` does; `TooFewVertices` (E113) when the largest part has fewer than 12.
    ValueError
        When `n_vertices` is below 100.

    See Also
    --------
    match : Two surfaces.

    References
    ----------
    Abstract of Aflalo, Kimmel, Raviv: Scale invariant geometry for nonrigid shapes (2013); Ovsjanikov, Sun, Guibas:
    Global intrinsic symmetries of shapes (2008).

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> maps = gmds.self_symmetry(animal)
    >>> left = animal.vertices[:, 1] > 0.2
    >>> bool((maps[0].points.positions[left, 1] < 0).mean() > 0.9)
    True
    """
    if n_vertices < 100:
        raise BadArgument(f"n_vertices must be at least 100, not {n_vertices}: fewer do not show a shape")
    report = progress or (lambda stage, fraction: None)
    started = time.perf_counter()
    mesh = Mesh.from_object(mesh)
    report("measuring", 0.0)
    surface = measure(mesh)
    copy = surface if mesh.n_vertices <= n_vertices else copied(surface, n_vertices)
    maps = likely(list(self_maps(copy, copy.reflection, LeastSquares(), report)))
    good = [m for m in maps if m.plausible]
    seconds = round(time.perf_counter() - started, 3)
    report("done", 1.0)
    settings = {"parameters": {"n_vertices": n_vertices}, "seconds": seconds}
    status = MatchStatus.GOOD if good else MatchStatus.POOR
    answers = [_correspondence(m, settings, status) for m in good or maps[:1]]
    copies = CoarseCopies(surface, surface, (copy, copy))
    whole = answers if copy is surface else [copies.prolonged(one) for one in answers]
    return [on_given(one, surface, surface) for one in whole]


def _correspondence(one: SelfMap, settings: dict[str, object], status: MatchStatus) -> Correspondence:
    """The self-map as a Correspondence."""
    evidence = one.candidate.evidence
    figures = {
        "reversing": one.candidate.pair.reflected,
        "stress": evidence.stress,
        "orientation": evidence.orientation,
        "energy": one.energy,
        "twice": one.involution_error,
    }
    return replace(correspondence_of([one.candidate], {**settings, "symmetry": figures}), status=status)
