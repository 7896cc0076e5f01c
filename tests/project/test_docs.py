"""Every block of code in README, CONTRIBUTING and docs runs, and so does every example in the help of a command."""

from __future__ import annotations

import contextlib
import pkgutil
import re
import runpy
import shlex
import shutil
import unittest
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import docs_files
import numpy as np
import pytest
from click.testing import CliRunner
from places import ROOT
from sybil import Document, Example
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser, SkipParser

import geodesics
import gmds
from gmds.batch.records import UNEXPECTED, WORKER_DIED
from gmds.cli import main
from gmds.demo.files import write_files

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
FENCE = re.compile(r"^[ >]*```+(\S*)[^\n]*\n(.*?)^[ >]*```+ *$", re.MULTILINE | re.DOTALL)
SKIP = "<!-- skip: next "
SHOWN = {"text", "diff", "{eval-rst}", "{toctree}", "{include}"}  # what is there to be read, or makes the page
needs_extras = [pytest.importorskip(name) for name in ("matplotlib", "distributed", "plotly")]


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What `gmds demo --files` writes, with few vertices."""
    folder = tmp_path_factory.mktemp("files")
    write_files(folder, docs_files.N)
    return folder


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with gmds.batch.local_client(1) as client:
        client.run(docs_files.remember)
        yield client


def interrupted(*_: Any) -> None:
    """As by Ctrl-C."""
    raise KeyboardInterrupt


@pytest.fixture
def as_a_reader(files: Path, client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder; `gmds demo --files` copies what was written once, matches are made once."""

    def copied(folder: Path) -> list[str]:
        shutil.copytree(files, folder, dirs_exist_ok=True)
        return sorted(path.name for path in folder.iterdir())

    monkeypatch.setattr("gmds.demo.files.write_files", copied)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(vars(gmds), "match", docs_files.match_on_pages)
    monkeypatch.setattr("gmds.batch.local_client", lambda workers: contextlib.nullcontext(client))
    monkeypatch.setattr("gmds.shapes.demo_pair", docs_files.small_pair)
    monkeypatch.setattr("gmds.pictures.writing.offscreen", docs_files.small_pictures)
    monkeypatch.setattr("gmds.installation.diagnosis._import_error", docs_files.import_error)
    monkeypatch.setattr("gmds.viewer.server.PageServer.serve_forever", interrupted)
    monkeypatch.setattr("click.launch", lambda link: 0)
    return tmp_path


@pytest.fixture
def among_files(files: Path, as_a_reader: Path) -> Path:
    """The same, with the files in it."""
    shutil.copytree(files, as_a_reader, dirs_exist_ok=True)
    return as_a_reader


def test_the_character_is_the_wolf_with_bones(files: Path) -> None:
    """Its pose at rest is the mesh of wolf.off to the last bit, so that the map of the one serves the other."""
    character, wolf = geodesics.read_mesh(files / "character.glb"), geodesics.read_mesh(files / "wolf.off")
    assert np.array_equal(character.vertices, wolf.vertices) and np.array_equal(character.faces, wolf.faces)
    assert (np.load(files / "bones.npy").sum(axis=1) == 1).all()


RAN: set[str] = set()


def run_line(line: str) -> None:
    """A line of a shell: a gmds command, perhaps with its output sent to a file."""
    words = shlex.split(line, comments=True)
    if not words:
        return
    assert words[0] == "gmds", f"{line!r} is no gmds command; mark the block as one that cannot be run"
    args, sent = (words[1 : words.index(">")], words[-1]) if ">" in words else (words[1:], None)
    result = CliRunner().invoke(main, args)
    assert result.exit_code == 0, f"{line}\n{result.output}"
    RAN.add(shlex.join(words))
    if sent:
        Path(sent).write_text(result.stdout, encoding="utf-8")


def run_shell(example: Example) -> None:
    for line in example.parsed.replace("\\\n", " ").splitlines():
        run_line(line)


PARSERS = (PythonCodeBlockParser(), CodeBlockParser(language="sh", evaluator=run_shell), SkipParser())


@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_code_on_a_page_runs_from_nothing(page: Path, as_a_reader: Path) -> None:
    """From top to bottom in an empty folder, as a reader would who begins with this page."""
    text = page.read_text(encoding="utf-8")
    met = 0
    for example in Document.parse(str(page), *PARSERS).examples():
        with contextlib.suppress(unittest.SkipTest):  # for a reason that the page gives
            example.evaluate()
        met += 1
    fences = [kind for kind, _ in FENCE.findall(text) if kind in ("python", "sh")]
    skips = re.findall(f"^ *{SKIP}", text, re.MULTILINE)
    assert met == len(fences) + len(skips)  # a block that is not found would not be run


def test_nothing_is_left_out_unseen() -> None:
    kinds = {(page.name, found[1]) for page in PAGES for found in FENCE.finditer(page.read_text(encoding="utf-8"))}
    assert {kind for _, kind in kinds} <= {"python", "sh", *SHOWN}, kinds
    skipped = [
        found
        for page in PAGES
        for found in re.findall(rf"^ *({SKIP}.*)", page.read_text(encoding="utf-8"), re.MULTILINE)
    ]
    assert len(skipped) <= 9 and all(re.fullmatch(rf'{SKIP}"[^"]+" -->', line) for line in skipped), skipped


@pytest.mark.skipif(not (ROOT / "gmds").is_dir(), reason="the packages do not lie beside the tests")
@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_files_and_modules_that_a_page_names_are_there(page: Path) -> None:
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    paths = re.findall(r"`((?:gmds|geodesics|tests|benchmarks|docs|examples)/[\w./]+\.\w+)`", text)
    assert not [path for path in paths if not (ROOT / path).exists()]
    for name in re.findall(r"`((?:gmds|geodesics)(?:\.\w+)+)[`(]", text):
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # a path that has moved
            pkgutil.resolve_name(name)


def test_no_two_errors_have_the_same_code() -> None:
    codes = runpy.run_path(str(ROOT / "docs" / "generated.py"))["error_codes"]()
    by_code: dict[str, list[str]] = {}
    for code, kind in codes:
        by_code.setdefault(code, []).append(kind.__name__)
    assert not {WORKER_DIED, UNEXPECTED} & set(by_code)  # those of batches
    assert len(by_code) > 35 and not {code: names for code, names in by_code.items() if len(names) > 1}


def examples_in_help() -> list[str]:
    found = []
    for name in main.command_names:
        text = click.unstyle(CliRunner().invoke(main, [name, "--help"]).stdout)
        found += [line.strip() for line in re.findall(rf"^ +gmds {name}\b.*", text, re.MULTILINE)]
    return [line for line in found if "~" not in line and "warmup" not in line and "`" not in line]  # another home


def test_the_examples_of_every_command_run(among_files: Path) -> None:
    lines = examples_in_help()
    assert len(lines) > 25
    for line in lines:
        # what ran on a page, a moment ago, runs here only where the next lines need what it writes
        if line.startswith("gmds atlas meshes -o atlas ") or shlex.join(shlex.split(line)) not in RAN:
            run_line(line)
