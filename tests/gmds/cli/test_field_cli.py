"""The commands that measure one surface, or carry values along a map: files and pictures against the library."""

from __future__ import annotations

import csv
import itertools
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from generated_shapes import bumpy_sphere, ellipsoid, icosphere, joined

import geodesics
from geodesics import SurfacePoints, write_mesh
from geodesics.smoothing import WHOLE_MATCH
from gmds.appearance import Look, read_look, write_look
from gmds.cli import main
from gmds.cli.choices import METRICS
from gmds.correspondence import Correspondence
from gmds.files.values import BadValuesFile, read_values

MESH = bumpy_sphere(2)  # 162 vertices
WEIGHTS = [0.4, 0.35, 0.25]  # any two outweigh the third
POINTS = SurfacePoints.at_vertices(MESH, [3, 100])


def run(*args: object) -> Result:
    return CliRunner().invoke(main, [str(arg) for arg in args])


def done(*args: object) -> dict[str, Any]:
    result = run(*args, "--json")
    assert result.exit_code == 0, result.output
    said: dict[str, Any] = json.loads(result.stdout)
    return said


def refused(*args: object, code: int = 1) -> str:
    result = run(*args)
    assert result.exit_code == code, result.output
    assert not result.stdout
    return result.stderr


def arrays(path: Path) -> dict[str, Any]:
    with np.load(path, allow_pickle=False) as archive:
        return dict(archive)


def table(path: Path) -> tuple[list[str], list[list[str]]]:
    with path.open(encoding="utf-8", newline="") as stream:
        header, *rows = csv.reader(stream)
    return header, rows


@pytest.fixture
def file(tmp_path: Path) -> Path:
    write_mesh(MESH, tmp_path / "shape.off")
    return tmp_path / "shape.off"


def test_distances_from_landmarks_have_their_names(file: Path, tmp_path: Path) -> None:
    """Positions and vertices, one without a place, and one called as a landmark of another file is."""
    (tmp_path / "m.csv").write_text("name,x,y,z\nnose,{},{},{}\ntail,NA,NA,NA\n".format(*MESH.vertices[100]))
    (tmp_path / "n.csv").write_text("name,vertex\nnose,3\n")
    (tmp_path / "off.csv").write_text("name,x,y,z\nnose,90,90,90\n")
    said = done("distances", file, "--from", tmp_path / "m.csv", "-o", tmp_path / "d.csv")
    field = geodesics.GeodesicDistance(geodesics.embedded(geodesics.read_mesh(file))).field([100, 3])
    with (tmp_path / "d.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert said["points"] == [100] and list(rows[0]) == ["vertex", "from_nose"]
    assert np.array_equal([float(row["from_nose"]) for row in rows], field[0])
    both = ("--from", tmp_path / "m.csv", "--from", tmp_path / "n.csv")
    done("distances", file, *both, "-o", tmp_path / "d.csv")
    with (tmp_path / "d.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert np.array_equal([float(row["from_nose_3"]) for row in rows], field[1])
    done("distances", file, *both, "--from", 7, "-o", tmp_path / "d.npz")
    written = arrays(tmp_path / "d.npz")
    assert written["names"].tolist() == ["nose", "nose", "7"] and written["points"].tolist() == [100, 3, 7]
    assert "E305" in refused("distances", file, "--from", tmp_path / "off.csv", "-o", tmp_path / "e.csv")
    assert "none.csv" in refused("distances", file, "--from", tmp_path / "none.csv", "-o", tmp_path / "e.csv")


def test_distances_are_those_of_the_library(file: Path) -> None:
    out = file.with_suffix(".npz")
    said = done("distances", file, "--from", 3, "--from", 100, "-o", out)
    expected = geodesics.GeodesicDistance(geodesics.embedded(MESH)).field(POINTS)
    written = arrays(out)
    assert said["points"] == [3, 100] and written["points"].tolist() == [3, 100]
    np.testing.assert_array_equal(written["distance"], expected)
    assert said["largest"] == expected.max() and said["unreachable"] == 0


@pytest.mark.parametrize("name", ["biharmonic", "commute-time", "diffusion"])
def test_spectral_distances_in_another_metric(file: Path, name: str) -> None:
    out = file.with_suffix(".npz")
    done("distances", file, "--from", 3, "--metric", "scale-invariant", "--distance", name, "-o", out)
    spectrum = geodesics.eigenpairs(geodesics.scale_invariant(MESH, smoothing=WHOLE_MATCH), 100)
    distance: dict[str, Any] = {
        "biharmonic": geodesics.BiharmonicDistance,
        "commute-time": geodesics.CommuteTimeDistance,
        "diffusion": lambda spectrum: geodesics.DiffusionDistance(spectrum, 3e-3),
    }
    expected = distance[name](spectrum).field(POINTS[[0]])
    np.testing.assert_allclose(arrays(out)["distance"], expected, rtol=1e-6, atol=1e-9 * expected.max())


@pytest.mark.parametrize("metric", METRICS)
def test_a_table_keeps_every_bit_in_every_metric(file: Path, metric: str) -> None:
    options = ["distances", file, "--from", 3, "--from", 100, "--metric", metric]
    done(*options, "-o", file.with_suffix(".npz"))
    done(*options, "-o", file.with_suffix(".csv"))
    header, rows = table(file.with_suffix(".csv"))
    assert header == ["vertex", "from_3", "from_100"]
    assert [row[0] for row in rows] == [str(i) for i in range(MESH.n_vertices)]
    written = np.array([[float(word) for word in row[1:]] for row in rows])
    np.testing.assert_array_equal(written.T, arrays(file.with_suffix(".npz"))["distance"])


def test_farthest_points_and_what_can_not_be_reached(tmp_path: Path) -> None:
    two = joined(icosphere(1), icosphere(1))
    write_mesh(two, tmp_path / "two.off")
    said = done("distances", tmp_path / "two.off", "--from", "farthest:3", "--from", 7, "-o", tmp_path / "d.csv")
    distance = geodesics.GeodesicDistance(geodesics.embedded(two))
    assert said["points"] == [*geodesics.farthest_point_sampling(distance, 3).tolist(), 7]
    assert said["unreachable"] == 4 * 42
    assert sum(word == "inf" for row in table(tmp_path / "d.csv")[1] for word in row) == 4 * 42


@pytest.mark.parametrize(
    ("start", "code", "told"),
    [
        ("162", 1, "E105: point 0 = 162 refers outside the 162 vertices"),
        ("farthest:163", 1, "--from farthest:163: count must be 1 to 162"),
        ("-1", 2, "'-1' is neither a vertex number"),
        ("nose", 2, "'nose' is neither"),
        ("farthest:0", 2, "'farthest:0' is neither"),
    ],
)
def test_a_wrong_start_is_named(file: Path, start: str, code: int, told: str) -> None:
    assert told in refused("distances", file, f"--from={start}", "-o", file.with_suffix(".npz"), code=code)
    assert not file.with_suffix(".npz").exists()


def test_voronoi_cells_are_those_of_the_library(file: Path) -> None:
    said = done("voronoi", file, "--samples", 9, "-o", file.with_suffix(".npz"))
    done("voronoi", file, "--samples", 9, "-o", file.with_suffix(".csv"))
    distance = geodesics.GeodesicDistance(geodesics.embedded(MESH))
    samples = geodesics.farthest_point_sampling(distance, 9)
    cells = geodesics.voronoi_cells(distance, samples)
    written = arrays(file.with_suffix(".npz"))
    assert said["samples"] == samples.tolist() == written["samples"].tolist()
    np.testing.assert_array_equal(written["cell"], cells)
    nearest = distance.field(SurfacePoints.at_vertices(MESH, samples)).min(axis=0)
    np.testing.assert_allclose(written["distance"], nearest, rtol=1e-6, atol=1e-12)
    assert said["radius"] == written["distance"].max()
    header, rows = table(file.with_suffix(".csv"))
    assert header == ["vertex", "cell", "sample", "distance"]
    assert [(int(row[1]), int(row[2])) for row in rows] == list(zip(cells, samples[cells], strict=True))


def test_an_island_without_a_sample_is_in_no_cell(tmp_path: Path) -> None:
    write_mesh(joined(icosphere(1), icosphere(1)), tmp_path / "two.off")
    said = done("voronoi", tmp_path / "two.off", "--samples", 1, "-o", tmp_path / "v.csv")
    rows = table(tmp_path / "v.csv")[1]
    assert said["unreachable"] == sum(row[1:] == ["-1", "-1", "inf"] for row in rows) == 42


def test_too_many_samples_are_refused(file: Path) -> None:
    assert "--samples 163: count must be 1 to 162" in refused("voronoi", file, "--samples", 163, "-o", "v.npz")


def test_signatures_are_those_of_the_library(file: Path) -> None:
    out, times = file.with_suffix(".npz"), [0.01, 0.1]
    spectrum = geodesics.eigenpairs(geodesics.embedded(MESH), 100)
    expected: dict[str, Any] = {
        "hks": geodesics.heat_kernel_signature(spectrum, times),
        "scaled-hks": geodesics.scaled_heat_kernel_signature(spectrum, times),
        "si-hks": geodesics.scale_invariant_heat_kernel_signature(spectrum),
        "wks": geodesics.wave_kernel_signature(spectrum, 12),
    }
    given: dict[str, list[object]] = {"wks": ["--energies", 12], "si-hks": []}
    for kind, signature in expected.items():
        said = done("signatures", file, "--kind", kind, *given.get(kind, ["--times", "0.01,0.1"]), "-o", out)
        written = arrays(out)
        np.testing.assert_allclose(written["signature"], signature, rtol=1e-6, atol=1e-9 * signature.max())
        assert (said["kind"], said["columns"]) == (kind, signature.shape[1])
        assert ("times" in written) == (kind in ("hks", "scaled-hks"))
        assert written.get("times", np.array(times)).tolist() == times


def test_signatures_by_default_and_as_a_table(file: Path) -> None:
    done("signatures", file, "-o", file.with_suffix(".npz"))
    done("signatures", file, "-o", file.with_suffix(".csv"))
    written = arrays(file.with_suffix(".npz"))
    header, rows = table(file.with_suffix(".csv"))
    assert written["signature"].shape == (162, 16) and (np.diff(written["times"]) > 0).all()
    assert (np.diff(written["signature"], axis=1) <= 0).all()  # heat that stays only ever fades
    assert header == ["vertex", *(f"t={t:.6g}" for t in written["times"])]
    np.testing.assert_array_equal(np.array(rows, dtype=float)[:, 1:], written["signature"])


@pytest.mark.parametrize(
    ("options", "code", "told"),
    [
        (["--kind", "wks", "--times", "1"], 2, "--times are of heat"),
        (["--energies", 9], 2, "--energies are of wks"),
        (["--times", "0.1;0.2"], 2, "'0.1;0.2' must be numbers"),
        (["--times", "0.1,nan"], 1, "times must be finite numbers"),
        (["--kind", "si-hks", "--times", "1,2,3"], 1, "constant factor"),
    ],
)
def test_wrong_times_and_energies_are_refused(file: Path, options: list[object], code: int, told: str) -> None:
    assert told in refused("signatures", file, *options, "-o", file.with_suffix(".npz"), code=code)


@pytest.mark.parametrize("name", ["distances", "voronoi", "signatures"])
def test_an_unknown_ending_is_named_before_anything_is_read(tmp_path: Path, name: str) -> None:
    start = ["--from", 0] if name == "distances" else []
    told = refused(name, tmp_path / "nothing.off", *start, "-o", "out.mat", code=2)
    assert "'out.mat' must end in .npz or .csv" in told
    assert "'p.tif' must end in .png" in refused(name, "x.off", *start, "-o", "o.npz", "--picture", "p.tif", code=2)
    assert "nothing.off" in refused(name, tmp_path / "nothing.off", *start, "-o", tmp_path / "out.npz")


@pytest.mark.parametrize("name", ["distances", "voronoi", "signatures"])
def test_pictures_and_plain_words(file: Path, name: str) -> None:
    pytest.importorskip("matplotlib")
    picture = file.parent / "p.png"
    start = ["--from", 0] if name == "distances" else []
    result = run(name, file, *start, "-o", file.with_suffix(".npz"), "--picture", picture)
    assert result.exit_code == 0, result.output
    assert "vertices:" in result.stdout and f"wrote {picture}" in result.stderr
    assert picture.read_bytes().startswith(b"\x89PNG") and picture.stat().st_size > 5000


@pytest.fixture
def carry(tmp_path: Path) -> list[object]:
    """gmds transfer with a map from an ellipsoid of 42 vertices into the faces of the mesh."""
    source = ellipsoid(1)
    points = SurfacePoints(MESH, np.arange(42) * 7, np.tile(WEIGHTS, (42, 1)))
    write_mesh(source, tmp_path / "a.off")
    write_mesh(MESH, tmp_path / "b.off")
    valid = np.arange(42) > 1
    Correspondence.from_points(source, points, valid=valid).save(tmp_path / "map.npz")
    return ["transfer", tmp_path / "map.npz", "--source", tmp_path / "a.off", "--target", tmp_path / "b.off"]


def blended(values: np.ndarray) -> np.ndarray:
    corners = values[MESH.faces[np.arange(42) * 7]]
    return np.einsum("k,pk...->p...", WEIGHTS, corners)


def test_numbers_are_interpolated(carry: list[object], tmp_path: Path) -> None:
    np.save(tmp_path / "v.npy", MESH.vertices)
    said = done(*carry, "--values", tmp_path / "v.npy", "-o", tmp_path / "out.npy")
    np.testing.assert_allclose(np.load(tmp_path / "out.npy"), blended(MESH.vertices), rtol=1e-14, atol=1e-15)
    assert said["carried"] == "by interpolation" and said["columns"] == 3
    assert (said["valid"], said["vertices"]) == (40, 42)


def test_a_table_of_one_command_is_read_by_another(carry: list[object], tmp_path: Path) -> None:
    done("distances", tmp_path / "b.off", "--from", 5, "--from", 9, "-o", tmp_path / "d.csv")
    done(*carry, "--values", tmp_path / "d.csv", "-o", tmp_path / "out.csv")
    field = geodesics.GeodesicDistance(geodesics.embedded(MESH)).field(SurfacePoints.at_vertices(MESH, [5, 9]))
    header, rows = table(tmp_path / "out.csv")
    assert header == ["vertex", "value_0", "value_1"]
    np.testing.assert_allclose(np.array(rows, dtype=float)[:, 1:], blended(field.T), rtol=1e-14)


@pytest.mark.parametrize("kind", ["number", "word"])
def test_labels_go_by_majority(carry: list[object], tmp_path: Path, kind: str) -> None:
    pytest.importorskip("matplotlib")
    part = np.arange(MESH.n_vertices) % 3 if kind == "number" else np.array(["=leg", "ear", "tail"])[np.arange(162) % 3]
    (tmp_path / "parts.txt").write_text("\n".join(map(str, part)), encoding="utf-8")
    options = ["--values", tmp_path / "parts.txt", "--labels", "--picture", tmp_path / "p.png"]
    done(*carry, *options, "-o", tmp_path / "out.npy")
    carried = np.load(tmp_path / "out.npy", allow_pickle=False)
    assert carried.dtype.kind == part.dtype.kind
    corners = part[MESH.faces[np.arange(42) * 7]]
    two = corners[:, 1] == corners[:, 2]
    assert (two & (corners[:, 0] != corners[:, 1])).any()
    assert (carried == np.where(two, corners[:, 1], corners[:, 0])).all()
    done(*carry, *options[:3], "-o", tmp_path / "out.csv")
    assert [row[1].lstrip("'") for row in table(tmp_path / "out.csv")[1]] == carried.astype(str).tolist()
    assert ("'=leg" in (tmp_path / "out.csv").read_text()) == (kind == "word")
    said = done(*carry, *options[:3], "-o", tmp_path / "out.vtp")
    assert said.get("labels") == (["=leg", "ear", "tail"] if kind == "word" else None)
    assert (tmp_path / "p.png").stat().st_size > 5000


def test_whole_numbers_without_labels_are_remarked_on(carry: list[object], tmp_path: Path) -> None:
    np.save(tmp_path / "v.npy", np.arange(162))
    result = run(*carry, "--values", tmp_path / "v.npy", "-o", tmp_path / "out.npy")
    assert result.exit_code == 0 and "--labels" in result.stderr
    np.testing.assert_allclose(np.load(tmp_path / "out.npy"), blended(np.arange(162)))


def test_weights_keep_summing_to_one_and_vectors_turn(carry: list[object], tmp_path: Path) -> None:
    weights = np.random.default_rng(1).random((MESH.n_vertices, 4)) * np.arange(4)
    np.save(tmp_path / "w.npy", weights)
    done(*carry, "--values", tmp_path / "w.npy", "--kind", "weights", "-o", tmp_path / "out.npy")
    carried = np.load(tmp_path / "out.npy")
    assert np.allclose(carried.sum(axis=1), 1, atol=1e-14) and (carried >= 0).all() and (carried[:, 0] == 0).all()
    np.testing.assert_allclose(carried, blended(weights / weights.sum(axis=1, keepdims=True)), atol=1e-14)
    weights[:81] = 0
    np.save(tmp_path / "w.npy", weights)
    few = done(*carry, "--values", tmp_path / "w.npy", "--kind", "weights", "--most", 2, "-o", tmp_path / "few.npy")
    sums = np.load(tmp_path / "few.npy").sum(axis=1)
    assert set(np.round(sums, 12)) == {0, 1} and few["without_weights"] == (sums == 0).sum() > 0
    assert ((np.load(tmp_path / "few.npy") > 0).sum(axis=1) <= 2).all()
    other = [*carry, "--values", tmp_path / "w.npy", "--most", 2, "-o", tmp_path / "o.npy"]
    assert "--kind weights" in refused(*other, code=2)
    np.savetxt(tmp_path / "parts.txt", np.arange(MESH.n_vertices) % 2 + 1, fmt="%d")
    labels = refused(*carry, "--values", tmp_path / "parts.txt", "--kind", "weights", "-o", tmp_path / "o.npy", code=2)
    assert "parts.txt holds one column, of whole numbers up to 2" in labels and "--kind labels" in labels
    np.savetxt(tmp_path / "one.txt", np.ones(MESH.n_vertices))
    done(*carry, "--values", tmp_path / "one.txt", "--kind", "weights", "-o", tmp_path / "one.npy")
    weights[5] = -1
    np.save(tmp_path / "w.npy", weights)
    assert "vertex 5" in refused(*carry, "--values", tmp_path / "w.npy", "--kind", "weights", "-o", tmp_path / "o.npy")
    np.save(tmp_path / "v.npy", MESH.vertices)
    said = done(*carry, "--values", tmp_path / "v.npy", "--kind", "vectors", "-o", tmp_path / "out.vtp")
    assert said["carried"] == "turned as the map turns the surface"
    assert b'Name="value" NumberOfComponents="3"' in (tmp_path / "out.vtp").read_bytes()


def test_colours_go_to_meshes(carry: list[object], tmp_path: Path) -> None:
    colours = np.random.default_rng(1).integers(0, 256, (MESH.n_vertices, 3)).astype(np.uint8)
    np.save(tmp_path / "c.npy", colours)
    for ending in (".ply", ".obj", ".glb"):
        out = tmp_path / f"out{ending}"
        done(*carry, "--values", tmp_path / "c.npy", "--kind", "colours", "-o", out)
        found = read_look(out, geodesics.read_mesh(out)).colours
        assert found is not None and np.abs(found - np.rint(blended(colours))).max() <= 1
    write_look(tmp_path / "b.ply", MESH, Look(colours))
    again = [carry[5] if one == carry[5] else one for one in carry[:5]] + [tmp_path / "b.ply"]
    said = done(*again, "-o", tmp_path / "again.ply")
    assert said["carried"] == "by interpolation, as colours"
    assert (tmp_path / "again.ply").read_bytes() == (tmp_path / "out.ply").read_bytes()
    np.save(tmp_path / "c.npy", colours * 2.0)
    assert "0 to 255" in refused(
        *carry, "--values", tmp_path / "c.npy", "--kind", "colours", "-o", tmp_path / "o.ply", code=2
    )


def test_a_texture_goes_along_and_its_seams_are_told(carry: list[object], tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image").new("RGB", (8, 8), (200, 10, 10))
    uv = (
        MESH.vertices[MESH.faces][..., :2]
        + np.where(MESH.vertices[MESH.faces][..., 2].mean(axis=1) < 0, 5, 0)[:, None, None]
    )
    write_look(tmp_path / "b.obj", MESH, Look(uv=uv, image=image))
    again = [*carry[:5], tmp_path / "b.obj"]
    said = done(*again, "--texture", tmp_path / "b.png", "-o", tmp_path / "out.obj")
    assert said["carried"] == "texture" and 0 < said["faces_on_seams"] < 80 and len(said["files"]) == 3
    look = read_look(tmp_path / "out.obj", geodesics.read_mesh(tmp_path / "out.obj"))
    assert look.uv is not None and (np.ptp(look.uv, axis=1) < 4).all()
    without = run(*again, "-o", tmp_path / "out.glb")
    assert without.exit_code == 0 and "give it with --texture" in without.stderr
    assert "neither colours nor texture" in refused(*carry, "-o", tmp_path / "o.glb", code=2)
    assert "give --values" in refused(*carry, "-o", tmp_path / "o.npy", code=2)
    assert "--values" in refused(*again, "--kind", "colours", "-o", tmp_path / "o.glb", code=2)


def test_values_that_do_not_fit_are_refused(carry: list[object], tmp_path: Path) -> None:
    out = tmp_path / "out.npy"
    np.save(tmp_path / "v.npy", np.arange(42.0))
    told = refused(*carry, "--values", tmp_path / "v.npy", "-o", out)
    assert "E307" in told and "v.npy has 42 rows; the target has 162 vertices" in told
    np.save(tmp_path / "v.npy", np.array(["leg"] * 162))
    assert "give --labels" in refused(*carry, "--values", tmp_path / "v.npy", "-o", out, code=2)
    swapped = [*carry[:2], "--source", carry[5], "--target", carry[3]]
    assert "E212" in refused(*swapped, "--values", tmp_path / "v.npy", "-o", out)
    assert "'v.mat' must end in .npy or .csv or .txt" in refused(*carry, "--values", "v.mat", "-o", out, code=2)
    assert not out.exists()


@pytest.mark.parametrize(
    ("name", "content", "told"),
    [
        ("v.csv", b"1\n2\nx\n", "line 3: 'x' is not a number; give --labels"),
        ("v.csv", b"a,b\n1,2\n3\n4,5\n", "line 3: 1 entries where the first row has 2"),
        ("v.csv", b"vertex,h\n0,2\n2,3\n1,5\n", "line 3: vertex '2' where 1 should be"),
        ("v.txt", b"1\n2\n", "has 2 rows; the target has 3 vertices"),
        ("v.csv", b"vertex,h\n0,1\n1,2\n", "has 2 rows below its header; the target has 3 vertices"),
        ("v.csv", b"h,w\n1,1\n2,2\n", "has 2 rows below its header; the target has 3 vertices"),
        ("v.csv", b"h\n1\n2\n3\n4\n", "has 4 rows below its header"),
        ("v.txt", b"1\n2\n3\n4\n5\n", "has 5 rows"),
        ("v.txt", b"", "has 0 rows"),
        ("v.txt", b"1\n\xff\n3\n", "not UTF-8"),
        ("v.npy", b"\x93NUMPY\x01", "not a readable .npy"),
        ("v.npy", b"", "not a readable .npy"),
    ],
)
def test_bad_values_are_named_with_their_line(tmp_path: Path, name: str, content: bytes, told: str) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(BadValuesFile, match="E307") as caught:
        read_values(tmp_path / name, 3)
    assert told in str(caught.value) and name in str(caught.value)


def test_pickled_and_structured_values_are_refused(tmp_path: Path) -> None:
    np.save(tmp_path / "v.npy", np.array([{}, {}, {}]), allow_pickle=True)
    with pytest.raises(BadValuesFile, match="pickled objects"):
        read_values(tmp_path / "v.npy", 3)
    np.save(tmp_path / "v.npy", np.zeros(3, dtype=[("x", float)]))
    with pytest.raises(BadValuesFile, match="write numbers or words"):
        read_values(tmp_path / "v.npy", 3)
    np.save(tmp_path / "v.npy", np.float64(1))
    with pytest.raises(BadValuesFile, match="a single value"):
        read_values(tmp_path / "v.npy", 3)
    with pytest.raises(OSError, match="not a regular file"):
        read_values(tmp_path, 3)


def test_text_with_and_without_a_header(tmp_path: Path) -> None:
    tables = ("1\n2.5\n3\n", "height\n1\n2.5\n3\n", "vertex,h\n0,1\n1,2.5\n2,3\n", "vertex;h\n0;1\n1;2,5\n2;3\n")
    for text, encoding in itertools.product(tables, ("utf-8", "utf-8-sig", "utf-16")):  # as spreadsheets write them
        (tmp_path / "v.csv").write_text(text, encoding=encoding)
        assert read_values(tmp_path / "v.csv", 3).tolist() == [1, 2.5, 3]
    (tmp_path / "v.csv").write_text("left ear\n2\n3\n", encoding="utf-8")
    assert read_values(tmp_path / "v.csv", 3, labels=True).tolist() == ["left ear", "2", "3"]
    (tmp_path / "v.txt").write_text("1 2\n3 4\n5 6\n", encoding="utf-8")
    assert read_values(tmp_path / "v.txt", 3, labels=True).dtype == np.int64
