"""Half an animal is found on a whole one, both ways, in any unit and numbering; whole pairs stay as they were."""

from __future__ import annotations

import functools
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from cut_shapes import animal_on_half, half_animal
from generated_shapes import bumpy_sphere, cylinder, moved, rectangle
from matched_shapes import animal

import gmds
from geodesics import Mesh, SurfacePoints
from gmds import Correspondence, MatchStatus
from gmds.evaluation import geodesic_error
from gmds.matching.pair import SurfacePair
from gmds.matching.part_answers import LEAST_LIKELY, PARTS, WHOLE, likelier_part, longest_hole, maps_of_parts
from gmds.matching.parts import near_image
from gmds.mds.losses import LeastSquares
from gmds.surface.measured import measure

pytestmark = pytest.mark.usefixtures("few_faces")


@pytest.fixture(scope="module")
def onto_whole() -> Correspondence:
    half = half_animal()
    return gmds.match(half.part, half.whole)


@pytest.fixture(scope="module")
def onto_half() -> Correspondence:
    half = half_animal()
    return gmds.match(half.whole, half.part)


def iou(said: np.ndarray, true: np.ndarray) -> float:
    """Of two sets of vertices, as masks (n,)."""
    return float((said & true).sum() / (said | true).sum())


def on_the_half() -> np.ndarray:
    """Which vertices of the whole are on the half."""
    mask = np.zeros(half_animal().whole.n_vertices, dtype=bool)
    mask[animal_on_half()[0]] = True
    return mask


def error(answer: Correspondence) -> float:
    """Mean error x100 of the half on the whole."""
    true = SurfacePoints(answer.target, half_animal().true.face, half_animal().true.barycentric)
    return 100 * float(geodesic_error(answer, true).mean())


def test_half_an_animal_is_found_on_a_whole_one_in_another_pose(onto_whole: Correspondence) -> None:
    assert onto_whole.meta["part"] == "source" and onto_whole.status is MatchStatus.GOOD
    assert error(onto_whole) < 2.5
    assert onto_whole.valid.all()
    assert not [line for line in onto_whole.meta["notes"] if line.startswith("W205")]  # a part has another topology
    assert iou(onto_whole.covered, on_the_half()) > 0.9
    half = half_animal()
    assert onto_whole.overlap[1] == pytest.approx(half.part.area / half.whole.area, abs=0.05)


def test_and_a_whole_one_on_the_half(onto_half: Correspondence) -> None:
    there, true = animal_on_half()
    assert onto_half.meta["part"] == "target" and onto_half.status is MatchStatus.GOOD
    errors = geodesic_error(onto_half, SurfacePoints(onto_half.target, true.face, true.barycentric), there)
    assert 100 * errors.mean() < 3.5
    assert iou(onto_half.valid, on_the_half()) > 0.9
    assert onto_half.covered.mean() > 0.98
    assert np.isfinite(onto_half.distortion).all() and (onto_half.distortion[~onto_half.valid] >= 0).all()


def test_a_part_turned_over_resized_and_renumbered_is_found_as_well() -> None:
    """The mirror image of it, where orientation is to be reversed: the very map of the part itself."""
    half = half_animal()
    rng = np.random.default_rng(0)
    order, faces = rng.permutation(half.part.n_vertices), rng.permutation(half.part.n_faces)
    renumbered = np.argsort(order)[half.part.faces[faces]]
    mirrored = Mesh(half.part.vertices[order] * [1, -1, 1], renumbered[:, [0, 2, 1]])
    whole = moved(half.whole, 50.0, seed=2)
    answer = gmds.match(moved(mirrored, 1e-3, seed=1), whole, orientation="reverse")
    assert answer.meta["part"] == "source"
    true = half.true[order]
    assert 100 * geodesic_error(answer, SurfacePoints(whole, true.face, true.barycentric)).mean() < 2.5
    assert iou(answer.covered, on_the_half()) > 0.9


def test_neither_is_the_map_of_a_whole_to_a_whole() -> None:
    half = half_animal()
    answer = gmds.match(half.part, half.whole, parts="neither")
    assert "part" not in answer.meta and answer.meta["parameters"]["parts"] == "neither"


@functools.cache
def closed() -> Correspondence:
    """Of an animal onto another pose, and nothing said about parts."""
    return gmds.match(animal(n_vertices=300), animal("walk", 1, 310))


@pytest.mark.parametrize("parts", ["neither", "auto"])
def test_closed_surfaces_are_matched_as_if_there_were_no_parts(parts: str) -> None:
    plain = closed()
    asked = gmds.match(plain.source, plain.target, parts=parts)  # type: ignore[arg-type]
    for name in ("face", "barycentric"):
        assert getattr(plain.points, name).tobytes() == getattr(asked.points, name).tobytes()
    assert plain.distortion.tobytes() == asked.distortion.tobytes() and plain.status is asked.status
    assert plain.meta["evidence"] == asked.meta["evidence"] and "part" not in plain.meta


@pytest.mark.parametrize("wrong", ["bad", "all", "", None, 1])
def test_other_words_are_refused(wrong: object) -> None:
    mesh = bumpy_sphere(1)
    with pytest.raises(ValueError, match="parts must be one of 'auto', 'neither', 'source', 'target', 'both'"):
        gmds.match(mesh, mesh, parts=wrong)  # type: ignore[arg-type]
    assert PARTS == ("auto", "neither", "source", "target", "both")


def test_landmarks_of_a_part_are_met() -> None:
    """With landmarks parts are looked into only when that is asked for."""
    half = half_animal()
    ours = np.array([int(half.part.vertices[:, 0].argmax()), int(half.part.vertices[:, 2].argmax())])
    theirs = half.true.nearest_vertices()[ours]
    answer = gmds.match(half.part, half.whole, landmarks=np.stack([ours, theirs], axis=1), parts="source")
    assert np.array_equal(answer.vertex_map()[ours], theirs)
    assert answer.meta["part"] == "source" and error(answer) < 2.5


def test_a_map_of_a_part_is_read_back_with_what_it_covers(onto_whole: Correspondence, tmp_path: object) -> None:
    path = f"{tmp_path}/map.npz"
    onto_whole.save(path)
    again = Correspondence.load(path, onto_whole.source, onto_whole.target)
    assert np.array_equal(again.covered, onto_whole.covered) and again.overlap == onto_whole.overlap


def test_near_an_image_is_within_so_many_spacings() -> None:
    surface = measure(bumpy_sphere(3))
    here = near_image(surface.mesh.faces, surface, surface.mesh.vertices, 0.01)
    assert here.all()
    half = near_image(surface.mesh.faces, surface, surface.mesh.vertices * [1, 1, 0] + [0, 0, 9], 2.0)
    assert not half.any()


@pytest.mark.parametrize("scale", [1.0, 3.0])
def test_the_longest_hole_is_as_long_as_it_is(scale: float) -> None:
    sheet = rectangle(10, 7, 2 * scale, 3 * scale)
    assert longest_hole(sheet) == pytest.approx(10 * scale)
    ring = cylinder(64, 4, scale, scale)
    assert longest_hole(ring) == pytest.approx(2 * np.pi * scale, rel=1e-3)  # of its two ends
    assert longest_hole(bumpy_sphere(2)) == 0


def test_overruling_overrules() -> None:
    """Also where a map of one whole to the other is as likely: of a closed surface and its copy."""
    mesh = bumpy_sphere(2)
    assert "part" not in gmds.match(mesh, mesh).meta
    with pytest.raises(ValueError, match="without a distance of your own"):
        gmds.match(mesh, mesh, parts="source", distance=lambda one: None)  # type: ignore[arg-type, return-value]
    half = half_animal()
    assert gmds.match(half.part, half.whole, parts="source").meta["part"] == "source"


def named(likelihood: float, part: str = "source") -> Any:
    return SimpleNamespace(neg_log_likelihood=likelihood, part=part)


def test_the_likelier_of_part_and_whole_is_taken_whatever_came_first() -> None:
    unlikely, likely = named(-9.0), named(-13.0)
    assert likelier_part([unlikely, likely], [named(-10.0), named(-12.0)], "auto") is likely
    assert likelier_part([likely, unlikely], [named(-13.0)], "auto") is None, "a region can be chosen to fit"
    assert likelier_part([unlikely], [named(-12.0)], "auto") is None
    assert likelier_part([unlikely], [named(-12.0)], "source") is unlikely
    assert likelier_part([], [named(0.0)], "auto") is None
    overlap = named(-8.0, "both")
    assert likelier_part([overlap], [named(LEAST_LIKELY + 0.1)], "auto") is overlap, "the whole would be POOR as well"
    assert likelier_part([overlap], [named(LEAST_LIKELY - 0.1)], "auto") is None


def test_of_two_that_fit_as_wholes_neither_is_a_part() -> None:
    """Half an animal and a copy of it: nothing is looked for, unless it is asked for."""
    surface = measure(half_animal().part)
    pair = SurfacePair(surface, surface)
    report = lambda stage, share: None  # noqa: E731
    assert maps_of_parts(pair, [named(WHOLE - 0.1)], "auto", LeastSquares(), 100, report) == []
    assert maps_of_parts(pair, [named(WHOLE - 0.1)], "neither", LeastSquares(), 100, report) == []
    found = maps_of_parts(pair, [named(WHOLE + 0.1)], "auto", LeastSquares(), 100, report)
    assert [one.part for one in found] == ["both"]


def test_a_tail_that_is_not_there_is_marked_though_the_rest_fits_as_a_whole() -> None:
    whole = animal(n_vertices=750)
    tail = int(whole.vertices[:, 0].argmin())
    cut = gmds.deformations.cut(whole, 0.03, centre=tail)
    gone = np.zeros(whole.n_vertices, dtype=bool)
    gone[cut.missing] = True
    answer = gmds.match(whole, cut.mesh)
    assert answer.meta["part"] == "target"
    assert answer.valid[~gone].mean() > 0.98 and (~answer.valid)[gone].mean() > 0.8
