"""What can be wrong with a map or with what the matcher is given; every error has a stable code and says what to do."""

from __future__ import annotations

from geodesics.errors import FormatError, MeshError


class TooFewVertices(MeshError):
    """The largest component of a mesh is too small to be matched."""

    code = "E113"


class LandmarkError(ValueError):
    """Landmarks that cannot be used; `code` says why and the message says which.

    E300 form, E301 no such vertex, E302 given twice, E303 unequal counts, E304 on no face, E305 off the surface.
    """

    def __init__(self, code: str, message: str) -> None:
        super().__init__(code, message)
        self.code = code

    def __str__(self) -> str:
        return f"{self.code}: {self.args[1]}"


class SampleCountError(ValueError):
    """A number of samples outside the allowed range, which the message gives."""

    code = "E401"

    def __str__(self) -> str:
        return f"{self.code}: {super().__str__()}"


class UnknownKey(ValueError):
    """A configuration key that does not exist; the message names the nearest one that does."""

    code = "E601"

    def __str__(self) -> str:
        return f"{self.code}: {super().__str__()}"


class BadSetting(ValueError):
    """A setting in a file with a value that it cannot have, or a file of settings that cannot be read."""

    code = "E603"

    def __str__(self) -> str:
        return f"{self.code}: {super().__str__()}"


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


class SurfaceFileError(FormatError):
    """A file that should hold a measured surface does not, or is damaged."""

    code = "E215"


class BadPairList(FormatError):
    """A list of pairs of files that cannot be read; the message names the line."""

    code = "E214"


class FolderInUse(OSError):
    """Another run is writing to the same folder."""

    code = "E503"

    def __str__(self) -> str:
        return f"{self.code}: {super().__str__()}"


class PairTimeout(Exception):
    """A pair took longer than it was allowed to."""

    code = "E504"


class WorkersNotStarted(RuntimeError):
    """The worker processes of a batch died as they started, again and again."""

    code = "E506"

    def __str__(self) -> str:
        return f"{self.code}: {super().__str__()}"


class RenderingError(RuntimeError):
    """Nothing can be drawn by the renderer that was asked for; the message says why and what to do."""

    code = "E510"

    def __str__(self) -> str:
        return f"{self.code}: {super().__str__()}"


class PictureFormat(FormatError):
    """A picture in a format that there is none of; the message lists those that there are."""

    code = "E218"


class ModelFileError(FormatError):
    """A file that should hold a shape model does not, or is damaged."""

    code = "E233"


class AtlasFileError(FormatError):
    """A file that should hold an atlas does not, or is damaged."""

    code = "E234"


class NoAtlas(ValueError):
    """A collection of which no atlas can be made: fewer than two meshes can be matched."""

    code = "E507"

    def __str__(self) -> str:
        return f"{self.code}: {super().__str__()}"


class BadGroups(FormatError):
    """A table of groups or covariates that cannot be used; the message names the specimen or the column."""

    code = "E235"
