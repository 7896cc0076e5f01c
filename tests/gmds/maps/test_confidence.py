"""Confidence of maps: what it is at other radii, how maps keep, carry and store it, and the regions it names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geodesics import Mesh, SurfacePoints
from gmds import Correspondence
from gmds.errors import MapError
from gmds.maps.confidence import RADII, confidence_at
from gmds.maps.doubt import DOUBT, DoubtfulRegion, doubtful_regions
from gmds.maps.images import confidence_between
from gmds.maps.npz_format import OPTIONAL
from tests.support.generated_shapes import bumpy_sphere, rectangle

SPHERE = bumpy_sphere(2)
N = SPHERE.n_vertices


def identity(**attributes: object) -> Correspondence:
    return Correspondence.from_points(SPHERE, SurfacePoints.at_vertices(SPHERE, np.arange(N)), **attributes)


def test_the_probability_of_being_near_grows_with_the_radius_and_with_confidence() -> None:
    p = np.array([0.0, 0.1, 0.5, 0.9, 1.0])
    table = np.array([confidence_at(p, radius) for radius in (1e-3, *RADII, 1.0)])
    assert np.array_equal(confidence_at(p, 0.05), p)
    assert (np.diff(table[:, 1:-1], axis=0) > 0).all() and (np.diff(table, axis=1) > 0).all()
    assert (table[:, 0] == 0).all() and (table[:, -1] == 1).all()
    assert np.isnan(confidence_at([np.nan], 0.1)).all()
    assert np.isfinite(confidence_at(p, 1e300)).all()
    assert np.array_equal(confidence_at([0.0, 1.0], 1e-320), [0, 1])


@pytest.mark.parametrize("radius", [0, -0.1, np.nan, None, "a"])
def test_a_radius_is_positive(radius: float) -> None:
    with pytest.raises(ValueError, match=r"E604: radius must be a positive number"):
        confidence_at([0.5], radius)


def test_a_map_has_none_until_somebody_rates_it_and_zero_where_it_is_not_valid() -> None:
    assert np.isnan(identity().confidence).all() and np.isnan(identity().inverse().confidence).all()
    valid = np.arange(N) > 3
    rated = identity(valid=valid, confidence=np.full(N, 0.7))
    assert (rated.confidence[:4] == 0).all() and (rated.confidence[4:] == 0.7).all()
    assert not rated.confidence.flags.writeable
    assert np.allclose(rated.confidence_at(0.05), rated.confidence)


@pytest.mark.parametrize("wrong", [np.full(N, 1.5), np.full(N, -0.1), np.r_[np.nan, np.ones(N - 1)], np.ones(3)])
def test_what_is_no_probability_is_refused(wrong: np.ndarray) -> None:
    with pytest.raises(MapError):
        identity(confidence=wrong)


def test_certainty_stays_a_probability_where_weights_sum_to_one_up_to_rounding() -> None:
    rng = np.random.default_rng(0)
    points = SurfacePoints(SPHERE, rng.integers(SPHERE.n_faces, size=N), rng.dirichlet(np.ones(3), N))
    assert points.interpolate(np.ones(N)).max() > 1  # by rounding
    certain = Correspondence.from_points(SPHERE, points, confidence=np.ones(N))
    onwards = certain.compose(identity(confidence=np.ones(N)))
    assert np.allclose(onwards.confidence, 1) and onwards.confidence.max() <= 1
    assert confidence_between(points, np.ones(N)).max() <= 1


def test_confidence_goes_with_the_map() -> None:
    given = np.linspace(0, 1, N)
    rated = identity(confidence=given)
    assert np.allclose(rated.inverse().confidence, given)
    assert np.allclose(rated.compose(rated).confidence, given**2)
    assert np.isnan(rated.compose(identity()).confidence).all()


def test_a_file_keeps_it_and_files_without_it_are_read(tmp_path: Path) -> None:
    rated = identity(confidence=np.linspace(0, 1, N))
    rated.save(tmp_path / "rated.npz")
    identity().save(tmp_path / "plain.npz")
    with np.load(tmp_path / "rated.npz") as there, np.load(tmp_path / "plain.npz") as missing:
        assert set(OPTIONAL) <= set(there) and not set(OPTIONAL) & set(missing)
    again = Correspondence.load(tmp_path / "rated.npz", SPHERE, SPHERE)
    assert np.allclose(again.confidence, rated.confidence, atol=1e-7)
    assert np.isnan(Correspondence.load(tmp_path / "plain.npz", SPHERE, SPHERE).confidence).all()


def on_a_strip(confidence: np.ndarray, valid: np.ndarray | None = None) -> list[tuple[int, float, float]]:
    mesh = rectangle(40, 20)
    valid = np.ones(mesh.n_vertices, dtype=bool) if valid is None else valid
    return [(one.center, one.share, one.confidence) for one in doubtful_regions(mesh, confidence, valid)]


def test_regions_of_doubt_are_named_by_share_and_middle() -> None:
    mesh: Mesh = rectangle(40, 20)
    x = mesh.vertices[:, 0] / np.ptp(mesh.vertices[:, 0])
    left, right = x - x.min() < 0.25, x - x.min() > 0.9
    confidence = np.where(left, 0.2, np.where(right, 0.1, 0.9))
    (first, second) = on_a_strip(confidence)
    assert first[1] == pytest.approx(0.25, abs=0.03) and second[1] == pytest.approx(0.1, abs=0.03)
    assert first[2] == pytest.approx(0.2) and second[2] == pytest.approx(0.1)
    assert left[first[0]] and right[second[0]]
    middle = np.linalg.norm(mesh.vertices[first[0]] - mesh.vertices[left].mean(axis=0))
    assert middle < 0.1 * np.ptp(mesh.vertices[:, 0])


def test_what_is_not_valid_not_rated_or_tiny_is_no_region() -> None:
    n = rectangle(40, 20).n_vertices
    low = np.zeros(n)
    assert on_a_strip(low, np.zeros(n, dtype=bool)) == []
    assert on_a_strip(np.full(n, np.nan)) == []
    assert on_a_strip(np.full(n, DOUBT)) == []
    assert on_a_strip(np.where(np.arange(n) == 5, 0.0, 1.0)) == []
    assert len(on_a_strip(low)) == 1 and on_a_strip(low)[0][1] == pytest.approx(1.0)


def test_a_doubtful_region_is_told_in_a_line() -> None:
    region = DoubtfulRegion(7, 0.0421, 0.318, np.arange(500))
    assert repr(region) == "DoubtfulRegion(center=7, share=0.042, confidence=0.32, 500 vertices)"
