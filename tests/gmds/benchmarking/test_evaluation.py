"""The judge: exact where the answer is known, blind to units, and it can say no."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import bumpy_sphere, icosphere, joined, moved, rectangle

from geodesics import Mesh, SurfacePoints
from gmds.benchmarking.datasets import UnknownDataset, dataset_pairs
from gmds.benchmarking.run import benchmark, means, rank_correlation, turned, write_csv
from gmds.benchmarking.truth_files import BadTruth, read_landmarks_mat, read_truth_npz, read_vts
from gmds.correspondence import Correspondence
from gmds.errors import MapError
from gmds.evaluation import coverage, error_curve, geodesic_error, protocol_subset, summary


class SphereDistance:
    """Exact distances on the unit sphere (for points taken as directions)."""

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self.calls: list[int] = []

    def field(self, points: SurfacePoints) -> np.ndarray:
        self.calls.append(len(points))
        return np.arccos(np.clip(points.positions @ self.mesh.vertices.T, -1, 1))


class SeparateComponents:
    """Distance in space within the first `count` vertices; the others cannot be reached."""

    def __init__(self, mesh: Mesh, count: int) -> None:
        self.mesh, self.count = mesh, count

    def field(self, points: SurfacePoints) -> np.ndarray:
        d = np.linalg.norm(points.positions[:, None] - self.mesh.vertices, axis=2)
        d[:, self.count :] = np.inf
        return d


def identity(mesh: Mesh) -> Correspondence:
    return Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)))


def test_the_truth_has_no_error() -> None:
    mesh = bumpy_sphere(2)
    answer = identity(mesh)
    assert (geodesic_error(answer, np.arange(mesh.n_vertices), distance=SphereDistance(mesh)) == 0).all()


def test_errors_are_geodesic_over_root_area() -> None:
    sphere = icosphere(3)
    rng = np.random.default_rng(0)
    true, mapped = rng.integers(0, sphere.n_vertices, (2, 50))
    errors = geodesic_error(SurfacePoints.at_vertices(sphere, mapped), true, distance=SphereDistance(sphere))
    angle = np.arccos(np.clip((sphere.vertices[true] * sphere.vertices[mapped]).sum(axis=1), -1, 1))
    np.testing.assert_allclose(errors, angle / np.sqrt(sphere.area), atol=1e-4)  # chords of one edge
    assert sphere.area == pytest.approx(4 * np.pi, rel=0.01)


def test_the_default_measure_is_the_geodesic_one() -> None:
    """Straight lines on a flat sheet, around the corner of an L-shaped one."""
    sheet = rectangle(20, 20)
    rng = np.random.default_rng(0)
    true, mapped = rng.integers(0, sheet.n_vertices, (2, 40))
    errors = geodesic_error(SurfacePoints.at_vertices(sheet, mapped), true)
    np.testing.assert_allclose(errors, np.linalg.norm(sheet.vertices[true] - sheet.vertices[mapped], axis=1), atol=0.02)
    centre = sheet.vertices[sheet.faces].mean(axis=1)
    elbow = Mesh(sheet.vertices, sheet.faces[(centre[:, 0] < 0.2) | (centre[:, 1] < 0.2)])
    ends = [int(np.linalg.norm(sheet.vertices - corner, axis=1).argmin()) for corner in ([0, 1, 0], [1, 0, 0])]
    expected = 2 * np.hypot(0.2, 0.8) / np.sqrt(elbow.area)
    assert geodesic_error(SurfacePoints.at_vertices(elbow, ends[:1]), ends[1:])[0] == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_units_and_place_do_not_matter(scale: float) -> None:
    mesh = bumpy_sphere(2)
    rng = np.random.default_rng(1)
    face, weights = rng.integers(0, mesh.n_faces, 20), rng.dirichlet(np.ones(3), 20)
    true = rng.integers(0, mesh.n_vertices, 20)
    other = moved(mesh, scale)
    here = geodesic_error(SurfacePoints(mesh, face, weights), true)
    there = geodesic_error(SurfacePoints(other, face, weights), true)
    np.testing.assert_allclose(here, there, rtol=1e-6)


def test_close_to_the_truth_distances_are_straight() -> None:
    """Inside a face that holds the true point nothing is left to marching, whatever it says."""
    mesh = rectangle(4, 4)
    weights = np.random.default_rng(0).dirichlet(np.ones(3), mesh.n_faces)
    mapped = SurfacePoints(mesh, np.arange(mesh.n_faces), weights)
    for truth in (
        SurfacePoints.at_vertices(mesh, mesh.faces[:, 1]),
        SurfacePoints(mesh, np.arange(mesh.n_faces), weights[::-1]),
    ):
        expected = np.linalg.norm(mapped.positions - truth.positions, axis=1)
        np.testing.assert_allclose(geodesic_error(mapped, truth, distance=SphereDistance(mesh)), expected, atol=1e-15)


def test_one_march_for_each_distinct_truth_point() -> None:
    sphere = icosphere(2)
    distance = SphereDistance(sphere)
    true = np.arange(300) % 90
    mapped = SurfacePoints.at_vertices(sphere, (true * 7) % sphere.n_vertices)
    errors = geodesic_error(mapped, true, distance=distance)
    assert sum(distance.calls) == 90
    assert (errors[:90] == errors[90:180]).all()


def test_another_component_counts_as_the_largest_distance() -> None:
    mesh = joined(icosphere(1), icosphere(1))
    mapped = SurfacePoints.at_vertices(mesh, [5, 42 + 5])
    errors = geodesic_error(mapped, [0, 0], distance=SeparateComponents(mesh, 42)) * np.sqrt(mesh.area)
    assert errors[0] == pytest.approx(np.linalg.norm(mesh.vertices[5] - mesh.vertices[0]))
    assert errors[1] == pytest.approx(2)


def test_rows_are_chosen_by_source_index() -> None:
    mesh = icosphere(2)
    errors = geodesic_error(identity(mesh), [4, 9], [4, 8], distance=SphereDistance(mesh))
    assert errors[0] == 0
    assert errors[1] > 0


def test_wrong_requests_are_named() -> None:
    mesh = icosphere(1)
    with pytest.raises(MapError, match="2 truth points for 42"):
        geodesic_error(identity(mesh), [1, 2])
    with pytest.raises(MapError, match="source index 42"):
        geodesic_error(identity(mesh), [1], [42])
    with pytest.raises(MapError, match="same object"):
        geodesic_error(identity(mesh), SurfacePoints.at_vertices(icosphere(1), np.arange(42)))
    with pytest.raises(MapError, match="no errors"):
        summary([])


def test_curve_and_summary_agree_with_counting() -> None:
    errors = np.random.default_rng(0).exponential(0.1, 1000)
    errors[:5] = [0.05, 0.10, 0.25, 0, 0]
    thresholds = [0, 0.05, 0.1, 0.25, 9]
    np.testing.assert_allclose(error_curve(errors, thresholds), [(errors <= t).mean() for t in thresholds])
    assert (np.diff(error_curve(errors)) >= 0).all()
    result = summary(errors)
    assert (result.count, result.mean) == (1000, pytest.approx(100 * errors.mean()))
    assert result.within_010 == pytest.approx(100 * (errors <= 0.1).mean())


def test_the_subset_is_even_and_always_the_same() -> None:
    assert len(protocol_subset(5000)) == 125
    assert (protocol_subset(5000) == protocol_subset(5000)).all()
    assert np.ptp(np.diff(protocol_subset(5000))) <= 1
    assert protocol_subset(31).tolist() == list(range(31))


def test_coverage_is_a_share_of_area() -> None:
    mesh = icosphere(2)
    assert coverage(identity(mesh)) == pytest.approx(1)
    constant = Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.zeros(mesh.n_vertices, int)))
    assert coverage(constant) < 0.02


def write_dataset(folder: Path) -> None:
    from geodesics import write_mesh

    (folder / "corres").mkdir(parents=True)
    shape = bumpy_sphere(2)
    for seed, name in enumerate("abc"):
        order = np.random.default_rng(seed).permutation(shape.n_vertices)
        write_mesh(Mesh(shape.vertices[order], np.argsort(order)[shape.faces]), folder / f"{name}.off")
        line = np.argsort(order) + 1
        (folder / "corres" / f"{name}.vts").write_text("\n".join(map(str, line)))
        (folder / "corres" / f"{name}.sym.vts").write_text("\n".join(map(str, np.roll(line, 1))))
    (folder / "test_pairs.txt").write_text("a\tb\nb\tc\n")


def by_position(source: Mesh, target: Mesh) -> Correspondence:
    """Undo the turning by sorting distances from the centre: enough for a shape without symmetry."""
    keys = [np.argsort(np.linalg.norm(m.vertices - m.vertices.mean(axis=0), axis=1)) for m in (source, target)]
    indices = np.empty(source.n_vertices, dtype=int)
    indices[keys[0]] = keys[1]
    return Correspondence.from_points(source, SurfacePoints.at_vertices(target, indices))


def test_a_benchmark_from_folder_to_table(tmp_path: Path) -> None:
    write_dataset(tmp_path / "set")
    rows = list(benchmark(dataset_pairs(tmp_path / "set"), by_position))
    assert [row.pair for row in rows] == ["a-b", "b-c"]
    for row in rows:
        assert row.direct == pytest.approx(0, abs=1e-9)
        assert row.sym is not None and row.sym > 5
        assert (row.best, row.within_005, row.within_010, row.within_025) == (row.direct, 100, 100, 100)
        assert (row.distortion_correlation, row.valid, row.missing_found) == (None, 100, None)
        assert row.coverage == pytest.approx(100)
    write_csv(tmp_path / "rows.csv", [*rows, *means(rows)])
    lines = (tmp_path / "rows.csv").read_text().splitlines()
    assert lines[0].startswith("pair,group,status,direct,sym,best,within_010,coverage,cpu_seconds")
    assert lines[-1].startswith("mean,all,2 of 2 pairs done,")


def test_honesty_is_measured(tmp_path: Path) -> None:
    """Distortion that ranks points as the error does; rows without a counterpart that are, or are not, called so."""
    write_dataset(tmp_path / "set")
    pair = replace(dataset_pairs(tmp_path / "set")[0], missing=lambda: np.array([3, 4, 5, 6]))

    def shifted(source: Mesh, target: Mesh) -> Correspondence:
        right = by_position(source, target)
        order = np.argsort(np.linalg.norm(target.vertices - target.vertices[0], axis=1))
        wrong = SurfacePoints.at_vertices(target, np.where(np.arange(162) < 60, order[0], right.vertex_map()))
        error = np.linalg.norm(wrong.positions - right.points.positions, axis=1)
        valid = np.arange(162) != 4
        return Correspondence(source, target, wrong, valid, error**2)

    row = next(benchmark([pair], shifted))
    assert row.distortion_correlation is not None and row.distortion_correlation > 0.98
    assert row.valid == pytest.approx(100 * 161 / 162)
    assert row.missing_found == 25


def test_rank_correlation_is_of_ranks() -> None:
    x = np.random.default_rng(0).uniform(size=50)
    assert rank_correlation(x, np.exp(9 * x)) == pytest.approx(1)
    assert rank_correlation(x, -x) == pytest.approx(-1)
    assert rank_correlation(x, np.ones(50)) is None


def test_a_failing_pair_does_not_stop_the_others(tmp_path: Path) -> None:
    write_dataset(tmp_path / "set")
    (tmp_path / "set" / "a.off").write_text("OFF\n1 1 0\n")
    rows = list(benchmark(dataset_pairs(tmp_path / "set"), by_position))
    assert rows[0].status.startswith("failed: ")
    assert rows[0].direct is None
    assert rows[1].direct == pytest.approx(0, abs=1e-9)
    assert means(rows)[0].status == "1 of 2 pairs done"


def test_turning_is_rigid_up_to_size_and_keeps_orientation() -> None:
    mesh = bumpy_sphere(1)
    other = turned(mesh, np.random.default_rng(3))
    d = [np.linalg.norm(m.vertices[:, None] - m.vertices, axis=2) for m in (mesh, other)]
    ratio = d[1].max() / d[0].max()
    np.testing.assert_allclose(d[1], d[0] * ratio, atol=1e-9 * ratio)
    frame = np.linalg.lstsq(mesh.vertices, other.vertices, rcond=None)[0]
    assert np.linalg.det(frame) > 0


def test_unknown_folders_and_listings_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UnknownDataset, match="not a known benchmark"):
        dataset_pairs(tmp_path)
    write_dataset(tmp_path / "set")
    (tmp_path / "list.txt").write_text("# comment\na, b\n\nc\n")
    with pytest.raises(UnknownDataset, match="entry 2"):
        dataset_pairs(tmp_path / "set", tmp_path / "list.txt")


@pytest.mark.parametrize("text", ["", "1\n0\n", "1\n-3\n", "1\n2.5\n", "one\n", "9" * 30])
def test_bad_vts_files_are_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "x.vts").write_text(text)
    with pytest.raises(BadTruth, match="E231"):
        read_vts(tmp_path / "x.vts")


def test_vts_is_one_based(tmp_path: Path) -> None:
    (tmp_path / "x.vts").write_text("1\n5\r\n2")
    assert read_vts(tmp_path / "x.vts").tolist() == [0, 4, 1]


def test_truth_npz_and_mat_are_checked(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", src=np.arange(3), gt=np.arange(4))
    np.savez(tmp_path / "b.npz", src=np.arange(3))
    np.savez(tmp_path / "c.npz", src=np.arange(3), gt=np.array([object()] * 3))
    (tmp_path / "d.npz").write_bytes(b"nothing")
    for name in "abcd":
        with pytest.raises(BadTruth):
            read_truth_npz(tmp_path / f"{name}.npz")
    (tmp_path / "d.mat").write_bytes(b"nothing")
    with pytest.raises(BadTruth):
        read_landmarks_mat(tmp_path / "d.mat")


def test_pairs_json_names_groups(tmp_path: Path) -> None:
    (tmp_path / "scaled").mkdir()
    entry = {"name": "p", "group": "self", "source": "x/a.off", "target": "scaled/b.off", "truth": "scaled/b.npz"}
    (tmp_path / "scaled" / "pairs.json").write_text(json.dumps([entry, {**entry, "name": "q"}]))
    pair = dataset_pairs(tmp_path / "scaled")[0]
    assert (pair.source, pair.group) == (tmp_path / "x" / "a.off", "self")
    (tmp_path / "list").write_text("q\n")
    assert [pair.name for pair in dataset_pairs(tmp_path / "scaled", tmp_path / "list")] == ["q"]
    (tmp_path / "list").write_text("r\n")
    with pytest.raises(UnknownDataset, match="'r'"):
        dataset_pairs(tmp_path / "scaled", tmp_path / "list")


@pytest.mark.skipif("GMDS_DATA" not in os.environ, reason="GMDS_DATA is not set")
@pytest.mark.parametrize(
    ("folder", "pairs", "flipped"),
    [
        ("faust_5k", 97, True),
        ("tosca_5k", 110, True),
        ("tosca_cross_5k", 30, True),
        ("scaled", 10, True),
        ("shrec20", 14, False),
        ("partial", 50, True),
    ],
)
def test_published_folders_are_read(folder: str, pairs: int, flipped: bool) -> None:
    from geodesics import read_mesh

    found = dataset_pairs(Path(os.environ["GMDS_DATA"]) / folder)
    assert len(found) >= pairs
    source, target = read_mesh(found[-1].source), read_mesh(found[-1].target)
    indices, truth, mirrored = found[-1].truth(source, target)
    assert len(indices) == len(truth) >= 20
    assert indices.max() < source.n_vertices
    assert (mirrored is not None) == flipped


@pytest.mark.skipif("GMDS_DATA" not in os.environ, reason="GMDS_DATA is not set")
def test_landmark_points_lie_at_their_vertices() -> None:
    """The .mat files say everything twice, so a wrong index base would show."""
    from geodesics import read_mesh

    for name in ("dog", "camel_a"):
        root = Path(os.environ["GMDS_DATA"]) / "shrec20"
        mesh = read_mesh(root / "models" / f"{name}.obj")
        ids, vertices, faces, weights = read_landmarks_mat(root / "gts" / f"{name}.mat")
        gap = np.linalg.norm(SurfacePoints(mesh, faces, weights).positions - mesh.vertices[vertices], axis=1)
        assert gap.max() < 0.05 * np.sqrt(mesh.area)
        assert (12 in ids) == (name == "dog")
