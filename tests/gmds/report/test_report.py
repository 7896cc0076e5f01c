"""The page on a map: it holds what the map says, is small, and nothing in a name is ever run."""

from __future__ import annotations

import base64
import hashlib
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from generated_shapes import rectangle, tetrahedron
from pages import HOSTILE, elements, page_data

from geodesics import Mesh, SurfacePoints
from geodesics.repair.clustering import clustered
from gmds import Correspondence, MatchStatus
from gmds.maps.npz_format import fingerprint
from gmds.maps.point_map import Candidate
from gmds.report.drawing import MOST_VERTICES, SIMPLIFIED_VERTICES, drawing
from gmds.report.page import write_report
from gmds.shapes import quadruped, truth


@pytest.fixture(scope="module")
def answer() -> Correspondence:
    source, target = quadruped(n_vertices=500), quadruped("walk", head_scale=2, n_vertices=600, seed=1)
    mirrored = Candidate(truth(source, target, mirrored=True), 0.2, -0.8)
    return Correspondence.from_points(
        source,
        truth(source, target),
        valid=np.arange(500) % 50 > 0,
        distortion=np.linspace(0, 0.3, 500),
        candidates=(mirrored,),
        meta={"parameters": {"seed": HOSTILE}, "versions": {"gmds": "0.1"}},
    )


def test_the_page_holds_both_surfaces_and_every_map(answer: Correspondence, tmp_path: Path) -> None:
    write_report(tmp_path / "r.html", answer, errors=np.full(500, 0.07), names=("a.off", "b.off"))
    data = page_data(tmp_path / "r.html")
    for shown, mesh, name in zip(data["surfaces"], (answer.source, answer.target), ("a.off", "b.off"), strict=True):
        assert shown["name"] == name
        assert np.array_equal(np.sort(shown["faces"].reshape(-1, 3)), np.sort(mesh.faces))
        assert np.array_equal(shown["origin"], np.arange(mesh.n_vertices))
        spread = np.linalg.norm(mesh.vertices[0] - mesh.vertices, axis=1)
        v = shown["vertices"].reshape(-1, 3)
        assert np.ptp(np.linalg.norm(v[0] - v, axis=1)[1:] / spread[1:]) < 1e-4  # the same shape, turned and scaled
        assert np.linalg.norm(v, axis=1).max() <= 0.5
    assert [mode["key"] for mode in data["modes"]] == ["match", "distortion", "valid", "growth", "error"]
    assert [one["name"] for one in data["maps"]] == ["Best map", "Candidate 1, mirrored"]


def test_every_vertex_carries_its_barycentric_partner(answer: Correspondence, tmp_path: Path) -> None:
    write_report(tmp_path / "r.html", answer)
    data = page_data(tmp_path / "r.html")
    back = answer.inverse()
    for shown, points in zip(data["maps"], (answer.points, answer.candidates[0].points), strict=True):
        assert np.array_equal(shown["there"]["face"], points.face)
        assert np.array_equal(shown["there"]["vertex"], points.nearest_vertices())
        assert np.abs(shown["there"]["weights"].reshape(-1, 3) / 65535 - points.barycentric).max() < 1e-5
        corners = data["surfaces"][1]["vertices"].reshape(-1, 3)[answer.target.faces[points.face]]
        drawn = np.einsum("pk,pkj->pj", points.barycentric, corners)
        assert np.abs(shown["there"]["position"].reshape(-1, 3) / 65535 - 0.5 - drawn).max() < 1e-5
        assert np.array_equal(shown["there"]["found"], answer.valid)
    assert np.array_equal(data["maps"][0]["back"]["face"], back.points.face)
    assert np.array_equal(data["maps"][0]["back"]["found"], answer.covered)


def test_corresponding_points_have_the_same_colour(answer: Correspondence, tmp_path: Path) -> None:
    write_report(tmp_path / "r.html", answer)
    data = page_data(tmp_path / "r.html")
    source, target = data["maps"][0]["colours"].reshape(-1, 3), data["colours"].reshape(-1, 3)
    assert np.abs(source - answer.points.interpolate(target))[answer.valid].max() <= 1.01
    assert (source[~answer.valid] == data["missing"]).all()
    other = data["maps"][1]["colours"].reshape(-1, 3)
    assert np.abs(other - answer.candidates[0].points.interpolate(target))[answer.valid].max() <= 1.01


def test_values_are_shown_on_both_surfaces(answer: Correspondence, tmp_path: Path) -> None:
    errors = np.stack([np.linspace(0, 0.1, 500), np.full(500, 0.3)])
    write_report(tmp_path / "r.html", answer, errors=errors)
    data = page_data(tmp_path / "r.html")
    first, second = data["maps"]
    source, target = first["values"]["distortion"]
    assert np.allclose(source[answer.valid], answer.distortion[answer.valid]) and np.isnan(source[~answer.valid]).all()
    back = answer.inverse()
    expected = np.where(
        answer.covered, back.points.interpolate(np.where(answer.valid, answer.distortion, np.nan)), np.nan
    )
    assert np.allclose(target, expected, equal_nan=True)
    assert np.allclose(first["values"]["error"][0], errors[0], atol=1e-6) and "distortion" not in second["values"]
    assert np.allclose(second["values"]["error"][0], 0.3)
    for fixed_or_fitted in (0, 1):
        assert sum(first["histograms"]["error"][fixed_or_fitted]) == 500
        assert sum(first["histograms"]["distortion"][fixed_or_fitted]) == answer.valid.sum()
    tops = {mode["key"]: mode["high"] for mode in data["modes"] if "high" in mode}
    assert tops == {"distortion": 0.5, "growth": 0.69, "error": 0.25}
    assert first["tops"]["error"] == pytest.approx(np.quantile(errors[0], 0.98))
    assert first["curve"][0] == pytest.approx(1 / 500) and first["curve"][20] == 1 and second["curve"][-1] == 0


def test_a_truth_that_is_known_at_few_points_colours_what_is_nearest(answer: Correspondence, tmp_path: Path) -> None:
    errors = np.full(500, np.nan)
    errors[[3, 400]] = 0.1, 0.2
    write_report(tmp_path / "r.html", answer, errors=errors)
    data = page_data(tmp_path / "r.html")
    v = answer.source.vertices
    nearer = np.linalg.norm(v - v[3], axis=1) < np.linalg.norm(v - v[400], axis=1)
    assert np.allclose(data["maps"][0]["values"]["error"][0], np.where(nearer, 0.1, 0.2))
    assert "known at 2 points" in data["modes"][-1]["help"] and sum(data["maps"][0]["histograms"]["error"][0]) == 2
    dots = data["maps"][0]["dots"]
    assert np.allclose(dots["error"], [0.1, 0.2])
    assert np.allclose(dots["position"].reshape(-1, 3), data["surfaces"][0]["vertices"].reshape(-1, 3)[[3, 400]])
    assert "<b>15.00</b>" in (tmp_path / "r.html").read_text(encoding="utf-8")


def test_figures_parameters_versions_and_hashes_are_in_tables(answer: Correspondence, tmp_path: Path) -> None:
    write_report(tmp_path / "r.html", answer, errors=np.full(500, 0.07))
    text = (tmp_path / "r.html").read_text(encoding="utf-8")
    for told in ("<b>7.00</b>", "98.0 %", "<td>0.1", answer.status.value.split("`")[0], "versions: gmds</th><td>0.1"):
        assert told in text
    for mesh in (answer.source, answer.target):
        assert fingerprint(mesh)["sha256"] in text


@pytest.mark.parametrize("status", MatchStatus)
def test_every_status_has_a_verdict_and_an_advice(answer: Correspondence, status: MatchStatus, tmp_path: Path) -> None:
    write_report(tmp_path / "r.html", replace(answer, status=status))
    badge = re.search(r'class="badge (\w+)">([^<]+)', (tmp_path / "r.html").read_text(encoding="utf-8"))
    assert badge and (badge[1] == "good") == (status is MatchStatus.GOOD)


def test_nothing_in_names_titles_or_meta_becomes_markup(answer: Correspondence, tmp_path: Path) -> None:
    write_report(tmp_path / "plain.html", answer)
    write_report(tmp_path / "hostile.html", answer, title=HOSTILE, names=(HOSTILE, '" onload="x'))
    plain, hostile = elements(tmp_path / "plain.html"), elements(tmp_path / "hostile.html")
    assert plain.tags == hostile.tags and plain.attributes == hostile.attributes
    assert "img" not in hostile.tags and not any(name.startswith("on") for name in hostile.attributes)
    assert page_data(tmp_path / "hostile.html")["surfaces"][0]["name"] == HOSTILE


def test_the_policy_lets_only_the_pages_own_scripts_run(answer: Correspondence, tmp_path: Path) -> None:
    write_report(tmp_path / "r.html", answer)
    page = elements(tmp_path / "r.html")
    allowed = re.findall(r"'sha256-([^']+)'", page.policy)
    own = [text for attrs, text in page.scripts if "type" not in attrs]
    assert allowed == [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in own]
    assert "default-src 'none'" in page.policy and "unsafe-eval" not in page.policy
    assert "unsafe-inline" not in page.policy.split("script-src")[1]
    assert not {"src", "href"} & set(page.attributes)


def test_pages_repeat_byte_for_byte(answer: Correspondence, tmp_path: Path) -> None:
    for name in ("a.html", "b.html"):
        write_report(tmp_path / name, answer)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_errors_must_fit_the_map(answer: Correspondence, tmp_path: Path) -> None:
    for wrong in (np.zeros(3), np.zeros((3, 500)), np.zeros((1, 1, 500))):
        with pytest.raises(ValueError, match="each of the 500 vertices, in at most 2 rows"):
            write_report(tmp_path / "r.html", answer, errors=wrong)
    with pytest.raises(OSError, match="nowhere"):
        write_report(tmp_path / "nowhere" / "r.html", answer)


def test_maps_without_any_counterpart_and_errors_without_numbers_can_be_shown(tmp_path: Path) -> None:
    shape = tetrahedron()
    points = SurfacePoints.at_vertices(shape, [0, 1, 2, 3])
    answer = Correspondence.from_points(shape, points, valid=np.zeros(4, dtype=bool))
    write_report(tmp_path / "r.html", answer, errors=np.full(4, np.nan))
    data = page_data(tmp_path / "r.html")
    assert [mode["key"] for mode in data["modes"]] == ["match", "valid"]
    assert not data["maps"][0]["there"]["found"].any() and not data["maps"][0]["back"]["found"].any()


def with_a_third_sheet(mesh: Mesh) -> Mesh:
    """The mesh with one more face at its first edge, so that the edge has three."""
    a, b, _ = mesh.faces[0]
    corner = np.append(mesh.vertices, [mesh.vertices.max(axis=0) + 1], axis=0)
    return Mesh(corner, np.append(mesh.faces, [[a, b, mesh.n_vertices]], axis=0))


@pytest.mark.parametrize("branching", [False, True])
def test_large_surfaces_are_drawn_as_copies_near_them(branching: bool) -> None:
    large = rectangle(150, 80)
    large = with_a_third_sheet(large) if branching else large
    drawn = drawing(large, np.eye(3))
    assert large.n_vertices > MOST_VERTICES and 0.5 * SIMPLIFIED_VERTICES < len(drawn.vertices) <= MOST_VERTICES
    gap = np.linalg.norm(drawn.vertices - large.vertices[drawn.origin], axis=1)
    assert gap.max() < 2 * np.sqrt(large.area / len(drawn.vertices))
    assert np.abs(drawn.placed(large.vertices)).max() <= 0.5


def test_clusters_keep_no_face_that_is_none() -> None:
    copy = clustered(rectangle(40, 40), 300)
    assert 100 < copy.n_vertices <= 300
    assert all(len(set(face)) == 3 for face in copy.faces.tolist())
    assert copy.area == pytest.approx(rectangle(40, 40).area, rel=0.2)


@pytest.fixture(scope="module")
def half() -> Correspondence:
    """The front of an animal on the whole of it."""
    whole = quadruped("walk", n_vertices=600, seed=1)
    body = quadruped(n_vertices=500)
    faces = body.faces[(body.vertices[body.faces][:, :, 0] > -0.1).all(axis=1)]
    return Correspondence.from_points(Mesh(body.vertices, faces), truth(body, whole))


def test_counterparts_of_the_target_are_what_the_map_covers(half: Correspondence, tmp_path: Path) -> None:
    write_report(tmp_path / "r.html", half)
    text, shown = (tmp_path / "r.html").read_text(encoding="utf-8"), page_data(tmp_path / "r.html")["maps"][0]
    assert 0.4 < half.covered.mean() < 0.7 and half.covered.mean() < half.inverse().valid.mean()
    assert np.array_equal(shown["values"]["valid"][0], half.valid)
    assert np.array_equal(shown["values"]["valid"][1], half.covered)
    ours, theirs = (f"{100 * share:.1f} %" for share in half.overlap)
    assert ours == "100.0 %" and f"<td>{ours}, {theirs}</td>" in text
