"""The parts of a batch that need no workers: names, lists, choices of pairs, records, the lock, cycles."""

from __future__ import annotations

import csv
import itertools
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import bumpy_sphere

import gmds
from geodesics import Mesh, SurfacePoints, write_mesh
from gmds.batch import all_pairs, both_ways, consecutive, match_collection, with_template
from gmds.batch.collection import Collection, names
from gmds.batch.cycles import CarriedMap, Consistency, consistency
from gmds.batch.deadline import deadline
from gmds.batch.lock import only_run
from gmds.batch.manifest import Manifest, write_summary
from gmds.batch.pair_list import read_list
from gmds.batch.records import Failure, PairRecord
from gmds.errors import BadPairList, FolderInUse, PairTimeout, TooFewVertices, UnknownKey
from gmds.provenance import in_words, is_lasting


def test_choices_of_pairs() -> None:
    assert list(all_pairs("abc")) == [("a", "b"), ("a", "c"), ("b", "c")]
    assert list(consecutive("abc")) == [("a", "b"), ("b", "c")]
    assert list(with_template("b")("abc")) == [("b", "a"), ("b", "c")]
    assert list(both_ways(consecutive)("abc")) == [("a", "b"), ("b", "a"), ("b", "c"), ("c", "b")]
    with pytest.raises(ValueError, match="did you mean 'horse'"):
        with_template("hores")(["horse", "dog"])


def test_names_are_different_and_make_one_pair_each() -> None:
    paths = [
        Path(p) for p in ("x/dog.off", "y/dog.ply", "x/DOG.off", "x/a__b_.off", "x/=c d.off", "x/ü.off", "x/__.off")
    ]
    found = names(paths)
    assert len({name.casefold() for name in found}) == len(paths)
    assert all("__" not in name and not name.startswith((".", "-", "_")) for name in found)
    assert found[3:] == ["a_b", "c_d", "ü", "shape"] and found[0].startswith("dog.off-")
    assert names([Path("x/" + "ü" * 200 + ".off")])[0] == "ü" * 50
    assert found[:2] == names([Path("here", p) for p in paths])[:2]  # wherever they lie


def test_lists(tmp_path: Path) -> None:
    path = tmp_path / "list.txt"
    path.write_text('\ufeffsource,target\n# no\n\na.off, sub/b.off\r\n"c,1.off",a.off\n', encoding="utf-8")
    files, pairs = read_list(path)
    a, b, c = tmp_path / "a.off", tmp_path / "sub/b.off", tmp_path / "c,1.off"
    assert files == [a, b, c] and pairs == [(a, b), (c, a)]
    path.write_text("a.off\nb.off\n")
    assert read_list(path) == ([a, tmp_path / "b.off"], None)
    assert Collection.of(path).pairs == (("a", "b"),)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "names no file"),
        (b"# nothing\n", "names no file"),
        (b"a,b,c\n", "line 1"),
        (b"a,b\nc\n", "line 2: 1 files, where the first line has 2"),
        (b"a,\n", "line 1"),
        (b"a\0,b\n", "line 1"),
        (b"\xfa\xfb", "UTF-8"),
    ],
)
def test_bad_lists_name_the_line(tmp_path: Path, content: bytes, message: str) -> None:
    (tmp_path / "list").write_bytes(content)
    with pytest.raises(BadPairList, match=message):
        read_list(tmp_path / "list")


def test_a_list_that_is_no_file_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(BadPairList):
        read_list(tmp_path / "pipe")
    with pytest.raises(FileNotFoundError):
        read_list(tmp_path / "gone")


def test_collections(tmp_path: Path) -> None:
    mesh = bumpy_sphere(0)
    found = Collection.of({"a": mesh, "b": "b.off", "c": mesh}, [("c", "a"), ("c", "a")])
    assert found.pairs == (("c", "a"),) and list(found.shapes) == ["a", "c"] and found.shapes["c"].mesh() is mesh
    with pytest.raises(ValueError, match="'d'"):
        Collection.of({"a": mesh}, [("a", "d")])
    with pytest.raises(ValueError, match="nothing to match: 1 shapes"):
        Collection.of({"a": mesh})
    with pytest.raises(ValueError, match="'a__b' cannot be part"):
        Collection.of({"a__b": mesh, "c": mesh})
    for name in ("x.off", "y.ply"):
        write_mesh(mesh, tmp_path / name)
    (tmp_path / "list").write_text("x.off,y.ply\ny.ply,x.off\n")
    assert Collection.of(tmp_path / "list").pairs == (("x", "y"), ("y", "x"))
    assert (
        Collection.of(tmp_path).pairs == Collection.of([tmp_path / "x.off", tmp_path / "y.ply"]).pairs == (("x", "y"),)
    )
    with pytest.raises(ValueError, match="the list says"):
        Collection.of(tmp_path / "list", all_pairs)


def test_wrong_arguments_are_told_before_anything_begins(tmp_path: Path) -> None:
    shapes = {"a": bumpy_sphere(0), "b": bumpy_sphere(0)}
    with pytest.raises(UnknownKey, match="did you mean 'n_samples'"):
        match_collection(shapes, tmp_path / "out", samples=3)
    with pytest.raises(ValueError, match="name that lasts"):
        match_collection(shapes, tmp_path / "out", distance=lambda mesh: None)
    assert not (tmp_path / "out").exists()


def test_functions_in_words_are_the_same_in_every_process() -> None:
    import functools

    import geodesics

    assert in_words(functools.partial(geodesics.scale_invariant, exponent=0.5)).endswith(
        "scale_invariant(exponent=0.5)"
    )
    assert in_words(gmds.Huber()) == repr(gmds.Huber()) and is_lasting(gmds.Huber()) and is_lasting(None)
    assert "0x" not in in_words(object()) and not is_lasting(object())


def test_failures_have_codes() -> None:
    assert Failure.of(TooFewVertices("too few")) == Failure("E113", "too few")
    assert Failure.of(FileNotFoundError(2, "none", "x")).code == "E202"
    assert Failure.of(MemoryError()).code == "E501"
    assert Failure.of(ZeroDivisionError("x")) == Failure("E500", "ZeroDivisionError: x")


def test_the_summary_can_be_opened_in_a_spreadsheet(tmp_path: Path) -> None:
    failed = PairRecord("a", "=b", "failed", failure=Failure("E500", "two\nlines, and a comma"))
    write_summary(tmp_path / "s.csv", [PairRecord("a", "b", "GOOD", 1.0, 0.25, 0.5, 3.0), failed])
    with (tmp_path / "s.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert rows[0]["distortion"] == "0.25" and rows[0]["blame"] == ""
    assert rows[1]["target"] == "'=b" and rows[1]["reason"] == "two lines, and a comma"


def test_a_line_cut_short_harms_no_other(tmp_path: Path) -> None:
    path = tmp_path / "manifest.jsonl"
    path.write_text('{"event": "pa')
    manifest = Manifest(path)
    manifest.tell("run", {"pairs": 3})
    manifest.tell("end", {})
    manifest.close()
    assert [json.loads(line)["event"] for line in path.read_text().splitlines()[1:]] == ["run", "end"]


def test_the_lock_goes_with_the_process(tmp_path: Path) -> None:
    code = (
        "import sys, time; from pathlib import Path; from gmds.batch.lock import only_run\n"
        "with only_run(Path(sys.argv[1])): print('in', flush=True); time.sleep(60)"
    )
    environment = {**os.environ, "PYTHONPATH": str(Path(gmds.__file__).parents[1])}
    with subprocess.Popen([sys.executable, "-c", code, tmp_path], stdout=subprocess.PIPE, env=environment) as child:
        assert child.stdout is not None and child.stdout.readline().strip() == b"in"
        with pytest.raises(FolderInUse, match=f"E503: process {child.pid} on"), only_run(tmp_path):
            pass
        child.kill()
    with only_run(tmp_path), pytest.raises(FolderInUse), only_run(tmp_path):
        pass


def test_a_deadline_is_kept_where_progress_is_told(tmp_path: Path) -> None:
    with deadline(None, tmp_path / "a__b.npz") as progress:
        assert progress is None
    with (
        pytest.raises(PairTimeout, match=r"not done after 0\.01 seconds"),
        deadline(0.01, tmp_path / "a__b.npz") as tell,
    ):
        assert tell is not None
        tell("begun", 0.0)
        time.sleep(0.02)
        tell("going on", 0.5)
    assert list(tmp_path.iterdir()) == []


def test_a_process_that_tells_nothing_is_ended_and_the_next_one_knows(tmp_path: Path) -> None:
    code = (
        "import sys, time; from pathlib import Path; from gmds.batch import deadline\n"
        "deadline.GRACE = 0.1\n"
        "with deadline.deadline(0.1, Path(sys.argv[1])): time.sleep(60)"
    )
    environment = {**os.environ, "PYTHONPATH": str(Path(gmds.__file__).parents[1])}
    path = tmp_path / "a__b.npz"
    assert subprocess.run([sys.executable, "-c", code, path], env=environment, timeout=50, check=False).returncode == 1
    with pytest.raises(PairTimeout), deadline(0.1, path):
        pass
    with deadline(0.1, path):  # told once; the next run may try again
        pass
    assert list(tmp_path.iterdir()) == []


def turned(mesh: Mesh, order: np.ndarray) -> CarriedMap:
    """The map of a mesh to itself that sends vertex i to order[i]."""
    points = SurfacePoints.at_vertices(mesh, order)
    return CarriedMap.of(points, np.ones(len(order), dtype=bool), np.arange(0, len(order), 3), mesh.vertices)


def test_cycles_of_true_maps_lead_home_and_a_wrong_map_is_blamed() -> None:
    mesh = bumpy_sphere(2)
    same, far = np.arange(162), np.argsort(mesh.vertices[:, 0])
    letters = "abcde"
    pairs = list(itertools.permutations(letters, 2))
    wrong = ("b", "d")
    found = consistency(pairs, lambda pair: turned(mesh, far if pair == wrong else same))
    assert len(found.cycles) == 2 * 10 and all(cycle.home for cycle in found.cycles)
    spoilt = [cycle for cycle in found.cycles if wrong in cycle.pairs]
    assert len(spoilt) == 3 and found.cycles[:3] == tuple(spoilt)
    assert all(cycle.mean == 0 and cycle.within_005 == 1 for cycle in found.cycles[3:])
    gap = np.linalg.norm(mesh.vertices[far] - mesh.vertices, axis=1)[::3]
    through = next(cycle for cycle in spoilt if cycle.route[:2] == wrong)
    assert through.mean == pytest.approx(gap.mean() / np.sqrt(mesh.area))
    assert next(iter(found.blame)) == wrong and sorted(found.blame.values())[-2] == 0


def test_one_way_maps_are_compared_with_the_direct_one() -> None:
    mesh = bumpy_sphere(2)
    far = np.argsort(mesh.vertices[:, 0])
    once, twice = turned(mesh, far), turned(mesh, far[far])
    found = consistency([("a", "b"), ("b", "c"), ("a", "c")], lambda pair: twice if pair == ("a", "c") else once)
    assert [str(cycle) for cycle in found.cycles] == ["a > b > c = a > c"] and found.mean == 0
    assert consistency([("a", "b"), ("b", "c")], lambda pair: once) == Consistency(()) and Consistency(()).mean is None


def test_what_is_not_valid_does_not_go_around() -> None:
    mesh = bumpy_sphere(2)
    good = turned(mesh, np.arange(162))
    none = CarriedMap(good.matrix, good.positions + 1, np.zeros(162, dtype=bool), good.samples, good.place, good.size)
    cycles = [("a", "b"), ("b", "c"), ("c", "a")]
    assert consistency(cycles, lambda pair: none if pair == ("c", "a") else good).mean == 1.0
    known = np.arange(162) < 90
    there = np.where(known[:, None], good.positions, 9.0)
    half = CarriedMap(good.matrix, there, known, good.samples, good.place, good.size)
    assert consistency(cycles, lambda pair: half if pair == ("b", "c") else good).mean == 0.0


def test_of_many_triangles_some_are_drawn_the_same_every_time() -> None:
    mesh = bumpy_sphere(0)
    one = turned(mesh, np.arange(12))
    few = list(itertools.combinations("abcdefghij", 2))
    assert len(consistency(few, lambda pair: one, most=50).cycles) == 50
    many = list(itertools.combinations([f"{i:03d}" for i in range(110)], 2))
    found = consistency(many, lambda pair: one, most=30)
    assert 0 < len(found.cycles) <= 30
    assert [c.route for c in found.cycles] == [c.route for c in consistency(many, lambda pair: one, most=30).cycles]


def test_cycles_of_shapes_with_other_numbers_of_vertices() -> None:
    meshes = {name: bumpy_sphere(k) for name, k in (("a", 2), ("b", 1), ("c", 1))}

    def load(pair: tuple[str, str]) -> CarriedMap:
        source, target = (meshes[name] for name in pair)
        points, n = SurfacePoints.closest(target, source.vertices), source.n_vertices
        return CarriedMap.of(points, np.ones(n, dtype=bool), np.arange(n - 1, 0, -3), source.vertices)

    found = consistency([(one, other) for one in "abc" for other in "abc" if one != other], load)
    assert len(found.cycles) == 2 and found.mean is not None and found.mean < 0.1
