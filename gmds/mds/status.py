"""How an answer came about, as a sentence."""

from __future__ import annotations

from enum import Enum


class Status(Enum):
    """How a solver ended; the value is a sentence.

    See Also
    --------
    MatchStatus : That of a map.

    Examples
    --------
    >>> import gmds
    >>> [status.name for status in gmds.Status]
    ['CONVERGED', 'STALLED', 'ITERATION_LIMIT']
    """

    CONVERGED = "converged: the linearised problem can lower the stress by next to nothing"
    STALLED = "stalled: no step, however short, lowers the stress any more"
    ITERATION_LIMIT = "stopped at the iteration limit while the stress was still falling"
