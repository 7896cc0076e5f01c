"""What can be wrong with a mesh or a file; every error has a stable code and says what to do."""

from __future__ import annotations

from geodesics.notes import Note as Note


class _Coded(Exception):
    """An error that begins with its code."""

    code: str

    def __str__(self) -> str:
        return f"{self.code}: {super().__str__()}"


class MeshError(_Coded, ValueError):
    """Arrays that do not describe a triangle mesh; `code` is stable across versions.

    Examples
    --------
    >>> import geodesics
    >>> try:
    ...     geodesics.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 7]])
    ... except geodesics.MeshError as error:
    ...     print(error)
    E105: face 0 = [0 1 7] refers outside the 3 vertices; indices count from 0
    """

    code = "E100"


class FormatError(_Coded, ValueError):
    """A file that cannot be read; `code` is stable across versions.

    See Also
    --------
    MeshError : Arrays, or the content of a file, that are no triangle mesh.

    Examples
    --------
    >>> import geodesics, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder) / 'dog.off'
    ...     size = path.write_text('OFF 4 4 0')
    ...     try:
    ...         geodesics.read_mesh(path)
    ...     except geodesics.FormatError as error:
    ...         print(error.code)
    E205
    """

    code = "E200"


class NonFiniteVertex(MeshError):
    """A vertex coordinate is NaN or infinite."""

    code = "E101"


class CoordinateRange(MeshError):
    """Coordinates so large or small that areas or their squares leave the range of float64."""

    code = "E102"


class EmptyMesh(MeshError):
    """There are no vertices."""

    code = "E103"


class NoFaces(MeshError):
    """There are vertices but no faces."""

    code = "E104"


class IndexOutOfRange(MeshError):
    """An index refers to a vertex or face that does not exist."""

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


class NotManifold(MeshError):
    """An edge of more than two faces, where the algorithm needs at most two."""

    code = "E110"


class ZeroArea(MeshError):
    """Every face has zero area."""

    code = "E114"


class BadWeights(MeshError):
    """Barycentric weights are not finite, negative, or do not sum to one."""

    code = "E115"


class EmptyFile(FormatError):
    """The file holds nothing."""

    code = "E201"


class NotAFile(FormatError):
    """The path is a directory, a pipe or a device."""

    code = "E202"


class UnknownFormat(FormatError):
    """The content is none of the supported formats."""

    code = "E203"


class TruncatedFile(FormatError):
    """The file ends before what it declares, or disagrees with its own header."""

    code = "E204"


class BadCount(FormatError):
    """A declared count is not a number, negative, or more than the file can hold."""

    code = "E205"


class BadPolygon(FormatError):
    """A face of fewer than three corners, or of more than its line holds."""

    code = "E206"


class BadToken(FormatError):
    """A word that is not a plain decimal number where one is expected."""

    code = "E207"


class LineTooLong(FormatError):
    """A line of a text file is longer than the limit."""

    code = "E208"


class BadContainer(FormatError):
    """A GLB, VTP or GIFTI file whose parts disagree, or are compressed in a way that is not supported."""

    code = "E209"


class InflatesTooFar(FormatError):
    """Far more comes out of a compressed file, or a part of one, than a mesh takes; it is not unpacked."""

    code = "E221"


class ExternalReference(FormatError):
    """The file refers to another file; no other file is ever opened."""

    code = "E222"


class WouldExceedMemory(_Coded, MemoryError):
    """A table larger than the free memory; the message says how large it is and what to do instead."""

    code = "E501"


class BadArgument(_Coded, ValueError):
    """An argument with a value that it cannot have, or two that contradict each other; the message says what can be."""

    code = "E604"


class MissingExtra(_Coded, ImportError):
    """An optional dependency is not installed; the message names the extra."""

    code = "E602"


class SingularMatrix(_Coded, RuntimeError):
    """A linear system has no unique solution, however little of it is rounding: vertices coincide or lie on lines."""

    code = "E404"


class EigensolverFailed(_Coded, RuntimeError):
    """The eigenvalue iteration did not converge, or the matrix could not be factorised."""

    code = "E402"
