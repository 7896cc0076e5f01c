"""The command line; each command is a module of its own, imported when it is asked for."""

from __future__ import annotations

from gmds.cli.group import LazyGroup

main = LazyGroup(
    "gmds",
    help="Find which point of one surface is which point of another, whatever their poses and sizes.",
    commands_in="gmds.cli",
    command_names=(
        "demo",
        "match",
        "batch",
        "landmarks",
        "evaluate",
        "compare",
        "symmetry",
        "transfer",
        "distances",
        "voronoi",
        "signatures",
        "deform",
        "retrieve",
        "check",
        "repair",
        "benchmark",
        "export",
        "doctor",
        "warmup",
    ),
)
