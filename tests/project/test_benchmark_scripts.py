"""The scripts behind the published tables: what is done is not done again, and every pair is in one half."""

from __future__ import annotations

import importlib
import os
import subprocess
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from generated_shapes import bumpy_sphere
from places import ROOT

from geodesics import Mesh
from gmds.benchmarking.datasets import Pair, dataset_pairs
from gmds.benchmarking.run import BenchmarkRow, benchmark
from gmds.shapes import quadruped, truth

SCRIPTS = ROOT / "benchmarks"
SETS = ("scaled", "faust_5k", "tosca_5k", "tosca_cross_5k", "shrec20", "shrec20_reversed")
ROW = BenchmarkRow("a-b", "self", "GOOD", direct=20.0, best=2.0, within_010=50.0, missing_found=None)


@pytest.fixture
def scripts() -> Any:
    """Imports a script by its name."""
    return lambda name: importlib.import_module(f"benchmarks.accuracy.{name}")


def test_rows_come_back_as_they_were_written(scripts: Any, tmp_path: Path) -> None:
    runs, path = scripts("runs"), tmp_path / "new" / "rows.csv"
    rows = {("match", "a-b"): ROW, ("match", "c-d"): BenchmarkRow("c-d", "", "failed: face 1, which")}
    runs.write_rows(path, "abc", rows)
    assert runs.read_rows(path, "abc") == rows
    assert runs.read_rows(path, "another") == {}
    assert runs.read_rows(tmp_path / "none.csv", "abc") == {}


def test_published_results_can_be_read(scripts: Any) -> None:
    """Also the ones of before there were versions."""
    for path in (SCRIPTS / "results").glob("*.csv"):
        assert scripts("runs").read_rows(path, "none") == {}


def test_mutation_testing_knows_its_modules_and_their_tests() -> None:
    mutants = importlib.import_module("benchmarks.mutation.mutants")
    for module, names in mutants.MODULES.items():
        assert len(mutants.source(module).splitlines()) > 5, module
        assert all(list((ROOT / "tests").rglob(f"{name}.py")) for name in names), module
    assert mutants.read(SCRIPTS / "results" / "mutants.csv").keys() >= set()


def test_what_is_in_the_table_is_not_run_again(scripts: Any, tmp_path: Path) -> None:
    runs, path = scripts("runs"), tmp_path / "rows.csv"
    runs.write_rows(path, "abc", {("match", "a-b"): ROW})
    pair = type("Named", (), {"name": "a-b"})()
    assert runs.run(runs.Job("nowhere", [pair], ["match"], runs.judge), path, "abc", 1) == {("match", "a-b"): ROW}


def test_a_fault_is_a_row(scripts: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    runs, calls = scripts("runs"), []

    def broken(source: Mesh, target: Mesh) -> None:
        raise IndexError("no such vertex")

    def find(name: str) -> Any:
        calls.append(name)
        return broken

    pair = Pair("a-b", Path("a.off"), Path("b.off"), lambda *meshes: None, "self")  # type: ignore
    monkeypatch.setattr(runs, "_by_name", lambda folder: {"a-b": pair})
    monkeypatch.setattr(runs, "benchmark", lambda pairs, matcher: iter([matcher(None, None)]))
    row = runs.judge(find, "set", "match", "a-b")
    assert (row.pair, row.group, row.status) == ("a-b", "self", "failed: IndexError: no such vertex")
    assert calls == ["match", "match"]  # once to warm up


def test_each_pair_is_in_one_half(scripts: Any) -> None:
    halves = scripts("halves")
    assert tuple(halves.DEVELOPMENT) == SETS
    for name in SETS:
        both = [set(halves.half_of(name, half)) for half in halves.HALVES]
        assert not both[0] & both[1]
        assert both[1]


@pytest.mark.skipif("GMDS_DATA" not in os.environ, reason="GMDS_DATA is not set")
def test_the_lists_are_those_of_the_rule(scripts: Any) -> None:
    halves = scripts("halves")
    for file, lines in halves.lists().items():
        assert (SCRIPTS / "pairs" / file).read_text(encoding="utf-8").splitlines() == lines
    for name in SETS:
        known = {pair.name for pair in halves.pairs_of(name)}
        assert known == {pair for half in halves.HALVES for pair in halves.half_of(name, half)}


@pytest.mark.skipif("GMDS_DATA" not in os.environ, reason="GMDS_DATA is not set")
def test_missing_landmarks_are_those_the_other_animal_lacks(scripts: Any) -> None:
    pairs = {pair.name: pair for pair in scripts("halves").pairs_of("shrec20_reversed")}
    assert pairs["cow-bear"].missing is not None and len(pairs["cow-bear"].missing()) == 21
    folder = Path(os.environ["GMDS_DATA"]) / "shrec20"
    whole = {pair.name: pair for pair in dataset_pairs(folder)}
    assert whole["pig-leopard"].missing is not None and len(whole["pig-leopard"].missing()) == 0
    assert whole["dog-camel_a"].missing is not None and len(whole["dog-camel_a"].missing()) == 1  # not the hump


def test_statuses_are_counted(scripts: Any) -> None:
    tables = scripts("tables")
    right = replace(ROW, direct=1.0)
    rows = [ROW, replace(ROW, status="POOR"), right, right, right, replace(right, status="AMBIGUOUS")]
    assert tables.statuses({"set": rows})[-2] == "| all | 2 | 1 | 50 % | 4 | 1 | 25 % |"
    failed = BenchmarkRow("x", "", "failed: no")
    lines = tables.accuracy({"scaled, self": [*rows, failed]})
    assert "| scaled, self | 7 (1 failed) | 7.33 | 1.00 | 20.00 | 2.00 | - | 50.0 |" in lines[2]
    assert [line.split(" | ")[1] for line in tables.failures({"set": [right, ROW, failed]})[2:-1]] == ["x", "a-b"]
    half = tables.halves({"set": [ROW, replace(right, pair="c-d")]}, {"a-b"})
    assert half[2] == "| set | 1 | 20.00 | 20.00 | 1 | 1.00 | 1.00 |"


def test_wrong_maps_of_parts_and_right_ones_called_wrong_are_counted(scripts: Any) -> None:
    rows = [
        {"error": "15.1", "status": "GOOD"},
        *3 * [{"error": "40", "status": "POOR"}],
        {"error": "16", "status": "AMBIGUOUS"},
        *2 * [{"error": "1", "status": "GOOD"}],
        {"error": "4.9", "status": "POOR"},
        {"error": "9", "status": "POOR"},
    ]
    lines = scripts("part_tables").statuses({"some": rows, "none": []})
    assert lines[2:4] == ["| some | 5 | 4 | 80 % | 3 | 1 | 33 % |", "| none | 0 | 0 | - | 0 | 0 | - |"]
    one = {**rows[0], "iou": "0.5", "precision": "1", "recall": "0.5", "cpu_seconds": "9"}
    two = {**one, "error": "24.9", "status": "POOR", "iou": "1"}
    cells = scripts("part_tables").cells_of("set", [one, two], "3.0")
    assert cells == ["set", 2, "20.00", "20.00", "24.90", "1 of 2", "0.75", "1.00", "0.50", 1, 0, "9.0", "3.0"]


@pytest.mark.parametrize("name", ["parts", "cuts"])
def test_pages_of_parts_tell_their_command_and_only_ours_have_a_status(scripts: Any, name: str) -> None:
    script = scripts(name)
    columns = dict.fromkeys(scripts("parts").COLUMNS, "1")
    rows = [{**columns, "pair": "a", "group": "PFAUST-M", "status": "GOOD"}]
    ours, theirs = script.page(rows, "abc"), script.page(rows, script.PEER)
    assert f"`python -m benchmarks.accuracy.{name}` at abc" in ours and "## Status" in ours
    assert f"`python -m benchmarks.accuracy.{name} --peer` at {script.PEER}" in theirs and "## Status" not in theirs


def test_a_change_inside_lasts_for_one_match(scripts: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    import gmds

    ablation, seen = scripts("ablation"), []
    inside = ModuleType("inside")
    inside.TIME = 3  # type: ignore[attr-defined]
    monkeypatch.setattr(gmds, "match", lambda source, target: seen.append(inside.TIME))
    ablation.changed({inside: {"TIME": 7}})(None, None)
    assert (seen, inside.TIME) == ([7], 3)
    with pytest.raises(AttributeError, match="NOTHING"):
        ablation.changed({inside: {"NOTHING": 0}})
    assert all(callable(ablation.variant(name)) for name in ablation.VARIANTS)


def test_the_peer_maps_the_source_to_the_target(scripts: Any) -> None:
    """A shape without symmetry, renumbered by a permutation that is not its own inverse."""
    pytest.importorskip("pyFM")
    mesh = bumpy_sphere(3)
    order = np.random.default_rng(0).permutation(mesh.n_vertices)
    target = Mesh(mesh.vertices[order], np.argsort(order)[mesh.faces])
    answer = scripts("peers").functional_map(mesh, target)
    assert (answer.vertex_map() == np.argsort(order)).mean() > 0.95


def test_turning_depends_on_the_name_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    import gmds.benchmarking.run

    def state(pair: Any, matcher: Any, rng: np.random.Generator) -> BenchmarkRow:
        return BenchmarkRow(pair.name, "", "GOOD", direct=float(rng.uniform()))

    monkeypatch.setattr(gmds.benchmarking.run, "judged", state)
    one, two = (type("Named", (), {"name": name})() for name in ("a-b", "c-d"))
    both = list(benchmark([one, two], state))
    assert list(benchmark([two], state)) == both[1:]
    assert both[0].direct != both[1].direct


def test_tables_hold_across_commits_that_only_move(
    scripts: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs = scripts("runs")
    monkeypatch.setattr(runs, "ROOT", tmp_path)

    def git(*arguments: str) -> str:
        who = ("-c", "user.name=a", "-c", "user.email=a@b.c")
        done = subprocess.run(["git", "-C", tmp_path, *who, *arguments], capture_output=True, text=True, check=True)
        return done.stdout.strip()

    git("init", "-q")
    (tmp_path / "gmds").mkdir()
    (tmp_path / "geodesics").mkdir()
    versions = []
    for name, message in (("a", "One"), ("b", "Two\n\nMaps-unchanged: 40 of 40"), ("c", "Three")):
        (tmp_path / "gmds" / f"{name}.py").write_text("")
        git("add", ".")
        git("commit", "-q", "-m", message)
        versions.append(runs.code_version())
    assert versions[0] == versions[1] != versions[2] == git("log", "-1", "--format=%h")
    (tmp_path / "gmds" / "a.py").write_text("x = 1")
    assert runs.code_version().startswith(f"{versions[2]}+")


def test_cuts_are_twenty_and_their_truth_is_exact(scripts: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    cuts = scripts("cuts")
    assert len({one.name for one in cuts.CUTTINGS}) == 20
    assert all(0.1 <= one.share <= 0.5 for one in cuts.CUTTINGS)
    monkeypatch.setattr(cuts, "VERTICES", 800)
    cutting = next(one for one in cuts.CUTTINGS if one.group == "built-in")
    part, whole, there = cuts.built_in(cutting, back=False)
    assert len(there.there) == part.mesh.n_vertices and there.points.mesh is whole and len(there.missing) == 0
    part, whole, back = cuts.built_in(cutting, back=True)
    assert sorted([*back.there, *back.missing]) == list(range(whole.n_vertices))
    # what is on the part goes back to within an edge of where it came from
    again = there.points[back.points.nearest_vertices()].positions
    edges = np.linalg.norm(whole.vertices[whole.faces[:, 0]] - whole.vertices[whole.faces[:, 1]], axis=1)
    assert np.linalg.norm(again - whole.vertices[back.there], axis=1).max() < 2 * edges.max()


def test_random_parts_repeat_and_their_truth_is_exact(
    scripts: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    random_parts = scripts("random_parts")
    (tmp_path / "tosca_5k").mkdir()
    for name in ("cat0", "cat1", "dog0"):
        (tmp_path / "tosca_5k" / f"{name}.off").touch()
    monkeypatch.setenv("GMDS_DATA", str(tmp_path))
    monkeypatch.setattr(random_parts, "VERTICES", 400)
    some = random_parts.drawn(12, 3)
    assert str(some[:5]) == str(random_parts.drawn(5, 3)) != str(random_parts.drawn(5, 4))
    assert {one.how for one in some} == set(random_parts.HOW) and all(one.part != one.whole for one in some)
    assert {one.part[:3] for one in some if one.kind == "TOSCA"} == {"cat"}  # of one dog there is no other pose
    for one in (some[2], some[5], some[8]):
        part, whole, onto, back = random_parts.made(one)
        assert len(onto.there) == part.mesh.n_vertices and onto.points.mesh is whole
        assert sorted([*back.there, *back.missing]) == list(range(whole.n_vertices))
        again = onto.points[back.points.nearest_vertices()].positions
        edges = np.linalg.norm(whole.vertices[whole.faces[:, 0]] - whole.vertices[whole.faces[:, 1]], axis=1)
        assert np.linalg.norm(again - whole.vertices[back.there], axis=1).max() < 2 * edges.max()


def test_what_two_cut_shapes_have_in_common_is_where_it_was(scripts: Any) -> None:
    both_cut = scripts("both_cut")
    source, target = quadruped(n_vertices=400), quadruped("walk", n_vertices=400, seed=2)
    true = truth(source, target)
    known = both_cut.cases.Known(source, target, np.arange(source.n_vertices), true)
    (ours, theirs), left = both_cut.both_cut(known, np.random.default_rng(0))
    assert len(left.there) >= both_cut.COMMON * source.n_vertices and not set(left.there) & set(left.missing)
    for piece, whole in ((ours, source), (theirs, target)):
        assert 0.45 < piece.area / whole.area < 0.8
    rows = {tuple(place): row for row, place in enumerate(source.vertices)}
    origin = [rows[tuple(place)] for place in ours.vertices[left.there]]
    goals = target.vertices[true[np.array(origin)].nearest_vertices()]
    np.testing.assert_array_equal(theirs.vertices[left.points], goals)
