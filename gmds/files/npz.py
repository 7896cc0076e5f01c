"""Arrays in untrusted .npy and .npz files: nothing is unpickled, and a header is checked before its bytes are read."""

from __future__ import annotations

import contextlib
import errno
import math
import os
import stat
import warnings
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

PLAIN = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
LARGEST = 8 << 30  # bytes of one array, however small it is packed: a bound, 10^9 numbers
DAMAGED = (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, OSError, ValueError, KeyError, MemoryError)
"""What `zipfile` and `numpy` raise on bytes that were damaged."""


class PickledArray(ValueError):
    """The array holds pickled objects."""


@contextlib.contextmanager
def opened(path: Path) -> Iterator[IO[bytes]]:
    """A regular file; `OSError` for anything else, as opening a pipe would wait for ever."""
    if not stat.S_ISREG(os.stat(path).st_mode):
        raise OSError(errno.EINVAL, "it is not a regular file", str(path))
    with path.open("rb") as stream:
        yield stream


def read_npy(path: Path) -> NDArray[Any]:
    """The array in a .npy file. Raises `ValueError` when it is damaged or pickled, `OSError` when it is not there."""
    with opened(path) as stream:
        return read_array(stream, os.fstat(stream.fileno()).st_size)


def read_npz(path: Path) -> dict[str, NDArray[Any]]:
    """All arrays of a .npz file, by name. Raises `ValueError` when it is damaged, `OSError` when it is not there."""
    with opened(path) as stream:
        try:
            with zipfile.ZipFile(stream) as archive:
                names = archive.namelist()
                if len(set(names)) < len(names) or not all(name.endswith(".npy") for name in names):
                    raise ValueError("members must be arrays, each with a name of its own")
                return {name.removesuffix(".npy"): read_member(archive, name) for name in names}
        except PickledArray:
            raise
        except DAMAGED as error:
            raise ValueError(f"no whole .npz archive ({error})") from error


def read_member(archive: zipfile.ZipFile, name: str) -> NDArray[Any]:
    """One array of an open archive. Raises `ValueError`, or what `zipfile` does, when it is damaged."""
    member = archive.getinfo(name)
    if member.compress_type not in PLAIN:
        raise ValueError(f"{name} is packed by another method than deflation")
    with archive.open(member) as stream:
        return read_array(stream, member.file_size)


def read_array(stream: IO[bytes], n_bytes: int) -> NDArray[Any]:
    """The array in an open .npy stream of `n_bytes`, its header checked before any of its bytes are taken.

    Raises `ValueError` when they do not agree, `PickledArray` for objects.
    """
    shape, fortran, dtype = read_header(stream)
    size = math.prod(shape) * dtype.itemsize
    if size > min(n_bytes, LARGEST):
        raise ValueError(f"the header declares {size} bytes, more than the {min(n_bytes, LARGEST)} there may be")
    content = stream.read(size + 1)
    if len(content) != size:
        raise ValueError(f"{len(content)} bytes where the header declares {size}")
    flat = np.frombuffer(content, dtype=dtype) if size else np.empty(0, dtype=dtype)
    return flat.reshape(shape, order="F" if fortran else "C")


def read_header(stream: IO[bytes]) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Shape, order and dtype of the array in a .npy stream. Raises `ValueError`, `PickledArray` for objects."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # headers of Python 2, and what the parser thinks of damaged ones
            major, _ = np.lib.format.read_magic(stream)
            read = np.lib.format.read_array_header_1_0 if major == 1 else np.lib.format.read_array_header_2_0
            shape, fortran, dtype = read(stream)
    except Exception as error:  # the parser of numpy raises a dozen different types
        raise ValueError(f"no readable header of an array ({error})") from error
    if dtype.hasobject:
        raise PickledArray("pickled objects, which are never loaded")
    if any(length < 0 for length in shape):
        raise ValueError(f"a header with a negative length, {shape}")
    return shape, fortran, dtype
