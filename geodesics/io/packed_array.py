"""Arrays of numbers in XML files of VTK: a header of lengths, then bytes, in blocks where they are compressed."""

from __future__ import annotations

import base64
import binascii
import lzma
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geodesics.errors import BadContainer, InflatesTooFar, TruncatedFile
from geodesics.io.lz4 import unpacked_block
from geodesics.io.opening import SMALL_WHEN_INFLATED

LARGEST_RATIO = 1032  # what a byte of deflate can become at most, by its format

_INFLATE: dict[str, Callable[[bytes, int], bytes]] = {
    "vtkZLibDataCompressor": lambda block, size: zlib.decompressobj().decompress(block, size),
    "vtkLZMADataCompressor": lambda block, size: lzma.LZMADecompressor().decompress(block, size),
    "vtkLZ4DataCompressor": unpacked_block,
}


@dataclass(frozen=True)
class Packing:
    """How a file packs its arrays: byte order ("<" or ">"), bytes of a length, and the class that compresses."""

    order: str
    header: int
    compressor: str


def unpacked(content: bytes, at: int, raw: bool, dtype: np.dtype, packing: Packing, path: Path) -> NDArray[np.generic]:
    """The array that begins at a place of `content`, which is raw bytes or base64."""
    if packing.compressor and packing.compressor not in _INFLATE:
        raise BadContainer(
            f"{path}: arrays are compressed by {packing.compressor[:40]!r}; save them with zlib, or uncompressed"
        )
    source = _Source(content[at:], raw, path)
    if not packing.compressor:
        (length,) = _lengths(source.take(packing.header, 0), 1, packing, path)
        body = source.take(length, packing.header, together=True)
    else:
        body = _inflated(source, packing, path)
    if len(body) % dtype.itemsize:
        raise TruncatedFile(f"{path}: an array of {len(body)} bytes is not made of numbers of {dtype.itemsize}")
    return np.frombuffer(body, dtype)


@dataclass(frozen=True)
class _Source:
    content: bytes
    raw: bool
    path: Path

    def take(self, size: int, behind: int, *, together: bool = False) -> bytes:
        """`size` bytes behind others; in base64 those are a text of their own, unless both are coded together."""
        if size > len(self.content):  # bytes of base64 are more than what they stand for
            raise TruncatedFile(f"{self.path}: {size} bytes of an array are declared, more than the file has")
        if self.raw:
            found = self.content[behind : behind + size]
        else:
            start = 0 if together else _coded(behind)
            found = self._decoded(start, _coded(size + (behind if together else 0)))[behind if together else 0 :][:size]
        if len(found) < size:
            raise TruncatedFile(f"{self.path}: {size} bytes of an array are declared, {len(found)} are there")
        return found

    def _decoded(self, start: int, length: int) -> bytes:
        try:
            return base64.b64decode(self.content[start : start + length], validate=True)
        except (binascii.Error, ValueError) as error:
            raise TruncatedFile(f"{self.path}: base64 is cut off or damaged ({error})") from error


def _coded(size: int) -> int:
    """How many letters of base64 stand for so many bytes."""
    return 4 * -(-size // 3)


def _lengths(header: bytes, n: int, packing: Packing, path: Path) -> list[int]:
    found = np.frombuffer(header, f"{packing.order}u{packing.header}", n).tolist()
    if max(found, default=0) >= 2**62:
        raise TruncatedFile(f"{path}: an array declares {max(found)} bytes")
    return [int(length) for length in found]


def _inflated(source: _Source, packing: Packing, path: Path) -> bytes:
    """Blocks of a compressed array: their number, their size, that of the last, then the compressed size of each."""
    step = packing.header
    n, size, last = _lengths(source.take(3 * step, 0), 3, packing, path)
    if n == 0:
        return b""
    header = source.take((3 + n) * step, 0)
    packed = _lengths(header, 3 + n, packing, path)[3:]
    body = source.take(sum(packed), len(header))
    if n * size > max(LARGEST_RATIO * len(body), SMALL_WHEN_INFLATED):
        raise InflatesTooFar(f"{path}: {n * size} bytes are to come out of {len(body)}; the file is damaged")
    blocks, at = [], 0
    for number, length in enumerate(packed):
        wanted = last if last and number == n - 1 else size
        try:
            block = _INFLATE[packing.compressor](body[at : at + length], wanted)
        except (zlib.error, lzma.LZMAError, EOFError, ValueError) as error:
            raise TruncatedFile(f"{path}: block {number} of an array cannot be unpacked ({error})") from error
        if len(block) != wanted:
            raise TruncatedFile(f"{path}: block {number} of an array has {len(block)} bytes, {wanted} are declared")
        blocks.append(block)
        at += length
    return b"".join(blocks)
