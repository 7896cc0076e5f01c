"""The page and the picture of a map, as commands offer them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from gmds.cli.directions import UP, upwards
from gmds.cli.fields import PICTURES
from gmds.cli.output import note, tell_written
from gmds.cli.paths import EndingIn, OutputFile

FILE = click.Path(path_type=Path)

report_option = click.option("--report", type=OutputFile(), help="Write a page to turn both surfaces in a browser.")
picture_option = click.option(
    "--picture", type=EndingIn(*PICTURES), help="Draw both surfaces: .png, .jpg, .svg or .pdf."
)
show_option = click.option(
    "--show",
    type=click.Choice(["doubt", "growth"]),
    default="doubt",
    show_default=True,
    help="What the third view of the picture shows: doubt, or how much lengths grew, as a logarithm.",
)
up_option = click.option(
    "--up", type=click.Choice(list(UP)), help="Axis of the meshes that is shown as up; y for .obj and .glb, else z."
)


def view_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options --report, --picture, --show and --up."""
    return report_option(picture_option(show_option(up_option(command))))


def write_views(
    answer: Any,
    report: Path | None,
    picture: Path | None,
    errors: Any = None,
    *,
    title: str,
    names: tuple[str, str],
    up: str | None = None,
    show: str = "doubt",
) -> None:
    """The page and the picture that were asked for; each written file is named on stderr.

    `errors`, `title` and `names` are those of `gmds.report.write_report`; the picture shows the errors of the best map.
    """
    axis = upwards(up, names[0])
    if report is not None:
        from gmds.report.page import write_report

        write_report(report, answer, errors, title=title, names=names, up=axis)
        note(f"wrote {report}")
    if picture is not None:
        from gmds.pictures.panels import write_picture

        first = None if errors is None or show != "doubt" else errors[0]
        told = write_picture(picture, answer, first, title=title, names=names, up=axis, show=show)
        tell_written(picture, told)
