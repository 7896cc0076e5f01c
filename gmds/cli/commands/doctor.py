"""gmds doctor: whether everything is there."""

from __future__ import annotations

import click

from gmds.cli.group import BAD_INPUT, Command
from gmds.cli.output import emit, json_option


@click.command(cls=Command, short_help="Say whether everything gmds needs is there.")
@json_option
@click.pass_context
def command(ctx: click.Context, as_json: bool) -> None:
    """Look at Python, the packages, the optional parts, drawing, threads, and the folder that keeps compiled kernels.

    \b
      gmds doctor
      gmds doctor --json

    Optional parts that are absent are no problem: it is said how to install them and what they are for. A browser is
    needed to look at reports, not to write them. Exit code 1 when there is a problem; send the output of this command
    along with a report of an error.
    """
    from dataclasses import asdict

    from gmds.installation.diagnosis import diagnose

    findings = diagnose()
    problems = [finding.name for finding in findings if finding.state == "problem"]
    if as_json:
        emit({"findings": [asdict(finding) for finding in findings], "problems": problems}, as_json)
    else:
        width = max(len(finding.name) for finding in findings)
        for finding in findings:
            advice = f"  ({finding.advice})" if finding.advice else ""
            click.echo(f"{finding.state:<8} {finding.name:<{width}}  {finding.found}{advice}")
        click.echo(f"problems with {', '.join(problems)}" if problems else "no problems")
    if problems:
        ctx.exit(BAD_INPUT)
