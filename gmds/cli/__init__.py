"""The command line; each command is a module of its own, imported when it is called."""

from __future__ import annotations

from gmds.cli.group import LazyGroup

main = LazyGroup(
    "gmds",
    help="Find which point of one surface is which point of another, whatever their poses and sizes.",
    epilog="Start with `gmds demo`. Each command has examples in its own help: `gmds match --help`.",
    commands_in="gmds.cli.commands",
    sections={
        "Match": ("demo", "match", "batch"),
        "Use and judge maps": ("view", "landmarks", "transfer", "export", "evaluate", "benchmark"),
        "Collections of shapes": ("compare", "retrieve"),
        "From a folder to a study": ("atlas", "model", "groups", "asymmetry", "pseudolandmarks"),
        "One surface": ("check", "repair", "symmetry", "distances", "voronoi", "signatures", "deform"),
        "This installation": ("doctor", "warmup", "completion"),
    },
)
