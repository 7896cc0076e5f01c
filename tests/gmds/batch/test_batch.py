"""gmds batch on two workers: maps as match makes them, nothing done twice, failures named and the rest done."""

from __future__ import annotations

import contextlib
import csv
import json
import os
import random
import signal
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import batches
import numpy as np
import pytest
from click.testing import CliRunner, Result

import gmds
import gmds.batch
from geodesics import Mesh, write_mesh
from gmds.batch import Batch, consecutive, match_collection
from gmds.cli import main
from gmds.errors import FolderInUse

pytest.importorskip("distributed", reason="the extra `batch` is not installed")

SHAPES = batches.collection()


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with gmds.batch.local_client(2) as client:
        yield client


@pytest.fixture(scope="module")
def done(client: Any, tmp_path_factory: pytest.TempPathFactory) -> Batch:
    """An undisturbed run of all six pairs."""
    return match_collection(SHAPES, tmp_path_factory.mktemp("batch") / "done", client=client)


def copied(done: Batch, folder: Path) -> Path:
    for name, content in batches.tree(done.output).items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return folder


def run(client: Any, monkeypatch: pytest.MonkeyPatch, *args: object) -> Result:
    """The command line, with the cluster that is there already."""
    monkeypatch.setattr(gmds.batch, "local_client", lambda workers: contextlib.nullcontext(client))
    return CliRunner().invoke(main, ["batch", *map(str, args)])


def events(folder: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (folder / "manifest.jsonl").read_text().splitlines()]


def test_maps_are_those_of_match(done: Batch, tmp_path: Path) -> None:
    assert [pair.name for pair in done.pairs] == ["s0__s1", "s0__s2", "s0__s3", "s1__s2", "s1__s3", "s2__s3"]
    assert done.failed == () and not any(pair.kept for pair in done.pairs)
    plain = gmds.match(SHAPES["s1"], SHAPES["s3"])
    timeless = replace(plain, meta={key: value for key, value in plain.meta.items() if key != "seconds"})
    timeless.save(tmp_path / "plain.npz")
    assert (tmp_path / "plain.npz").read_bytes() == done.map_file(done.pairs[4]).read_bytes()
    again = gmds.Correspondence.load(done.map_file(done.pairs[4]), SHAPES["s1"], SHAPES["s3"])
    assert np.array_equal(again.vertex_map(), plain.vertex_map()) and again.status is plain.status


def test_the_folder_says_what_happened(done: Batch) -> None:
    with (done.output / "summary.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [(row["source"], row["target"]) for row in rows] == [(p.source, p.target) for p in done.pairs]
    assert all(float(row["stress"]) > 0 and float(row["blame"]) > 0 and row["code"] == "" for row in rows)
    told = events(done.output)
    assert [e["event"] for e in told] == ["run", *["shape"] * 4, *["pair"] * 6, "end"]
    assert told[0]["parameters"]["orientation"] == "preserve" and "numpy" in told[0]["versions"]
    assert all(e["seconds"] > 0 for e in told[1:-1]) and told[-1]["done"] == 6
    assert len({e["sha256"] for e in told[1:5]}) == 4
    assert len((done.output / "cycles.csv").read_text().splitlines()) == 1 + 4 == 1 + len(done.consistency.cycles)


def test_nothing_is_done_twice(done: Batch, client: Any, tmp_path: Path) -> None:
    folder = copied(done, tmp_path)
    before = {path: path.stat().st_mtime_ns for path in folder.glob("*/*.npz")}
    told: list[str] = []
    again = match_collection(SHAPES, folder, client=client, progress=lambda stage, _: told.append(stage))
    assert sum(stage.endswith(", as before") for stage in told) == len(again.pairs)
    assert all(pair.kept for pair in again.pairs) and all(shape.kept for shape in again.shapes.values())
    assert before == {path: path.stat().st_mtime_ns for path in folder.glob("*/*.npz")}
    assert batches.tree(folder) == batches.tree(done.output)


def test_what_is_damaged_missing_or_not_what_was_asked_for_is_done_again(
    done: Batch, client: Any, tmp_path: Path
) -> None:
    folder = copied(done, tmp_path)
    first, second, third, fourth = (
        folder / "pairs" / f"{name}.npz" for name in ("s0__s1", "s0__s2", "s0__s3", "s1__s2")
    )
    first.write_bytes(first.read_bytes()[:-50])
    second.unlink()
    third.write_bytes(fourth.read_bytes())  # whole, but of other meshes
    damaged = sorted((folder / "shapes").iterdir())[0]
    damaged.write_bytes(damaged.read_bytes()[:3000])
    (folder / "pairs" / ".gmds-0.tmp").write_bytes(b"left by a process that was killed")
    again = match_collection(SHAPES, folder, client=client)
    assert {pair.name for pair in again.pairs if not pair.kept} == {"s0__s1", "s0__s2", "s0__s3"}
    assert sum(shape.kept for shape in again.shapes.values()) == 3
    assert batches.tree(folder) == batches.tree(done.output)
    assert not list(folder.glob("*/.*"))
    other = match_collection(SHAPES, folder, client=client, pairs=[("s0", "s1"), ("s3", "s0")], n_samples=20)
    assert not any(pair.kept for pair in other.pairs) and all(shape.kept for shape in other.shapes.values())
    assert (folder / "pairs" / "s3__s0.npz").exists() and first.read_bytes() != done.map_file(
        done.pairs[0]
    ).read_bytes()


def test_workers_killed_at_random_change_nothing(done: Batch, client: Any, tmp_path: Path) -> None:
    rng, over, killed = random.Random(0), threading.Event(), []

    def kill() -> None:
        while not over.wait(rng.uniform(0.1, 1.0)) and len(killed) < 4:
            alive = list(batches.worker_pids(client))
            if alive:
                killed.append(rng.choice(alive))
                with contextlib.suppress(ProcessLookupError):
                    os.kill(killed[-1], signal.SIGKILL)

    thread = threading.Thread(target=kill)
    thread.start()
    try:
        disturbed = match_collection(SHAPES, tmp_path / "out", client=client)
    finally:
        over.set()
        thread.join()
    assert killed
    if disturbed.failed:  # killed three times out of four: named, and done by the next run
        assert {pair.failure.code for pair in disturbed.failed if pair.failure} == {"E505"}
        match_collection(SHAPES, tmp_path / "out", client=client)
    assert batches.tree(tmp_path / "out") == batches.tree(done.output)


def test_a_broken_mesh_is_named_and_the_rest_goes_on(
    done: Batch, client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, out = tmp_path / "meshes", copied(done, tmp_path / "out")
    folder.mkdir()
    for name in ("s0", "s1"):
        write_mesh(SHAPES[name], folder / f"{name}.ply")
    (folder / "bad.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
    write_mesh(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), folder / "tiny.ply")
    result = run(client, monkeypatch, folder, "-o", out, "--json")
    assert result.exit_code == 3, result.output
    said = json.loads(result.stdout)
    assert said["broken_shapes"] == ["bad", "tiny"] and (said["pairs"], said["failed"], said["done_before"]) == (
        6,
        5,
        1,
    )
    assert "left out bad: E105" in result.stderr and "left out tiny: E113" in result.stderr
    rows = list(csv.DictReader((out / "summary.csv").read_text().splitlines()))
    assert {row["code"] for row in rows if row["source"] == "bad"} == {"E105"}
    assert [row["reason"].partition(":")[0] for row in rows if row["target"] == "tiny"] == ["bad", "tiny", "tiny"]


def test_a_list_of_files_on_the_command_line(client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_mesh(SHAPES["s0"], tmp_path / "a.ply")
    write_mesh(SHAPES["s1"], tmp_path / "b.ply")
    (tmp_path / "list.csv").write_text("a.ply,b.ply\na.ply,gone.ply\n")
    result = run(client, monkeypatch, tmp_path / "list.csv", "-o", tmp_path / "out", "--samples", 20)
    assert result.exit_code == 3 and "left out gone: E202" in result.stderr, result.output
    assert [path.name for path in (tmp_path / "out" / "pairs").iterdir()] == ["a__b.npz"]
    plain = ["match", tmp_path / "a.ply", tmp_path / "b.ply", "-o", tmp_path / "plain.npz", "--samples", 20]
    assert CliRunner().invoke(main, [str(arg) for arg in plain]).exit_code == 0
    with np.load(tmp_path / "plain.npz") as one, np.load(tmp_path / "out" / "pairs" / "a__b.npz") as other:
        assert all(np.array_equal(one[name], other[name]) for name in one if name != "meta")
        metas = [json.loads(archive["meta"].tobytes()) for archive in (one, other)]
    assert metas[0].pop("seconds") > 0 and metas[0] == metas[1]
    for wrong in (["--pairs", "some"], ["--pairs", "template="], ["--scheduler", "x", "--workers", 1]):
        assert run(client, monkeypatch, tmp_path, *wrong).exit_code == 2


def test_a_pair_that_takes_too_long_is_named(client: Any, tmp_path: Path) -> None:
    late = match_collection(SHAPES, tmp_path, pairs=consecutive, timeout=1e-3, client=client)
    assert [pair.failure.code for pair in late.pairs if pair.failure] == ["E504"] * 3
    assert "0.001 seconds" in (tmp_path / "summary.csv").read_text() and not list(tmp_path.glob("pairs/*"))
    then = match_collection(SHAPES, tmp_path, pairs=[("s0", "s1")], timeout=600, client=client)
    assert then.failed == () and not then.pairs[0].kept


def test_a_pair_that_kills_its_workers_is_given_up(client: Any, tmp_path: Path) -> None:
    lost = match_collection(SHAPES, tmp_path, pairs=[("s0", "s1")], distance=batches.deadly, client=client)
    assert lost.pairs[0].failure is not None and lost.pairs[0].failure.code == "E505"


def test_a_second_run_in_the_same_folder_is_refused(done: Batch, client: Any, tmp_path: Path) -> None:
    folder, refused = copied(done, tmp_path), []

    def meanwhile(stage: str, fraction: float) -> None:
        with pytest.raises(FolderInUse, match="E503"):
            match_collection(SHAPES, folder, client=client)
        refused.append(stage)

    match_collection(SHAPES, folder, client=client, progress=meanwhile)
    assert len(refused) > 10 and batches.tree(folder) == batches.tree(done.output)
