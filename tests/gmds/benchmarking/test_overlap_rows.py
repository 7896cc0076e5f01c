"""What has no counterpart is told as it is counted, from truth in files and maps, through both commands."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from cut_shapes import animal_on_half, half_animal
from hypothesis import given
from hypothesis import strategies as st

from geodesics import Mesh, SurfacePoints, write_mesh
from gmds import Correspondence
from gmds.benchmarking.datasets import dataset_pairs
from gmds.benchmarking.overlap import overlap_scores
from gmds.benchmarking.run import benchmark, means, write_csv
from gmds.benchmarking.truth_files import BadTruth, read_missing_npz
from gmds.cli import main
from gmds.errors import MapError

SETS = st.sets(st.integers(0, 29))


@given(said=SETS, there=SETS, missing=SETS)
def test_scores_are_those_of_sets(said: set[int], there: set[int], missing: set[int]) -> None:
    valid = np.isin(np.arange(30), list(said))
    found = overlap_scores(valid, [*there, *there], list(missing))
    judged = said & (there | missing)
    either = judged | there
    assert found.iou == (len(judged & there) / len(either) if either else None)
    assert found.precision == (len(judged & there) / len(judged) if judged else None)
    assert found.recall == (len(said & there) / len(there) if there else None)


def test_all_that_is_right_scores_one_and_all_valid_scores_the_share() -> None:
    there, missing = np.arange(60), np.arange(60, 100)
    right = overlap_scores(np.arange(100) < 60, there, missing)
    assert (right.iou, right.precision, right.recall) == (1, 1, 1)
    everything = overlap_scores(np.ones(100, dtype=bool), there, missing)
    assert (everything.iou, everything.precision, everything.recall) == (0.6, 0.6, 1)
    with pytest.raises(MapError, match="source index 100"):
        overlap_scores(np.ones(100, dtype=bool), there, [100])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Half an animal and all of it, both ways, as `partial/pairs.json` has them."""
    root = tmp_path_factory.mktemp("data")
    half, (there, true) = half_animal(1000), animal_on_half(1000)
    (root / "partial").mkdir()
    for name, mesh in (("half", half.part), ("whole", half.whole)):
        write_mesh(Mesh(mesh.vertices, mesh.faces), root / "partial" / f"{name}.off")
    missing = np.setdiff1d(np.arange(half.whole.n_vertices), there)
    truths = {
        "onto": {"src": np.arange(len(half.kept)), "gt": half.true.nearest_vertices(), "missing": missing[:0]},
        "back": {"src": there, "gt": true.nearest_vertices(), "missing": missing},
        "silent": {"src": there, "gt": true.nearest_vertices()},
    }
    entries = []
    for name, arrays in truths.items():
        np.savez(root / "partial" / f"{name}.npz", **arrays)
        files = ("half", "whole") if name == "onto" else ("whole", "half")
        entry = {key: f"partial/{file}.off" for key, file in zip(("source", "target"), files, strict=True)}
        entries.append({"name": name, "group": name, "truth": f"partial/{name}.npz", **entry})
    (root / "partial" / "pairs.json").write_text(json.dumps(entries))
    return root / "partial"


def by_truth(source: Mesh, target: Mesh) -> Correspondence:
    """The true map, in whatever position, with one vertex in ten called missing that is not, and one the other way."""
    half, (there, true) = half_animal(1000), animal_on_half(1000)
    if source.n_vertices < target.n_vertices:
        points = SurfacePoints(target, half.true.face, half.true.barycentric)
        return Correspondence.from_points(source, points, valid=np.arange(len(points)) % 10 > 0)
    face, weights = np.zeros(source.n_vertices, dtype=np.int64), np.tile(np.eye(3)[0], (source.n_vertices, 1))
    face[there], weights[there] = true.face, true.barycentric
    valid = np.isin(np.arange(source.n_vertices), there) != (np.arange(source.n_vertices) % 10 == 0)
    return Correspondence.from_points(source, SurfacePoints(target, face, weights), valid=valid)


def test_a_benchmark_of_parts_says_what_was_marked(folder: Path, tmp_path: Path) -> None:
    onto, back, silent = list(benchmark(dataset_pairs(folder), by_truth))
    assert (onto.overlap_iou, onto.valid_precision, onto.missing_found) == (onto.valid_recall, 100, None)
    assert onto.valid_recall == onto.valid == pytest.approx(90, abs=0.5)
    mistakes = np.arange(half_animal(1000).whole.n_vertices) % 10 == 0
    there = np.isin(np.arange(len(mistakes)), animal_on_half(1000)[0])
    assert back.valid_recall == pytest.approx(100 * (1 - mistakes[there].mean()))
    assert back.missing_found == pytest.approx(100 * (1 - mistakes[~there].mean()))
    right, wrong = (there & ~mistakes).sum(), (~there & mistakes).sum()
    assert back.valid_precision == pytest.approx(100 * right / (right + wrong))
    assert back.overlap_iou == pytest.approx(100 * right / (there.sum() + wrong))
    assert silent.overlap_iou is silent.valid_precision is silent.valid_recall is None
    assert max(onto.direct or 9, back.direct or 9) < 2  # truth in files is at vertices
    write_csv(tmp_path / "rows.csv", [onto, back, silent, *means([onto, back, silent])])
    assert (tmp_path / "rows.csv").read_text().splitlines()[0].endswith("overlap_iou,valid_precision,valid_recall")


def test_evaluate_tells_the_overlap_where_the_truth_says_what_is_missing(folder: Path, tmp_path: Path) -> None:
    half = half_animal(1000)
    whole, part = (Mesh(mesh.vertices, mesh.faces) for mesh in (half.whole, half.part))
    answer = by_truth(whole, part)
    answer.save(tmp_path / "map.npz")
    write_mesh(whole, tmp_path / "whole.ply")
    write_mesh(part, tmp_path / "half.ply")
    files = ["--source", str(tmp_path / "whole.ply"), "--target", str(tmp_path / "half.ply"), "--json"]
    said = {}
    for name in ("back", "silent"):
        done = CliRunner().invoke(
            main, ["evaluate", str(tmp_path / "map.npz"), *files, "--truth", str(folder / f"{name}.npz")]
        )
        assert done.exit_code == 0, done.output
        said[name] = json.loads(done.stdout)
    row = next(row for row in benchmark(dataset_pairs(folder), by_truth) if row.pair == "back")
    expected = {"iou": row.overlap_iou, "precision": row.valid_precision, "recall": row.valid_recall}
    assert said["back"]["overlap"] == pytest.approx(expected)
    assert "overlap" not in said["silent"]


def test_missing_is_read_and_checked(folder: Path, tmp_path: Path) -> None:
    half = half_animal(1000)
    assert read_missing_npz(folder / "silent.npz") is None
    onto = read_missing_npz(folder / "onto.npz")
    assert onto is not None and len(onto) == 0
    by_truth(half.part, half.whole).save(tmp_path / "map.npz")
    of_map = read_missing_npz(tmp_path / "map.npz")
    assert of_map is not None and np.array_equal(of_map, np.arange(0, half.part.n_vertices, 10))
    for name, wrong in (("fractions", [0.5]), ("negative", [-1])):
        np.savez(tmp_path / f"{name}.npz", src=[0], gt=[0], missing=wrong)
        with pytest.raises(BadTruth, match="missing must be whole numbers"):
            read_missing_npz(tmp_path / f"{name}.npz")
