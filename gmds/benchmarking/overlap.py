"""How well a map tells what has a counterpart from what has none, judged where the truth is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Bools, Integers
from gmds.errors import MapError


@dataclass(frozen=True)
class OverlapScores:
    """How well a map tells what has a counterpart from what has none; None where nothing could be told.

    Attributes
    ----------
    iou : float
        Of what is called valid and what has a counterpart: how many are both, over how many are either, in [0, 1].
    precision : float
        The share of what is called valid that has a counterpart.
    recall : float
        The share of what has a counterpart that is called valid.

    See Also
    --------
    overlap_scores : Makes it.
    """

    iou: float | None
    precision: float | None
    recall: float | None


def overlap_scores(valid: ArrayLike, there: ArrayLike, missing: ArrayLike) -> OverlapScores:
    """How well `valid` of a map is, judged by the source vertices of which the truth is known.

    Parameters
    ----------
    valid : bool array of shape (n,)
        Of all source vertices.
    there, missing : int arrays of shapes (p,), (q,)
        Vertices that have a counterpart, and vertices that have none. What is in both counts as there; repeated
        vertices count once.

    Returns
    -------
    OverlapScores
        Shares in [0, 1].

    Raises
    ------
    MapError
        E310, for a vertex that does not exist.

    See Also
    --------
    geodesic_error : How right the map is where there is a counterpart.
    """
    said = np.asarray(valid, dtype=np.bool_)
    known = np.unique(_checked(there, len(said)))
    gone = np.setdiff1d(_checked(missing, len(said)), known)
    right, wrong = int(said[known].sum()), int(said[gone].sum())
    shares = [right / of if of else None for of in (len(known) + wrong, right + wrong, len(known))]
    return OverlapScores(*shares)


def overlap_figures(valid: Bools, there: Integers, missing: Integers | None) -> dict[str, float | None]:
    """The columns that say how well a map tells what is `missing` (q,) from what is `there` (p,)."""
    if missing is None:
        return {}
    scores = overlap_scores(valid, there, missing)
    shares = {"overlap_iou": scores.iou, "valid_precision": scores.precision, "valid_recall": scores.recall}
    shares["missing_found"] = float((~valid[missing]).mean()) if len(missing) else None
    return {name: None if share is None else 100 * share for name, share in shares.items()}


def _checked(vertices: ArrayLike, count: int) -> Integers:
    indices = np.asarray(vertices, dtype=np.int64).reshape(-1)
    bad = indices[(indices < 0) | (indices >= count)]
    if len(bad):
        raise MapError(f"source index {bad[0]} does not exist; the map has {count} rows")
    return indices
