"""Files named on the command line: refused before anything is computed, not when the work is done."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any

import click

from gmds.cli.output import note

ATLAS = "atlas.npz"  # as `gmds atlas` names it
COMPANIONS = {".obj": (".mtl", ".png"), ".vert": (".tri",), ".tri": (".vert",)}  # endings of files of one mesh


class OutputFile(click.Path):
    """A path in a folder that can be written to."""

    written = True

    def __init__(self) -> None:
        super().__init__(dir_okay=False, path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The path; a usage error that names it when it is a folder, or in none, or in one that is read-only."""
        path = Path(os.fsdecode(super().convert(value, param, ctx)))
        if not path.parent.is_dir():
            self.fail(f"there is no folder {str(path.parent)!r} for {path.name!r}", param, ctx)
        if self.written and (why := _not_writable(path)):
            self.fail(f"{path.name!r} cannot be written to the folder {str(path.parent)!r}: {why}", param, ctx)
        return path


class OutputFolder(click.Path):
    """A folder that can be written to, or be made."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The path; a usage error that names it when it is a file, or in one, or nothing can be written there."""
        path = Path(os.fsdecode(super().convert(value, param, ctx)))
        there = next((one for one in (path, *path.absolute().parents) if one.exists()), Path())
        if not there.is_dir():
            self.fail(f"{str(path)!r} can be no folder: {str(there)!r} is a file", param, ctx)
        if why := _not_writable(there / "any"):
            self.fail(f"nothing can be written to the folder {str(there)!r}: {why}", param, ctx)
        return path


class AtlasFile(click.Path):
    """The file of an atlas, or the folder that `gmds atlas` wrote it to."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The path of the file; of a folder the atlas.npz in it, where there is one."""
        path = Path(os.fsdecode(super().convert(value, param, ctx)))
        return path / ATLAS if (path / ATLAS).is_file() else path


class EndingIn(OutputFile):
    """A path whose ending says the format; "" among the endings lets pass what has none. `written`: or only read."""

    def __init__(self, *endings: str, written: bool = True) -> None:
        super().__init__()
        self.endings, self.written = endings, written

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The path; a usage error that names it when its ending is none of the endings."""
        path = super().convert(value, param, ctx)
        if path.suffix.lower() not in self.endings:
            self.fail(f"{str(path)!r} must end in {' or '.join(filter(None, self.endings))}", param, ctx)
        return path


def refuse_same_folder(read: Path, output: Path, name: str) -> None:
    """A usage error when a folder of outputs is one that is read, in which `name` would be lost or taken for input."""
    if _identity(read) == _identity(output):
        raise click.UsageError(f"-o {str(output)!r} is where input is read from, beside {name}; name another folder")


def tell_inner_folders(folder: Path, output: Path) -> None:
    """A line on stderr for folders with meshes in a folder that is read: what is in them is not."""
    from gmds.files.folders import inner_folders

    inner = inner_folders(folder) if folder.is_dir() else []
    if names := [path.name for path in inner if _identity(path) != _identity(output)]:
        note(f"gmds: folders in {folder} are not read: {', '.join(names[:10])}{', ...' if len(names) > 10 else ''}")


def refuse_collisions(ctx: click.Context) -> None:
    """A usage error when two outputs are one file, or an output is a file that is read."""
    taken: dict[str, str] = {}
    read = {_identity(path): path for param, path in _paths(ctx) if not _is_output(param)}
    for param, path in _paths(ctx):
        if not _is_output(param) or _is_device(path):
            continue
        name, place = param.opts[-1], _identity(path)
        if place in taken:
            raise click.UsageError(f"{taken[place]} and {name} both write {str(path)!r}; give one another name", ctx)
        place = next((one for one in map(_identity, _companions(path)) if one in read), place)
        if place in read:
            raise click.UsageError(f"{name} would overwrite {str(read[place])!r}, which is read; name another", ctx)
        taken[place] = name


def _companions(path: Path) -> list[Path]:
    """The file, and those that are written with it or may be."""
    return [path, *(path.with_suffix(ending) for ending in COMPANIONS.get(path.suffix.lower(), ()))]


def _paths(ctx: click.Context) -> list[tuple[click.Parameter, Path]]:
    found = []
    for param in ctx.command.params:
        given = ctx.params.get(param.name or "")
        found += [(param, one) for one in (given if isinstance(given, tuple) else (given,)) if isinstance(one, Path)]
    return found


def _is_output(param: click.Parameter) -> bool:
    return isinstance(param.type, OutputFile) and param.type.written


def _is_device(path: Path) -> bool:
    return path.exists() and not path.is_file()


def _identity(path: Path) -> str:
    """What two names of one file share, links resolved."""
    if path.is_file():
        about = path.stat()
        return f"{about.st_dev}:{about.st_ino}"
    return os.path.realpath(path)


def _not_writable(path: Path) -> str:
    """Why no file can be made in its folder, in the words of the system; empty when one can, or none is needed."""
    if _is_device(path):
        return ""
    try:
        with tempfile.TemporaryFile(dir=path.parent, prefix=".gmds-", suffix=".tmp"):
            return ""
    except OSError as error:
        return error.strerror or str(error)
