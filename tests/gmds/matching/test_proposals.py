"""Many rough maps, and the few worth more work."""

from __future__ import annotations

import functools
from dataclasses import replace

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal, bumpy, permuted, surface
from numpy.typing import NDArray

from geodesics import SurfacePoints
from gmds import initialization
from gmds.matching.effort import keeps_sizes
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import DECISIVE, MAPS_PER_METRIC, SAME_MAP, Proposal, Start, proposals, rough_maps
from gmds.registration.deformable import DeformableMesh
from gmds.registration.distinct import distinct
from gmds.registration.register import assessed
from gmds.registration.settings import SIMPLIFIED
from gmds.spectral.sample_maps import SampledPair
from gmds.surface.measured import measure
from gmds.surface.view import View

Array = NDArray[np.float64]
Index = NDArray[np.int64]
ALL: list[Start] = list(initialization.ALL)


@functools.cache
def turned(name: str) -> tuple[SurfacePair, Index]:
    """A surface and a copy turned and renumbered, and where its vertices belong."""
    mesh = {"bumpy": bumpy, "animal": animal, "outlined": lambda: shapes.bumpy_sphere(4)}[name]()
    target, place = permuted(shapes.moved(mesh, 3.0), 1)
    return SurfacePair(measure(mesh), measure(target)), place


def found(pair: SurfacePair, starts: list[Start] = ALL) -> list[Proposal]:
    """All proposals in the metric of space, best first."""
    views = [(pair.source.regular, pair.target.regular)]
    return sorted(proposals(pair, [lambda: views], starts).maps, key=lambda p: p.neg_log_likelihood)


@functools.cache
def of_copy(name: str) -> list[Proposal]:
    return found(turned(name)[0])


def off(pair: SurfacePair, proposal: Proposal, place: Index) -> float:
    """Mean distance in root areas from the truth, on the simplified mesh."""
    truth = pair.target.mesh.vertices[place[pair.simplified[0].origin]]
    return float(np.linalg.norm(proposal.registered.y - truth, axis=1).mean())


def samples_of(pair: SampledPair, images: Index) -> Index:
    """The sample map of a map to vertices."""
    places = pair.target.mesh.vertices
    gaps = places[images[pair.source_samples], None] - places[pair.target_samples]
    return np.asarray(np.linalg.norm(gaps, axis=2).argmin(axis=1))


@pytest.mark.parametrize(("name", "least"), [("bumpy", 2e-3), ("animal", 0.02), ("outlined", 0.03)])
def test_the_best_map_to_a_turned_copy_is_the_right_one_by_far(name: str, least: float) -> None:
    pair, place = turned(name)
    first, second, *_ = distinct(of_copy(name), pair.simplified[0].areas, SAME_MAP, count=2)
    assert off(pair, first, place) < least
    assert off(pair, second, place) > 0.04
    assert first.neg_log_likelihood < second.neg_log_likelihood - 1


def test_proposals_are_maps_of_the_outlines() -> None:
    pair, _ = turned("outlined")
    ours, theirs = pair.simplified
    assert ours.mesh.n_faces < pair.source.mesh.n_faces
    for proposal in of_copy("outlined"):
        assert proposal.registered.y.shape == ours.mesh.vertices.shape
        assert proposal.registered.points.mesh is theirs.mesh
        assert (
            proposal.neg_log_likelihood
            == proposal.registered.residuals.neg_log_likelihood + proposal.back.residuals.neg_log_likelihood
        )


@pytest.mark.parametrize("name", ["bumpy", "outlined"])
def test_rough_maps_lead_from_outline_to_outline_and_every_second_is_reflected(name: str) -> None:
    pair, place = turned(name)
    ours, theirs = pair.simplified
    maps = rough_maps(pair, [(pair.source.regular, pair.target.regular)], ALL)
    doubled = 1 if all(flip is None for flip in pair.reflections) else 2
    assert 1 <= len(maps) <= doubled * MAPS_PER_METRIC and len(maps) % doubled == 0
    for images in maps:
        assert images.shape == (ours.mesh.n_vertices,)
        assert images.min() >= 0 and images.max() < theirs.mesh.n_vertices
    truth = pair.target.mesh.vertices[place[ours.origin]]
    gaps = [np.linalg.norm(theirs.mesh.vertices[images] - truth, axis=1).mean() for images in maps]
    assert min(gaps) < 0.03


def test_a_start_is_tried_as_it_is_and_reflected_and_the_right_one_wins() -> None:
    mine = surface(animal())
    pair, same = SurfacePair(mine, mine), np.arange(mine.mesh.n_vertices)
    assert pair.reflections[0] is not None
    gaps = [off(pair, p, same) for p in found(pair, [lambda sampled: [samples_of(sampled, same)]])]
    assert len(gaps) == 2
    assert gaps[0] < 0.01 < 0.1 < gaps[1]


def test_a_reflection_of_the_target_serves_as_well() -> None:
    source, target = surface(bumpy()), measure(shapes.ellipsoid(2, (1.0, 1.4, 2.0)))
    flip = SurfacePair(target, target).reflections[0]
    assert flip is not None
    pair = SurfacePair(source, target)
    pair.__dict__["reflections"] = None, flip  # as if the source had none
    same = np.arange(162)
    maps = rough_maps(pair, [(source.regular, target.regular)], [lambda sampled: [samples_of(sampled, same)]])
    assert len(maps) == 2
    gap = target.mesh.vertices[maps[1]] - target.mesh.vertices[flip[maps[0]]]
    assert np.linalg.norm(gap, axis=1).mean() < 1e-9


def test_more_metrics_make_more_maps() -> None:
    pair, _ = turned("bumpy")
    views = list(zip(pair.source.views, pair.target.views, strict=True))
    assert len(rough_maps(pair, views, ALL)) > len(rough_maps(pair, views[:1], ALL))


@pytest.fixture(scope="module")
def synthetic() -> tuple[DeformableMesh, list[Proposal]]:
    """Shifted copies of one map, the farther the worse: 0, 0.5, ... 4 times what keeps two maps apart."""
    deformable = DeformableMesh.of(surface(bumpy()))
    base = assessed(deformable, deformable, deformable.mesh.vertices, SIMPLIFIED)
    made = []
    for k in range(9):
        y = base.y + np.array([0.5 * k * SAME_MAP * 1.001, 0, 0])
        points = SurfacePoints.closest(deformable.mesh, y)
        worse = replace(base, y=y, points=points, residuals=replace(base.residuals, misfit_back=0.01 + k))
        made.append(Proposal(worse, base))
    return deformable, made


def test_distinct_keeps_the_best_of_those_that_are_alike(synthetic: tuple[DeformableMesh, list[Proposal]]) -> None:
    (deformable, made), likely = synthetic, functools.partial(distinct, apart=SAME_MAP)
    shuffled = [made[i] for i in np.random.default_rng(0).permutation(len(made))]
    for count in (1, 3, 20):
        assert likely(shuffled, deformable.areas, count=count) == made[::2][:count]
    assert likely([], deformable.areas, count=3) == []
    assert likely([made[1], made[0]], deformable.areas, count=3) == [made[0]]


def test_proposals_do_not_depend_on_size_and_place() -> None:
    mesh = bumpy()
    one, other = (found(SurfacePair(surface(mesh), measure(shapes.moved(mesh, s, seed=2))))[:3] for s in (1e-6, 1e6))
    assert [p.neg_log_likelihood for p in one[1:]] == pytest.approx([p.neg_log_likelihood for p in other[1:]], abs=1e-6)


def test_other_metrics_are_asked_where_that_of_space_does_not_decide() -> None:
    pair, _ = turned("animal")
    views = [(pair.source.regular, pair.target.regular)]
    asked: list[str] = []

    def of_curvature() -> list[tuple[View, View]]:
        asked.append("curvature")
        return []

    found = proposals(pair, [lambda: views, of_curvature], ALL)
    assert asked == ["curvature"] and not found.isometric  # too few vertices to decide early
    assert min(one.neg_log_likelihood for one in found.maps) < DECISIVE


def test_a_decisive_map_of_a_closed_surface_ends_the_search(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gmds.matching.proposals.FEWEST_DECIDED", 1)
    pair, place = turned("animal")
    views = [(pair.source.regular, pair.target.regular)]
    found = proposals(pair, [lambda: views, lambda: pytest.fail("asked though decided")], ALL)
    assert found.isometric
    assert off(pair, min(found.maps, key=lambda one: one.neg_log_likelihood), place) < 0.02
    best = min(found.maps, key=lambda one: one.neg_log_likelihood)
    assert keeps_sizes(pair.simplified[0], best.registered.y)
    assert not keeps_sizes(pair.simplified[0], grown(pair))


def grown(pair: SurfacePair) -> Array:
    """Vertices of the simplified source, those of one half twice as far from the middle."""
    place = pair.simplified[0].mesh.vertices
    return np.asarray(place * np.where(place[:, :1] > 0, 2.0, 1.0))
