"""One run at a time in a folder, and what several may share."""

from __future__ import annotations

import contextlib
import os
import socket
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from gmds.errors import FolderInUse

NAME = ".lock"
LEFT_OVER = (".gmds-*.tmp", ".*.late")  # by processes that were killed


@contextlib.contextmanager
def only_run(folder: Path) -> Iterator[None]:
    """The block, while no other run is inside one for the same folder; `FolderInUse` (E503) at once if one is.

    The system frees the lock when the process ends, however it ends: nothing is ever left behind that has to be removed
    by hand. On a network drive it holds between machines if the drive has locks at all; if not, that is an `OSError`.
    """
    with (folder / NAME).open("a+", encoding="utf-8") as file:
        try:
            _lock(file)
        except (BlockingIOError, PermissionError) as error:
            file.seek(0)
            who = file.read(200).strip() or "another process"
            raise FolderInUse(f"{who} is at work in {folder}; wait for it, or choose another folder") from error
        file.truncate(0)
        file.write(f"process {os.getpid()} on {socket.gethostname()}, since {time.strftime('%Y-%m-%d %H:%M:%S')},")
        file.flush()
        yield


@contextlib.contextmanager
def cleared(folder: Path) -> Iterator[None]:
    """The block, while other runs see that this folder is in use; if none was in it, without what killed ones left.

    Several runs may share a folder, each by a symbolic link of its own. The system frees it when the process ends.
    Where it has no locks of folders, as on some network drives, nothing is removed.
    """
    if sys.platform == "win32":  # where files that are being written cannot be removed anyway
        _clear(folder)
        yield
        return
    import fcntl

    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with contextlib.suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            _clear(folder)
        with contextlib.suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_SH)  # waits for a run that is just clearing
        yield
    finally:
        os.close(descriptor)


def _clear(folder: Path) -> None:
    for left in (path for kind in LEFT_OVER for path in folder.glob(kind)):
        with contextlib.suppress(FileNotFoundError, PermissionError):
            left.unlink()


def _lock(file: IO[str]) -> None:
    if sys.platform == "win32":  # bytes far behind the text, which others are to read
        import msvcrt

        file.seek(1 << 20)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
