"""atlas(): a collection of meshes brought to one triangulation, and their mean shape."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from geodesics.errors import BadArgument
from gmds.atlases.registered import Atlas
from gmds.atlases.rounds import Progress, Rounds
from gmds.batch.collection import Collection, Given, Shape
from gmds.batch.workers import local_client
from gmds.errors import NoAtlas
from gmds.suggestions import did_you_mean

# With one template. A registration takes about a third of the time of a match. On FAUST (`benchmarks/results/notes.md`,
# "Atlas") pairs are off by 4 % less with 1 than with none and by 5 % with 4; of maps of six templates it takes away.
NEIGHBOURS = 1


def atlas(
    shapes: Given,
    output: str | Path | None = None,
    *,
    template: str | None = None,
    templates: int = 1,
    rounds: int = 1,
    neighbours: int | None = None,
    mirror: Sequence[str] | str = (),
    progress: Progress | None = None,
    **matching: Any,
) -> Atlas:
    """Bring many meshes to one triangulation, on which vertex i is the same point of all of them.

    The specimen to which the others are nearest (the medoid by `least_distortion`) is the template, and is matched to
    each of them by `match_collection`. With several templates each is matched to all; what they say, composed through
    the first, is put to the vote, by confidence. Then each specimen is registered directly from some others, starting
    from there. All these maps are taken both ways until they agree: of what they say of a point of a specimen, the
    middle is taken; how far they disagree is the `spread`. In later rounds the mean shape is the template.

    Parameters
    ----------
    shapes : folder, sequence of paths, or mapping
        As of `match_collection`.
    output : path, optional
        A folder that keeps the maps, from which a later call goes on; a passing one unless given.
    template : str, optional
        The name of the first template; the medoid unless given.
    templates : int
        How many.
    rounds : int
        From the second on, the mean shape is matched to all specimens; rounds end when it moves no more.
    neighbours : int
        From how many others each specimen is registered: 1 unless given where there is one template, else none. None
        with a `distance`, or fewer than 5 specimens.
    mirror : sequence of str, str or "auto"
        Specimens of the other side, which are mirrored; "auto" finds out which.
    progress : callable, optional
        Called as `progress(stage, fraction)`.
    **matching
        timeout and client of `match_collection`, and the options of `match`.

    Returns
    -------
    Atlas
        Of all specimens that could be matched; `failures` says which could not, and why.

    Raises
    ------
    NoAtlas
        E507 when fewer than two meshes can be matched.
    BadArgument
        E604 for a name that there is none of, or a count below 1.
    FormatError, OSError, MissingExtra, WorkersNotStarted
        As `match_collection`.

    See Also
    --------
    ShapeModel.from_atlas : What varies in it.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> shapes = {"standing": quadruped(n_vertices=200), "walking": quadruped("walk", n_vertices=200)}
    >>> if __name__ == "__main__":  # as other processes take part
    ...     made = gmds.atlas(shapes)
    ...     print(made.names, made.positions.shape)
    ('standing', 'walking') (2, 200, 3)
    """
    if neighbours is None:
        neighbours = NEIGHBOURS if templates == 1 else 0
    if templates < 1 or rounds < 1 or neighbours < 0:
        raise BadArgument("there must be one template and one round at least, and no fewer than 0 neighbours")
    with contextlib.ExitStack() as stack:
        known = _collection(shapes)
        folder = Path(output or stack.enter_context(tempfile.TemporaryDirectory(prefix="gmds-"))).absolute()
        folder.mkdir(parents=True, exist_ok=True)
        if isinstance(mirror, str) and mirror == "auto":
            matching, mirror = {"orientation": "any", **matching}, ("auto",)
        names = [mirror] if isinstance(mirror, str) else list(mirror)
        for name in [one for one in (template, *names) if one not in (None, "auto")]:
            if name not in known:
                raise BadArgument(f"there is no specimen {name!r}{did_you_mean(str(name), list(known))}")
        client = matching.pop("client", None)
        if not hasattr(client, "submit"):
            client = stack.enter_context(client or local_client())
        report = progress or (lambda stage, share: None)
        work = Rounds(known, folder, frozenset(names), matching, report, rounds, neighbours, client)
        return work.done(template, templates)


def _collection(shapes: Given) -> dict[str, Shape]:
    try:
        return dict(Collection.of(shapes).shapes)
    except BadArgument as error:
        if "nothing to match" in str(error):
            alone = str(error).partition("no pair")[2]
            raise NoAtlas(f"an atlas takes two meshes or more, and there is one{alone}") from error
        raise
