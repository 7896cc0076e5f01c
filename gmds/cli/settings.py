"""Settings in a file: `--config` reads them, `--dump-config` writes them; a map holds those it was made with."""

from __future__ import annotations

import importlib
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, cast

import click

from gmds.cli.group import Command
from gmds.cli.matching_options import NAMES

SHARED = "matching"  # the table of what all these commands take; their own options are in a table of their name
COMMANDS = ("match", "batch", "benchmark")
TABLES = (SHARED, *COMMANDS)
NO_SETTINGS = ("config", "dump-config", "debug", "json", "help")
LARGEST = 1_000_000  # bytes of a file of settings: a bound, far above what people write
Tables = dict[str, dict[str, Any]]


class ConfiguredCommand(Command):
    """A command that takes `--config` and `--dump-config`; what it needs may be in the file as well."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.needed = [param for param in self.params if param.required]
        for param in self.needed:
            param.metavar, param.required = (param.name or "").upper(), False
        self.params[-1:-1] = [_config_option(), _dump_option()]

    def invoke(self, ctx: click.Context) -> Any:
        """Run, or print the settings that it would run with."""
        if ctx.meta.get(__name__):
            click.echo(_as_toml(self, ctx), nl=False)
            return None
        for param in self.needed:
            if ctx.params[param.name or ""] is None:
                raise click.MissingParameter(ctx=ctx, param=param)
        return super().invoke(ctx)

    def settings(self) -> Iterator[tuple[str, str, click.Parameter]]:
        """Table, key and parameter of everything that can be set."""
        for param in self.params:
            key = _key(param)
            if key not in NO_SETTINGS:
                yield (SHARED if param.name in NAMES else str(self.name), key, param)


def read_settings(path: Path) -> Tables:
    """What is set in a file, checked: keys by table, with values as the command line has them.

    The file is .toml, or a map, which holds the settings it was made with. Raises `UnknownKey` (E601) with the nearest
    name, `BadSetting` (E603) naming the key, `FormatError` for a damaged map, `OSError`.
    """
    from gmds.suggestions import check_keys

    content = _of_map(path) if path.suffix.lower() == ".npz" else _parsed(path)
    check_keys(content, TABLES, f"{path}")
    known = {name: dict(_params_of(name)) for name in TABLES}
    for table, values in content.items():
        if not isinstance(values, Mapping):
            _refuse(path, table, f"must be a table of settings, [{table}], not {values!r:.40}")
        check_keys(values, known[table], f"{path}, table [{table}],")
        for key, value in values.items():
            _check(path, f"{table}.{key}", known[table][key], value)
    return content


def _of_map(path: Path) -> Tables:
    from gmds.cli.map_settings import map_settings

    return map_settings(path)


def _parsed(path: Path) -> Tables:
    from gmds.errors import BadSetting
    from gmds.files.text import read_text

    try:
        return tomllib.loads(read_text(path, BadSetting, LARGEST))
    except (ValueError, RecursionError) as error:  # of TOML and of UTF-8
        raise BadSetting(f"{path} is no TOML: {error}") from error


def _params_of(table: str) -> Iterator[tuple[str, click.Parameter]]:
    """Keys and parameters of a table; commands are imported when they are needed."""
    for name in COMMANDS if table == SHARED else (table,):
        for at, key, param in importlib.import_module(f"gmds.cli.commands.{name}").command.settings():
            if at == table:
                yield key, param


def _check(path: Path, name: str, param: click.Parameter, value: Any) -> None:
    """`BadSetting` unless the value is of the type of a parameter, and among those it allows."""
    from gmds.suggestions import did_you_mean

    kind = _kind(param)
    listed = param.multiple if isinstance(param, click.Option) else False
    values = value if listed and isinstance(value, list) else [value]
    for one in values:
        fits = isinstance(one, (int, float) if kind is float else kind) and (kind is bool or not isinstance(one, bool))
        if not fits or (listed and not isinstance(value, list)):
            of = "a list of " if listed else ""
            _refuse(path, name, f"must be {of}{_WORDS[kind]}, not {value!r:.40}")
        if isinstance(param.type, click.Choice) and one not in param.type.choices:
            _refuse(path, name, f"cannot be {one!r:.40}{did_you_mean(one, param.type.choices)}")
        try:
            param.type.convert(one, param, None)
        except click.BadParameter as error:
            _refuse(path, name, f"cannot be {one!r:.40}: {error.message}")


_WORDS: dict[type, str] = {bool: "true or false", int: "a whole number", float: "a number", str: "text in quotes"}


def _kind(param: click.Parameter) -> type:
    kinds: dict[type, type] = {click.types.BoolParamType: bool, click.types.IntParamType: int}
    kinds |= {click.types.FloatParamType: float}
    return next((plain for kind, plain in kinds.items() if isinstance(param.type, kind)), str)


def _refuse(path: Path, key: str, why: str) -> None:
    from gmds.errors import BadSetting

    raise BadSetting(f"{path}: {key} {why}")


def _key(param: click.Parameter) -> str:
    """The name of a setting: that of the option on the command line."""
    name = max(param.opts, key=len)
    return name.replace("_", "-") if isinstance(param, click.Argument) else name.lstrip("-")


def _config_option() -> click.Option:
    def load(ctx: click.Context, _: click.Parameter, path: Path | None) -> None:
        if path is None:
            return
        found, command = read_settings(path), cast(ConfiguredCommand, ctx.command)
        values = {param.name: found.get(table, {}).get(key) for table, key, param in command.settings()}
        ctx.default_map = {str(name): value for name, value in values.items() if value is not None}

    return click.Option(
        ["--config"],
        type=click.Path(path_type=Path),
        is_eager=True,
        expose_value=False,
        callback=load,
        help="Settings from a .toml file, or those of a map; what else is given comes first.",
    )


def _dump_option() -> click.Option:
    def ask(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
        ctx.meta[__name__] = wanted

    return click.Option(
        ["--dump-config"],
        is_flag=True,
        expose_value=False,
        callback=ask,
        help="Print all settings as .toml for --config, and do nothing.",
    )


def _as_toml(command: ConfiguredCommand, ctx: click.Context) -> str:
    """All settings in force; TOML has no word for what is not set, so these are named in a comment."""
    import tomli_w

    from gmds._version import __version__

    tables: Tables = {SHARED: {}, str(command.name): {}}
    unset = []
    for table, key, param in command.settings():
        value = ctx.params[param.name or ""]
        if value is None:
            unset.append(f"{table}.{key}")
        else:
            tables[table][key] = _plain(value)
    head = f"# gmds {__version__} {command.name}\n"
    head += f"# not set: {', '.join(unset)}\n" if unset else ""
    return head + "\n" + tomli_w.dumps(tables)


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(one) for one in value]
    return str(value) if isinstance(value, Path) else value
