"""A time limit for a pair, kept by the process that works on it."""

from __future__ import annotations

import contextlib
import faulthandler
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from gmds.errors import PairTimeout

GRACE = 5.0  # seconds, beyond half the limit, after which the process is ended; set by hand, for short limits


@contextlib.contextmanager
def deadline(seconds: float | None, path: Path) -> Iterator[Callable[[str, float], None] | None]:
    """A progress function that raises `PairTimeout` (E504) when `seconds` have passed, None for no limit.

    Code that reports no progress cannot be stopped that way. When half the limit and `GRACE` seconds more have passed,
    a thread without Python in it ends the process and leaves a mark beside `path`; a scheduler sees that the worker
    died and sends the pair to another one, which finds the mark and raises `PairTimeout` at once.
    """
    if seconds is None:
        yield None
        return
    mark = path.with_name(f".{path.stem}.late")
    if mark.exists() and mark.stat().st_size:
        mark.unlink(missing_ok=True)
        raise PairTimeout(_sentence(seconds))
    end = time.monotonic() + seconds

    def progress(stage: str, fraction: float) -> None:
        if time.monotonic() > end:
            raise PairTimeout(_sentence(seconds))

    with mark.open("w") as stream:
        faulthandler.dump_traceback_later(1.5 * seconds + GRACE, exit=True, file=stream)
        try:
            yield progress
        finally:
            faulthandler.cancel_dump_traceback_later()
            mark.unlink(missing_ok=True)


def _sentence(seconds: float) -> str:
    return f"not done after {seconds:g} seconds"
