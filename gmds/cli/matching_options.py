"""The options of matching, and what `match` makes of them: the same in every command that matches."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import click

from gmds.cli.choices import LOSSES, PARTS, chosen_distance, chosen_loss, distance_option, metric_option
from gmds.cli.output import seed_option

orientation_option = click.option(
    "--orientation",
    type=click.Choice(["preserve", "reverse", "any", "auto"]),
    default="preserve",
    show_default=True,
    help="What the map does to left and right; auto reverses it where that is far likelier, any where it is likelier.",
)
OPTIONS = (
    click.option("--samples", type=int, help="How many samples the embedding places.  [default: 300]"),
    orientation_option,
    click.option(
        "--parts",
        type=click.Choice(PARTS),
        default="auto",
        show_default=True,
        help="Which is a part of what the other one is; auto looks into it for meshes with a boundary.",
    ),
    metric_option,
    distance_option,
    click.option(
        "--loss",
        type=click.Choice(LOSSES),
        default="least-squares",
        show_default=True,
        help="How the misfit of distances is added up.",
    ),
    seed_option,
)
NAMES = ("samples", "orientation", "parts", "metric", "distance", "loss", "seed")


def matching_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Adds all of them to a command."""
    for option in reversed(OPTIONS):
        command = option(command)
    return command


def matching_arguments(options: Mapping[str, Any]) -> dict[str, Any]:
    """The keywords of `match` that these options stand for."""
    return {
        "distance": chosen_distance(options["metric"], options["distance"]),
        "loss": chosen_loss(options["loss"]),
        "n_samples": options["samples"],
        "orientation": options["orientation"],
        "parts": options["parts"],
        "rng": options["seed"],
    }
