"""Data and scripts as a page carries them: small, the same in every run, and free of markup."""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats

KINDS = {"f4", "u1", "u2", "u4"}  # dtypes that unpack.js knows


def packed(text: str) -> str:
    """Text gzipped, in base64."""
    return base64.b64encode(gzip.compress(text.encode("utf-8", "replace"), 9, mtime=0)).decode("ascii")


def packed_data(data: Any) -> str:
    """JSON data with arrays in it, packed; each array becomes {"dtype", "bytes"}, flat and little-endian."""
    return packed(json.dumps(data, default=_array, separators=(",", ":"), allow_nan=False))


def fingerprint_of(script: str) -> str:
    """The source expression by which a Content-Security-Policy allows this very script."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(script.encode('utf-8')).digest()).decode()}'"


def small(numbers: NDArray[Any]) -> NDArray[Any]:
    """Whole numbers >= 0 in as few bytes as the largest of them needs: two or four."""
    return numbers.astype("<u2" if numbers.size == 0 or numbers.max() < 2**16 else "<u4")


def levels(colours: Floats) -> NDArray[np.uint8]:
    """Colours in [0, 1] as bytes."""
    return np.rint(255 * np.asarray(colours).clip(0, 1)).astype(np.uint8)


def _array(value: Any) -> dict[str, str]:
    kind = f"{value.dtype.kind}{value.dtype.itemsize}" if isinstance(value, np.ndarray) else ""
    if kind not in KINDS:
        raise TypeError(f"a page does not carry {type(value).__name__} {kind}".rstrip())
    flat = np.ascontiguousarray(value, dtype=value.dtype.newbyteorder("<"))
    return {"dtype": kind, "bytes": base64.b64encode(flat.tobytes()).decode("ascii")}
