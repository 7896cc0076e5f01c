"""Landmarks as the page shows them: where they are drawn on both surfaces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from gmds.report.drawing import Drawing

Both = tuple[Drawing, Drawing]


def places(at: Sequence[ArrayLike | None], drawn: Both) -> list[list[float] | None]:
    """Where a landmark is drawn on either surface; None where it has no place."""
    return [
        None if one is None else of_side.placed(np.asarray(one)).tolist()
        for one, of_side in zip(at, drawn, strict=True)
    ]
