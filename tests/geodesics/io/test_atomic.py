"""A file is written completely or not at all; devices and pipes are never replaced."""

from __future__ import annotations

import os
import sys
import threading
from pathlib import Path

import pytest

from geodesics.io import atomic_write


def test_a_new_file_is_there_whole_or_not_at_all(tmp_path: Path) -> None:
    path = tmp_path / "a.bin"
    with atomic_write(path) as stream:
        stream.write(b"one")
        assert not path.exists()
    with pytest.raises(KeyError), atomic_write(path) as stream:
        stream.write(b"two")
        raise KeyError
    assert path.read_bytes() == b"one" and os.listdir(tmp_path) == ["a.bin"]


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"no such folder.*none"), atomic_write(tmp_path / "none" / "a.bin"):
        pass


@pytest.mark.skipif(sys.platform == "win32", reason="pipes with names")
def test_a_pipe_is_written_to_and_stays_a_pipe(tmp_path: Path) -> None:
    """As /dev/null must: replacing that one as root would harm every other program."""
    path, seen = tmp_path / "pipe", []
    os.mkfifo(path)
    reader = threading.Thread(target=lambda: seen.append(path.read_bytes()), daemon=True)
    reader.start()
    with atomic_write(path) as stream:
        stream.write(b"all of it")
    reader.join(10)
    assert seen == [b"all of it"] and path.is_fifo()
