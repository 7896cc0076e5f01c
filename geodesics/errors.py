"""What can be wrong with a mesh or a file; every error has a stable code and says what to do."""

from __future__ import annotations


class MeshError(ValueError):
    """Arrays that do not describe a triangle mesh; `code` is stable across versions."""

    code = "E100"

    def __init__(self, message: str) -> None:
        super().__init__(f"{self.code}: {message}")


class FormatError(ValueError):
    """A file that can not be read; `code` is stable across versions."""

    code = "E200"

    def __init__(self, message: str) -> None:
        super().__init__(f"{self.code}: {message}")


class NonFiniteVertex(MeshError):
    """A vertex coordinate is NaN or infinite."""

    code = "E101"


class CoordinateRange(MeshError):
    """Coordinates so large or small that areas are not finite in float64."""

    code = "E102"


class EmptyMesh(MeshError):
    """There are no vertices."""

    code = "E103"


class NoFaces(MeshError):
    """There are vertices but no faces."""

    code = "E104"


class IndexOutOfRange(MeshError):
    """A face refers to a vertex that does not exist."""

    code = "E105"


class NonIntegralFace(MeshError):
    """A face index is not a whole number."""

    code = "E106"


class BadDtype(MeshError):
    """An array holds something other than real numbers."""

    code = "E107"


class BadShape(MeshError):
    """An array has the wrong shape."""

    code = "E108"


class NotTriangles(MeshError):
    """Faces are quads or larger polygons."""

    code = "E109"


class ZeroArea(MeshError):
    """Every face has zero area."""

    code = "E114"


class EigensolverFailed(RuntimeError):
    """The eigenvalue iteration did not converge, or the matrix could not be factorised."""

    code = "E402"

    def __init__(self, message: str) -> None:
        super().__init__(f"{self.code}: {message}")
