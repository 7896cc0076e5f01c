"""gmds completion: names of commands and options, by the tabulator key."""

from __future__ import annotations

import click

from gmds.cli.group import Command


@click.command(cls=Command, short_help="Print what a shell needs to complete names.")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
def command(shell: str) -> None:
    """Print the script that lets SHELL complete the names of commands, options and files.

    \b
      gmds completion bash > ~/.local/share/bash-completion/completions/gmds
      gmds completion zsh > ~/.zfunc/_gmds
      gmds completion fish > ~/.config/fish/completions/gmds.fish

    It takes effect in a new shell. bash must be 4.4 or later; for zsh the folder has to be in `fpath`.
    """
    from click.shell_completion import get_completion_class

    from gmds.cli import main

    scripts = get_completion_class(shell)
    if scripts is None:  # what is offered is what click knows
        raise click.UsageError(f"no completion for {shell}")
    click.echo(scripts(main, {}, "gmds", "_GMDS_COMPLETE").source())
