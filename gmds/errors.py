"""What can be wrong with a map or its file; every error has a stable code and says what to do."""

from __future__ import annotations

from geodesics.errors import FormatError


class MapError(ValueError):
    """Arrays that do not describe a map between two given meshes; the message says which row."""

    code = "E310"

    def __init__(self, message: str) -> None:
        super().__init__(f"{self.code}: {message}")


class MapMembers(FormatError):
    """A map file lacks a member, has one too many, or is no npz archive at all."""

    code = "E210"


class MapArray(FormatError):
    """A member of a map file has the wrong dtype, shape or values."""

    code = "E211"


class MapMismatch(FormatError):
    """A map file belongs to other meshes: counts or SHA-256 differ."""

    code = "E212"


class MapVersion(FormatError):
    """A map file has another format or a version from the future."""

    code = "E213"


class PickledMember(FormatError):
    """A map file holds pickled objects, which are never loaded."""

    code = "E220"


class SolverError(ArithmeticError):
    """The stress is not a finite number at the start, so there is nothing to improve."""

    code = "E403"

    def __init__(self, message: str) -> None:
        super().__init__(f"{self.code}: {message}")
