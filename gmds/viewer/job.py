"""Work that goes on while the page is open: in a thread of its own, with progress, to be stopped."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, TypeVar

Result = TypeVar("Result")
Progress = Callable[[str, float], None]


class Stopped(Exception):
    """Raised where progress is told, when the work is to stop."""


class Job:
    """One piece of work; `state` says how far it is."""

    def __init__(self, work: Callable[[Progress], Result], done: Callable[[Result], int]) -> None:
        self._stage, self._fraction, self._error = "starting", 0.0, ""
        self._number: int | None = None
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(work, done), daemon=True)
        self._thread.start()

    def _run(self, work: Callable[[Progress], Any], done: Callable[[Any], int]) -> None:
        try:
            result = work(self._progress)
            self._progress("drawing", 1.0)
            self._number = done(result)
        except Stopped:
            self._error = "stopped"
        except MemoryError:
            self._error = "there was not enough memory"
        except Exception as error:  # whatever it is, the page tells it and goes on
            self._error = str(error) or type(error).__name__

    def _progress(self, stage: str, fraction: float) -> None:
        if self._stop.is_set():
            raise Stopped
        self._stage, self._fraction = stage, min(max(float(fraction), 0.0), 1.0)

    def stop(self) -> None:
        """Stop as soon as the work tells of its progress."""
        self._stop.set()

    @property
    def running(self) -> bool:
        """Whether it has neither ended nor failed."""
        return self._thread.is_alive()

    @property
    def state(self) -> dict[str, Any]:
        """As the page reads it: `map` is the number of the first new map."""
        running = self.running  # asked first: what is told afterwards is at least as new
        return {
            "running": running,
            "stage": "stopping" if self._stop.is_set() and running else self._stage,
            "fraction": self._fraction,
            "error": "" if running else self._error,
            "map": None if running else self._number,
        }
