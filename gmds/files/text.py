"""Text files that people write: settings, landmarks, lists of pairs."""

from __future__ import annotations

import errno
from pathlib import Path

from geodesics.io.opening import recoded


def read_text(path: Path, too_large: type[Exception], largest: int) -> str:
    """The content of a UTF-8 file of at most `largest` bytes; one in UTF-16, as spreadsheets write, is read as well.

    Raises `too_large`, `UnicodeDecodeError`, and `OSError` for what is not there or no regular file.
    """
    if path.exists() and not path.is_file():  # opening a pipe would wait for ever
        raise OSError(errno.EINVAL, "it is not a regular file", str(path))
    if path.stat().st_size > largest:
        raise too_large(f"{path} is larger than {largest // 1_000_000} MB")
    return recoded(path.read_bytes()).decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
