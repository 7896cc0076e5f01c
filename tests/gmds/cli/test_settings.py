"""Settings in files: what is printed reads back, the command line comes first, mistakes are named, maps hold theirs."""

from __future__ import annotations

import json
import os
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from generated_shapes import bumpy_sphere
from hypothesis import given
from hypothesis import strategies as st

import gmds
from geodesics import Mesh, write_mesh
from gmds.cli import main
from gmds.cli.choices import DISTANCES, LOSS_CLASSES, LOSSES, METRICS, PARTS, chosen_loss
from gmds.maps.npz_format import read_meta
from gmds.matching.part_answers import PARTS as PARTS_OF_MATCH

COMMANDS = ("match", "batch", "benchmark")
GIVEN: dict[str, list[object]] = {
    "match": ["a.ply", "b.ply", "--landmarks", "a.csv", "--landmarks", "b.csv", "--space", "RAS", "--picture", "p.png"],
    "batch": ["folder", "--pairs", "template=x", "--both-ways", "--timeout", 2.5, "--workers", 3, "-o", "there"],
    "benchmark": ["folder", "--every", 4, "--pairs", "some.txt", "-o", "rows.csv"],
}
MATCHING: list[object] = [
    "--samples",
    77,
    "--orientation",
    "any",
    "--parts",
    "neither",
    "--metric",
    "affine",
    "--loss",
    "huber",
    "--seed",
    5,
]


def run(*args: object) -> Result:
    return CliRunner().invoke(main, [str(arg) for arg in args])


def dumped(*args: object) -> str:
    result = run(*args, "--dump-config")
    assert result.exit_code == 0, result.output
    return result.stdout


def refused(*args: object) -> str:
    result = run(*args)
    assert isinstance(result.exception, SystemExit) and result.exit_code == 1, result.output
    return result.stderr


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "run.toml"


@pytest.fixture
def pair(tmp_path: Path) -> tuple[Path, Path]:
    shape = bumpy_sphere(2)
    write_mesh(shape, tmp_path / "a.ply")
    write_mesh(Mesh(2 * shape.vertices, shape.faces), tmp_path / "b.ply")
    return tmp_path / "a.ply", tmp_path / "b.ply"


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("options", [[], MATCHING])
def test_what_is_dumped_reads_back(command: str, options: list[object], file: Path) -> None:
    text = dumped(command, *GIVEN[command], *options)
    file.write_text(text)
    assert dumped(command, "--config", file) == text
    said = tomllib.loads(text)
    assert set(said) == {"matching", command}
    assert said["matching"].get("samples") == (77 if options else None)


def test_everything_is_told_set_or_not() -> None:
    text = dumped("match")
    unset = ("source", "target", "report", "picture", "up", "tolerance")
    assert f"# not set: {', '.join(f'match.{name}' for name in unset)}, matching.samples" in text
    said = tomllib.loads(text)
    assert said["matching"] == {"orientation": "preserve", "parts": "auto", "loss": "least-squares", "seed": 0}
    assert said["match"]["output"] == "map.npz"


@pytest.mark.parametrize("name", LOSSES)
def test_every_loss_can_be_chosen(name: str) -> None:
    assert type(chosen_loss(name)).__name__ == LOSS_CLASSES[name]
    assert f'loss = "{name}"' in dumped("match", "--loss", name)


@given(
    samples=st.integers(3, 10**9),
    seed=st.integers(-(2**62), 2**62),
    names=st.tuples(*(st.sampled_from(names) for names in (METRICS, DISTANCES, LOSSES))),
    output=st.from_regex(r"[^-/\\\0][^/\\\0]{0,50}\.npz", fullmatch=True, alphabet=st.characters(codec="utf-8")),
)
def test_any_settings_read_back(
    samples: int, seed: int, names: tuple[str, str, str], output: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    options = ["--samples", samples, "--seed", seed, "-o", output]
    for name, value in zip(("--metric", "--distance", "--loss"), names, strict=True):
        options += [name, value]
    text = dumped("match", *options)
    file = tmp_path_factory.mktemp("settings") / "run.toml"
    file.write_bytes(text.encode())
    assert dumped("match", "--config", file) == text
    assert tomllib.loads(text)["match"]["output"] == str(Path(output))


def test_the_command_line_comes_first(file: Path) -> None:
    file.write_text(dumped("batch", *GIVEN["batch"], *MATCHING))
    again = tomllib.loads(dumped("batch", "--config", file, "--seed", 6, "--one-way", "other"))
    assert (again["matching"]["seed"], again["matching"]["samples"]) == (6, 77)
    assert (again["batch"]["both-ways"], again["batch"]["list-or-dir"], again["batch"]["workers"]) == (
        False,
        "other",
        3,
    )


def test_one_file_serves_all_commands(file: Path) -> None:
    file.write_text("[matching]\nsamples = 50\n[batch]\nworkers = 2\n[benchmark]\nevery = 3\n")
    said = {command: tomllib.loads(dumped(command, "--config", file)) for command in COMMANDS}
    assert all(tables["matching"]["samples"] == 50 for tables in said.values())
    assert said["batch"]["batch"]["workers"] == 2 and said["benchmark"]["benchmark"]["every"] == 3


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("[matching]\nsample = 3", "E601: {file}, table [matching], has no key 'sample'; did you mean 'samples'?"),
        ("[match]\nreports = 'r'", "E601: {file}, table [match], has no key 'reports'; did you mean 'report'?"),
        ("[batch]\njson = true", "E601: {file}, table [batch], has no key 'json'"),
        ("[mach]\n", "E601: {file} has no key 'mach'; did you mean 'match'?"),
        ("samples = 3", "E601: {file} has no key 'samples'"),
        ("matching = 3", "E603: {file}: matching must be a table of settings, [matching], not 3"),
        ("[matching]\nsamples = '3'", "E603: {file}: matching.samples must be a whole number, not '3'"),
        ("[matching]\nsamples = 3.5", "matching.samples must be a whole number, not 3.5"),
        ("[matching]\nseed = true", "matching.seed must be a whole number, not True"),
        ("[matching]\nmetric = 'embeded'", "matching.metric cannot be 'embeded'; did you mean 'embedded'?"),
        ("[matching]\nparts = 'sourc'", "matching.parts cannot be 'sourc'; did you mean 'source'?"),
        ("[matching]\nloss = ['huber']", "matching.loss must be text in quotes"),
        ("[match]\nlandmarks = 'a.csv'", "match.landmarks must be a list of text in quotes"),
        ("[match]\nlandmarks = [3]", "match.landmarks must be a list of text in quotes, not [3]"),
        ("[batch]\nboth-ways = 1", "batch.both-ways must be true or false, not 1"),
        ("[batch]\ntimeout = 'x'", "batch.timeout must be a number"),
        ("[batch]\ntimeout = 0", "batch.timeout cannot be 0: "),
        ("[benchmark]\nevery = 0", "benchmark.every cannot be 0: "),
        ("[matching", "E603: {file} is no TOML: "),
        ("x = " + "[" * 5000, "E603: {file} is no TOML: "),
    ],
)
def test_mistakes_name_file_and_key(content: str, told: str, file: Path) -> None:
    file.write_text(content)
    for command in COMMANDS:
        assert told.format(file=file) in refused(command, "--config", file)


def test_what_is_no_file_of_settings(tmp_path: Path) -> None:
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe[matching]")
    assert "bytes.toml is no TOML" in refused("match", "--config", tmp_path / "bytes.toml")
    (tmp_path / "large.toml").write_bytes(b"#" * 1_000_001)
    assert "larger than 1 MB" in refused("match", "--config", tmp_path / "large.toml")
    os.mkfifo(tmp_path / "pipe.toml")
    assert "not a regular file" in refused("match", "--config", tmp_path / "pipe.toml")
    assert "none.toml" in refused("match", "--config", tmp_path / "none.toml")
    (tmp_path / "no.npz").write_bytes(b"PK")
    assert "E210" in refused("match", "--config", tmp_path / "no.npz")


def test_what_is_needed_may_be_in_the_file(pair: tuple[Path, Path], file: Path, tmp_path: Path) -> None:
    missing = run("match", "--config", tmp_path / "empty.toml") if file.write_text("") else run("match", pair[0])
    assert missing.exit_code == 2 and "Missing argument 'TARGET'" in missing.stderr
    file.write_text(dumped("match", *pair, "-o", tmp_path / "m.npz"))
    result = run("match", "--config", file, "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["map"] == str(tmp_path / "m.npz")


@pytest.mark.parametrize(
    "options",
    [
        [],
        ["--samples", 40, "--loss", "huber", "--orientation", "any", "--metric", "embedded", "--seed", 3],
        ["--samples", 40, "--parts", "neither"],
    ],
)
def test_a_map_holds_what_makes_it_again(options: list[object], pair: tuple[Path, Path], tmp_path: Path) -> None:
    first, again = tmp_path / "first.npz", tmp_path / "again.npz"
    assert run("match", *pair, "-o", first, *options).exit_code == 0
    assert run("match", *pair, "-o", again, "--config", first).exit_code == 0
    metas: list[dict[str, Any]] = [read_meta(path) for path in (first, again)]
    for meta in metas:
        meta.pop("seconds")
    assert metas[0] == metas[1] and {"parameters", "versions", "source", "target"} < set(metas[0])
    with np.load(first) as a, np.load(again) as b:
        assert all(np.array_equal(a[name], b[name]) for name in ("face", "barycentric", "valid", "distortion"))
    said = tomllib.loads(dumped("match", "--config", first))["matching"]
    assert all(str(value) in map(str, said.values()) for value in options[1::2])
    assert said["samples"] == (40 if options else 162)


def test_maps_with_settings_that_have_no_name(pair: tuple[Path, Path], tmp_path: Path) -> None:
    mesh = bumpy_sphere(1)
    answer = gmds.match(mesh, mesh, loss=gmds.Huber(threshold=0.123))
    answer.save(tmp_path / "own.npz")
    assert "E603" in refused("match", "--config", tmp_path / "own.npz", "--dump-config")
    gmds.Correspondence.from_points(mesh, answer.points).save(tmp_path / "none.npz")
    assert "holds no settings" in refused("match", "--config", tmp_path / "none.npz", "--dump-config")


def test_a_map_of_another_version_is_told(pair: tuple[Path, Path], tmp_path: Path) -> None:
    mesh = bumpy_sphere(1)
    answer = gmds.match(mesh, mesh)
    versions = {**answer.meta["versions"], "gmds": "0.0.1"}
    gmds.Correspondence.from_points(mesh, answer.points, meta={**answer.meta, "versions": versions}).save(
        tmp_path / "old.npz"
    )
    result = run("match", "--config", tmp_path / "old.npz", "--dump-config")
    assert result.exit_code == 0 and "made by gmds 0.0.1" in result.stderr


def test_a_map_from_before_there_were_parts_is_made_again_without_them(tmp_path: Path) -> None:
    mesh = bumpy_sphere(1)
    answer = gmds.match(mesh, mesh, parts="neither")
    old = {key: value for key, value in answer.meta["parameters"].items() if key != "parts"}
    gmds.Correspondence.from_points(mesh, answer.points, meta={**answer.meta, "parameters": old}).save(
        tmp_path / "old.npz"
    )
    assert tomllib.loads(dumped("match", "--config", tmp_path / "old.npz"))["matching"]["parts"] == "neither"


def test_the_command_line_has_the_parts_of_match() -> None:
    assert PARTS == PARTS_OF_MATCH
