"""Notes on a mesh or a file: worth knowing, but no errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Note:
    """Something worth knowing about a mesh or a file that is no error.

    Parameters
    ----------
    code : str
        Stable across versions, such as W213.
    severity : {"info", "warning"}
        A warning says that results may suffer.
    message : str
        One sentence.
    indices : tuple of int
        The first of the faces or vertices that are meant.
    count : int, optional
        How many there are, where they are counted.

    Examples
    --------
    >>> import geodesics
    >>> print(geodesics.Note('W001', 'warning', 'something is odd', (3, 9)))
    W001: something is odd
    """

    code: str
    severity: Literal["info", "warning"]
    message: str
    indices: tuple[int, ...] = ()
    count: int | None = None

    def __str__(self) -> str:
        return f"{self.code}: {self.message}"
