"""Blocks of LZ4, as VTK compresses arrays with them: copies of letters and of what came before."""

from __future__ import annotations

LONG, SHORTEST = 15, 4  # a length that goes on in bytes behind, and the shortest match (LZ4 block format, 1.6.3)


def unpacked_block(data: bytes, size: int) -> bytes:
    """What a block of LZ4 stands for, `size` bytes at most; `ValueError` for one that is cut off or damaged."""
    found, at, n = bytearray(), 0, len(data)
    while at < n:
        token = data[at]
        length, at = _length(data, at + 1, token >> 4)
        if at + length > n:
            raise ValueError("letters are missing")
        found += data[at : at + length]
        at += length
        if len(found) > size:
            raise ValueError(f"more than {size} bytes come out of it")
        if at == n:
            return bytes(found)  # the last sequence has no match
        back = int.from_bytes(data[at : at + 2], "little")
        length, at = _length(data, at + 2, token & 15)
        length += SHORTEST
        if not 0 < back <= len(found) or len(found) + length > size:
            raise ValueError("a match lies outside the block")
        _copy(found, back, length)
    raise ValueError("it ends in a match")


def _length(data: bytes, at: int, start: int) -> tuple[int, int]:
    """A length, and the byte behind it."""
    if start == LONG:
        while True:
            if at >= len(data):
                raise ValueError("a length is missing")
            start += data[at]
            at += 1
            if data[at - 1] != 255:
                break
    return start, at


def _copy(found: bytearray, back: int, length: int) -> None:
    """Append what lies `back` bytes before, over and over where that is shorter than `length`."""
    piece = bytes(found[-back:][:length])
    found += (piece * -(-length // len(piece)))[:length]
