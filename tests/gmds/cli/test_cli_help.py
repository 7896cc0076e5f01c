"""Help that helps: sections, examples, suggestions, completion; and which exit code stands for which error."""

from __future__ import annotations

import errno
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import click
import pytest
from click.testing import CliRunner, Result

import geodesics
import gmds
from geodesics.errors import EigensolverFailed, MissingExtra
from gmds.cli import main
from gmds.errors import LandmarkError, MapMismatch, SolverError


def run(*args: str, **options: Any) -> Result:
    return CliRunner().invoke(main, list(args), **options)


def test_every_command_stands_in_one_section() -> None:
    names = [name for section in main.sections.values() for name in section]
    files = Path(gmds.__file__).with_name("cli").joinpath("commands").glob("*.py")
    assert sorted(names) == sorted(p.stem for p in files if "\ndef command(" in p.read_text(encoding="utf-8"))
    text = run("--help").stdout
    assert all(f"\n{title}:\n" in text for title in main.sections)
    rows = [row for row in re.finditer(r"^  (\S+) +", text, re.MULTILINE) if row[1] in names]
    assert len(rows) == len(names) and len({len(row[0]) for row in rows}) == 1  # one below the other


@pytest.mark.parametrize("name", main.command_names)
def test_every_help_has_examples_of_that_command(name: str) -> None:
    text = click.unstyle(run(name, "--help").stdout)
    assert re.search(rf"^ +gmds {name}( |$)", text, re.MULTILINE)


@pytest.mark.parametrize(
    ("args", "hint"),
    [
        (["mtach", "a.ply", "b.ply"], "Did you mean match"),
        (["symetry"], "Did you mean symmetry"),
        (["dog.ply", "wolf.off"], "gmds match dog.ply wolf.off"),
        (["match", "a.ply", "b.ply", "--reprot", "x.html"], "--report"),
        (["match", "a.ply", "b.ply", "--metric", "scale"], "scale-invariant"),
        (["completion", "csh"], "'bash', 'zsh', 'fish'"),
        (["xyzzy"], "No such command 'xyzzy'."),
    ],
)
def test_mistakes_are_told_with_what_was_meant(args: list[str], hint: str) -> None:
    result = run(*args)
    assert result.exit_code == 2
    assert hint in " ".join(result.stderr.split()) and "Traceback" not in result.output


ERRORS = [
    (geodesics.MeshError("face 1 refers outside"), 1, "E100: face 1"),
    (geodesics.FormatError("line 3"), 1, "E200: line 3"),
    (MapMismatch("other meshes"), 1, "E212"),
    (LandmarkError("E301", "no vertex 99"), 1, "E301: no vertex 99"),
    (MissingExtra("pip install 'gmds[viz]'"), 1, "gmds[viz]"),
    (SolverError("no number"), 1, "E403"),
    (FileNotFoundError(errno.ENOENT, "No such file or directory", "dog.ply"), 1, "E202: dog.ply: No such file"),
    (PermissionError(errno.EACCES, "Permission denied", "map.npz"), 1, "E202: map.npz: Permission denied"),
    (OSError(errno.ENOSPC, "No space left on device"), 1, "No space left"),
    (MemoryError(), 1, "MemoryError"),
    (EigensolverFailed("no pairs"), 1, "E402: no pairs"),
    (RuntimeError("a bug"), 1, "internal error: RuntimeError: a bug"),
    (click.UsageError("--from is needed"), 2, "--from is needed"),
    (KeyboardInterrupt(), 130, "interrupted"),
]


@pytest.mark.parametrize(("error", "code", "said"), ERRORS, ids=lambda value: type(value).__name__)
def test_each_class_of_error_has_its_exit_code(
    error: BaseException, code: int, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def raising(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr("gmds.cli.commands.check.command.callback", raising)
    result = run("check", "dog.ply")
    assert (result.exit_code, result.stdout) == (code, "")
    assert said in result.stderr and "Traceback" not in result.stderr
    if code == 1:
        assert len(result.stderr.splitlines()) == 1
        assert run("check", "dog.ply", "--debug").exception is error


def test_the_version() -> None:
    assert run("--version").stdout == f"gmds {gmds.__version__}\n"


@pytest.mark.parametrize(
    ("words", "completed"),
    [("gmds mat", ["match"]), ("gmds match --rep", ["--report"]), ("gmds match --orientation re", ["reverse"])],
)
def test_a_shell_completes(words: str, completed: list[str]) -> None:
    environment = {
        **os.environ,
        "_GMDS_COMPLETE": "bash_complete",
        "COMP_WORDS": words,
        "COMP_CWORD": str(len(words.split()) - 1),
    }
    code = "import sys; sys.argv[0] = 'gmds'; from gmds.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False, timeout=60
    )
    assert [line.split(",")[-1] for line in done.stdout.splitlines()] == completed, done.stderr


@pytest.mark.parametrize("shell", ["zsh", "fish", "bash"])
def test_completion_prints_a_script_for_each_shell(shell: str) -> None:
    result = run("completion", shell)
    if shell == "bash" and "not supported" in result.output:
        pytest.skip("an old bash")
    assert result.exit_code == 0 and f"_GMDS_COMPLETE={shell}_complete" in result.stdout


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["match", "a.off", "b.off", "-o", "none/map.npz"], "there is no folder 'none' for 'map.npz'"),
        (["match", "a.off", "b.off", "-o", "map.csv"], "'map.csv' must end in .npz"),
        (["match", "a.off", "b.off", "-o", "."], "is a directory"),
        (["match", "a.off", "b.off", "--report", "none/page.html"], "there is no folder 'none' for 'page.html'"),
        (["match", "a.off", "b.off", "--picture", "none/map.png"], "there is no folder 'none' for 'map.png'"),
        (["symmetry", "a.off", "-o", "map.mat"], "'map.mat' must end in .npz"),
        (["repair", "a.off", "-o", "none/b.off"], "there is no folder 'none' for 'b.off'"),
        (["landmarks", "a.off", "a.csv", "b.off", "-o", "none/b.csv"], "there is no folder 'none' for 'b.csv'"),
    ],
)
def test_what_can_not_be_written_is_said_before_the_work(args: list[str], message: str) -> None:
    result = CliRunner().invoke(main, args)  # none of these meshes exists, and no one has looked
    assert result.exit_code == 2 and message in " ".join(result.stderr.split())
