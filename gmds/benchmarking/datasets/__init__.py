"""Published benchmark folders, each in its publisher's own format, as pairs with truth: one kind of folder a file.

Nothing is copied or downloaded: a folder is given by its path, and recognised by what is in it.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from gmds.benchmarking.datasets.remeshed import remeshed
from gmds.benchmarking.datasets.scaled import scaled
from gmds.benchmarking.datasets.shrec20 import shrec20
from gmds.benchmarking.pairs import Pair, UnknownDataset

__all__ = ["dataset_pairs"]

Reader = Callable[[Path, Path | None], list[Pair] | None]

ALL: tuple[Reader, ...] = (
    remeshed,
    scaled,
    shrec20,
)
"""Each gives the pairs of a folder, in the published order or those of a listing; None for a folder of another kind."""


def dataset_pairs(folder: Path, listing: Path | None = None) -> list[Pair]:
    """The pairs of a published benchmark, recognised by what is in its folder.

    Parameters
    ----------
    folder : Path
        With `corres/*.vts` and `test_pairs.txt` (remeshed FAUST and TOSCA), `pairs.json` (locally scaled pairs), or
        `models`, `gts` and `test-sets` (SHREC'20).
    listing : Path, optional
        A file that names the pairs to take: two shapes a line, or one pair of `pairs.json`.

    Returns
    -------
    list of Pair
        In the published order, or in that of the listing.

    Raises
    ------
    UnknownDataset
        E230, for another folder, or a listing that names what is not there.

    See Also
    --------
    gmds.benchmarking.benchmark : Runs a matcher on them.
    """
    folder = Path(folder)
    for pairs_of in ALL:
        pairs = pairs_of(folder, listing)
        if pairs is not None:
            return pairs
    raise UnknownDataset(f"{folder} has neither corres/, pairs.json nor gts/ + models/: not a known benchmark folder")
