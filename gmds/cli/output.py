"""What commands say: results on stdout, progress on stderr."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

Progress = Callable[[str, float], None]

LOG_EVERY = 10.0  # seconds between two lines of a log, so that hours fill no disk; set by hand
COMPILING = "compiling, this once"

json_option = click.option("--json", "as_json", is_flag=True, help="Print the results as JSON.")
seed_option = click.option("--seed", default=0, show_default=True, help="Seed of everything random.")


def emit(result: Mapping[str, Any], as_json: bool) -> None:
    """Print a result on stdout: JSON, or one `name: value` a line, and an entry a line of what is a table."""
    if as_json:
        click.echo(json.dumps(_finite(result), indent=2, allow_nan=False))
        return
    width = max((len(name) for name in result), default=0)
    for name, value in result.items():
        for i, line in enumerate(_lines(value)):
            click.echo(f"{'' if i else name + ':':<{width + 1}} {line}")


def _finite(value: Any) -> Any:
    """The same with None, the null of JSON, for numbers that it has none for."""
    if isinstance(value, Mapping):
        return {name: _finite(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def note(message: str) -> None:
    """One line on stderr."""
    click.echo(message, err=True)


def valid_count(answer: Any, as_json: bool) -> dict[str, Any]:
    """How many vertices of the source have a counterpart, of how many."""
    valid, vertices = int(answer.valid.sum()), len(answer.valid)
    return {"valid": valid, "vertices": vertices} if as_json else {"valid": f"{valid} of {vertices}"}


def known(values: Iterable[float]) -> list[float | None]:
    """Numbers as JSON can carry them: None for NaN."""
    return [None if value != value else float(value) for value in values]


def tell_written(path: Path, why: str) -> None:
    """Name a picture that was written, and say `why` it was drawn otherwise than it should be, if it was."""
    note(f"wrote {path}")
    if why:
        note(why)


class _Log:
    """Progress as lines on stderr, where that is no terminal: the first at once, the others not too often."""

    def __init__(self, title: str) -> None:
        self.title, self.started, self.told = title, time.monotonic(), -LOG_EVERY

    def __call__(self, stage: str, fraction: float) -> None:
        passed = time.monotonic() - self.started
        if passed >= self.told + LOG_EVERY or fraction >= 1:
            self.told = passed
            note(f"{self.title}: {stage}, {100 * min(max(fraction, 0.0), 1.0):.0f} %, after {passed:.0f} s")


@contextmanager
def progress_bar(title: str, *, remaining: bool = False) -> Iterator[Progress]:
    """A bar on stderr, moved by the function the block gets; it shows where stderr is a terminal.

    `remaining` is for work of hours: where stderr is no terminal a line tells of it every `LOG_EVERY` seconds.
    It says so while kernels are being compiled. `remaining`: whether the time that is left is shown as well, as the
    speed of the last half hour foretells it.
    """
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    from geodesics.compiling import reporting_compilation

    console = Console(stderr=True)
    left = (TextColumn("left"), TimeRemainingColumn()) if remaining else ()
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), *left)
    if remaining and not console.is_terminal:
        yield _Log(title)
        return
    with Progress(
        *columns, console=console, transient=True, disable=not console.is_terminal, speed_estimate_period=1800
    ) as bars:
        task, at = bars.add_task(title, total=1.0), title

        def progress(stage: str, fraction: float) -> None:
            nonlocal at
            at = f"{title}: {stage}" if stage else title
            bars.update(task, description=at, completed=min(max(fraction, 0.0), 1.0))

        def compiling(begins: bool) -> None:
            bars.update(task, description=f"{at} ({COMPILING})" if begins else at, refresh=begins)

        with reporting_compilation(compiling):
            yield progress


def _lines(value: Any) -> list[str]:
    """The entries of a list of lists or of mappings, each on its own line; all else on one."""
    if isinstance(value, list | tuple) and any(isinstance(item, Mapping | list | tuple) for item in value):
        return [_plain(item) for item in value]
    return [_plain(value)]


def _plain(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {_plain(item)}" for name, item in value.items())
    if isinstance(value, list | tuple):
        return ", ".join(_plain(item) for item in value) or "none"
    return "-" if value is None else str(value)
