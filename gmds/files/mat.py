"""Untrusted MATLAB files, read in a process of their own: damaged ones can crash the process that reads them."""

from __future__ import annotations

import functools
import io
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gmds.files.npz import opened

SECONDS = 60  # of wall time that reading may take: a bound, as damaged files can make it endless
READ = """
import io, sys, warnings
import numpy, scipy.io
warnings.simplefilter("error")
content = scipy.io.loadmat(sys.argv[1], variable_names=sys.argv[2:])
arrays = {name: content[name] for name in sys.argv[2:]}
assert all(array.dtype.kind in "biuf" for array in arrays.values()), "only numbers are read"
file = io.BytesIO()
numpy.savez(file, **arrays)
sys.stdout.buffer.write(file.getvalue())
"""


def read_mat(path: Path, *names: str) -> Mapping[str, NDArray[Any]]:
    """Arrays of numbers, by name. Raises `ValueError` when the file is damaged, `OSError` when it is not there."""
    with opened(path) as stream:
        status = os.fstat(stream.fileno())
    return _read(path.absolute(), names, (status.st_mtime_ns, status.st_size))


@functools.lru_cache(maxsize=256)
def _read(path: Path, names: tuple[str, ...], version: tuple[int, int]) -> Mapping[str, NDArray[Any]]:
    """As `read_mat`; a file is read again when it has changed."""
    command = [sys.executable, "-P", "-c", READ, str(path), *names]
    try:
        done = subprocess.run(command, capture_output=True, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired as error:
        raise ValueError(f"reading it was given up after {SECONDS} s") from error
    if done.returncode:
        said = done.stderr.decode(errors="replace").strip().splitlines()
        raise ValueError(f"reading it ended with {said[-1] if said else f'signal {-done.returncode}'}")
    with np.load(io.BytesIO(done.stdout), allow_pickle=False) as arrays:
        return dict(arrays)
