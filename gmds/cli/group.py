"""A click group that imports its commands when they are needed and turns errors into exit codes."""

from __future__ import annotations

import errno
import importlib
import os
import signal
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from pathlib import Path
from typing import Any, NoReturn

import click

UNREADABLE, NOT_WRITTEN = "E202", "E502"  # of files, as in the records of a batch
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EIO)
BAD_INPUT, UNFINISHED, INTERRUPTED = 1, 3, 130  # exit codes; click's own is 2, and a shell's after Ctrl-C 128 + 2


class Command(click.Command):
    """A command that takes `--debug`, wherever it stands."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.params.append(_debug_option())

    def invoke(self, ctx: click.Context) -> Any:
        """Run, unless one file would be lost to another."""
        from gmds.cli.paths import refuse_collisions

        refuse_collisions(ctx)
        return super().invoke(ctx)


class LazyGroup(click.Group):
    """Commands live in modules named after them, below `commands_in`, as `command`; `sections` are for the help.

    Exit codes: 0 done, 1 bad mesh or file, 2 wrong usage, 3 a batch finished with failures, 130 interrupted.
    Errors are one line on stderr; `--debug` shows the traceback.
    """

    def __init__(self, name: str, *, commands_in: str, sections: Mapping[str, Sequence[str]], **kwargs: Any) -> None:
        super().__init__(name, context_settings={"help_option_names": ["-h", "--help"]}, **kwargs)
        self.params += [_version_option(), _debug_option()]
        self.commands_in, self.sections = commands_in, dict(sections)
        self.command_names = tuple(name for names in sections.values() for name in names)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.command_names)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in self.command_names:
            return None
        command: click.Command = importlib.import_module(f"{self.commands_in}.{cmd_name}").command
        return command

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        if args and not args[0].startswith("-") and args[0] not in self.command_names:
            ctx.fail(_no_such_command(args, self.command_names))
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        longest = max(map(len, self.command_names))  # the columns of all sections stand below each other
        for title, names in self.sections.items():
            commands = [(name, self.get_command(ctx, name)) for name in names]
            with formatter.section(title):
                formatter.write_dl([(f"{name:<{longest}}", c.get_short_help_str(60)) for name, c in commands if c])

    def main(self, args: Sequence[str] | None = None, *_: Any, **extra: Any) -> NoReturn:
        """Run, and end the process with the exit code."""
        arguments = list(sys.argv[1:] if args is None else args)
        extra.pop("standalone_mode", None)
        with _errors_as_exit_codes("--debug" in arguments):
            code = super().main(arguments, standalone_mode=False, **extra)
            sys.stdout.flush()
        sys.exit(code if isinstance(code, int) else 0)


@contextmanager
def _errors_as_exit_codes(debug: bool) -> Iterator[None]:
    previous = _on_terminate(_raise_interrupt)
    try:
        yield
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except (KeyboardInterrupt, click.Abort):
        _fail("interrupted", INTERRUPTED)
    except OSError as error:
        if error.errno == errno.EPIPE:  # the reader of our output has gone: nothing to say, and nobody to say it to
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            sys.exit(BAD_INPUT)
        _fail_or_show(error, debug, _plainly(error))
    except (ValueError, ArithmeticError, ImportError, MemoryError) as error:
        _fail_or_show(error, debug)
    except Exception as error:
        if isinstance(getattr(error, "code", None), str):  # it begins with its code, whatever its kind
            _fail_or_show(error, debug)
        if debug:
            raise
        _fail(f"internal error: {type(error).__name__}: {error} (run again with --debug and report it)", BAD_INPUT)
    finally:
        _on_terminate(previous)


def _fail_or_show(error: BaseException, debug: bool, message: str = "") -> NoReturn:
    if debug:
        raise error
    _fail(message or str(error) or type(error).__name__, BAD_INPUT)


def _plainly(error: OSError) -> str:
    """The file and what is the matter with it, with the code that a batch gives it; nothing where there is no file."""
    if not (error.filename and error.strerror) or isinstance(getattr(error, "code", None), str):
        return ""
    code = NOT_WRITTEN if error.errno in FULL else UNREADABLE
    return f"{code}: {error.filename}: {error.strerror}"


def _no_such_command(args: Sequence[str], known: Sequence[str]) -> str:
    wrong = args[0]
    if Path(wrong).suffix:
        return f"{wrong!r} is no command. For two meshes: gmds match {' '.join(args)}"
    near = get_close_matches(wrong, known, n=2)
    return f"No such command {wrong!r}." + (f" Did you mean {' or '.join(near)}?" if near else "")


def _fail(message: str, code: int) -> NoReturn:
    click.echo(f"gmds: {message}", err=True)
    sys.exit(code)


def _raise_interrupt(*_: object) -> None:
    raise KeyboardInterrupt


def _on_terminate(handler: Any) -> Any:
    """Install a handler for SIGTERM; outside the main thread Python forbids that, and nothing happens."""
    try:
        return signal.signal(signal.SIGTERM, handler)
    except ValueError:
        return None


def _debug_option() -> click.Option:
    return click.Option(["--debug"], is_flag=True, expose_value=False, help="Show the traceback of an error.")


def _version_option() -> click.Option:
    def show(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
        if wanted:
            from gmds._version import __version__

            click.echo(f"gmds {__version__}")
            ctx.exit()

    return click.Option(
        ["--version"], is_flag=True, expose_value=False, is_eager=True, callback=show, help="Show the version."
    )
