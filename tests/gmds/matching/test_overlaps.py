"""The front of an animal and the rear of another pose: what they have in common is found, and what is not is marked."""

from __future__ import annotations

import numpy as np
import pytest
from cut_shapes import two_cuts
from generated_shapes import moved

import gmds
from geodesics import Mesh, SurfacePoints
from gmds import Correspondence, MatchStatus
from gmds.evaluation import geodesic_error

pytestmark = pytest.mark.usefixtures("few_faces")


@pytest.fixture(scope="module")
def answer() -> Correspondence:
    return gmds.match(two_cuts().front, two_cuts().rear)


def common(n: int, there: np.ndarray) -> np.ndarray:
    """A mask (n,) of the vertices that have a counterpart."""
    mask = np.zeros(n, dtype=bool)
    mask[there] = True
    return mask


def iou(said: np.ndarray, true: np.ndarray) -> float:
    """Of two sets of vertices, as masks."""
    return float((said & true).sum() / (said | true).sum())


def test_what_both_have_in_common_is_found(answer: Correspondence) -> None:
    both = two_cuts()
    assert answer.meta["part"] == "both" and answer.status is MatchStatus.GOOD
    assert 100 * geodesic_error(answer, both.true, both.there).mean() < 5
    assert iou(answer.valid, common(both.front.n_vertices, both.there)) > 0.85
    assert not answer.valid.all() and not answer.covered.all()
    shares = answer.overlap
    assert 0.6 < shares[0] < 0.85 and 0.6 < shares[1] < 0.9


def test_points_beyond_the_region_are_on_the_target_and_finite(answer: Correspondence) -> None:
    assert np.isfinite(answer.points.positions).all() and np.isfinite(answer.distortion).all()
    assert answer.points.mesh is two_cuts().rear
    assert (answer.distortion[~answer.valid] == 1).all()
    faces, front = two_cuts().front.faces, two_cuts().front.vertices
    there, here = (np.linalg.norm(np.diff(x[faces], axis=1), axis=2) for x in (answer.points.positions, front))
    assert np.median(there) < 3 * np.median(here)  # they hang together


def test_turned_resized_and_renumbered_it_is_the_same(answer: Correspondence) -> None:
    both = two_cuts()
    order = np.random.default_rng(4).permutation(both.front.n_vertices)
    front = Mesh(both.front.vertices[order], np.argsort(order)[both.front.faces])
    rear = moved(both.rear, 40.0, seed=6)
    other = gmds.match(front, rear, parts="both")
    true = SurfacePoints(rear, both.true.face, both.true.barycentric)
    assert 100 * geodesic_error(other, true, np.argsort(order)[both.there]).mean() < 5
    assert iou(other.valid[np.argsort(order)], answer.valid) > 0.9


def test_neither_is_as_before() -> None:
    both = two_cuts()
    assert "part" not in gmds.match(both.front, both.rear, parts="neither", n_samples=100).meta
    with pytest.raises(ValueError, match="without a distance of your own"):
        gmds.match(both.front, both.rear, parts="both", distance=lambda mesh: None)
