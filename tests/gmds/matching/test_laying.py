"""Which answers are laid on the target anew, and what that changes."""

from __future__ import annotations

from dataclasses import replace
from unittest import mock

import generated_shapes as shapes
import numpy as np
import pytest
from matched_shapes import animal

from geodesics import Mesh, SurfacePoints
from gmds import match
from gmds.correspondence import Correspondence
from gmds.initialization.extremities import has_limbs
from gmds.matching import steps
from gmds.matching.candidates import MapCandidate
from gmds.matching.laying import laid
from gmds.matching.result import original_points
from gmds.shapes import humanoid
from gmds.surface.measured import measure


@pytest.mark.parametrize(
    ("mesh", "limbs"),
    [
        (humanoid(n_vertices=900), True),
        (animal(), True),
        (shapes.bumpy_sphere(), False),
        (shapes.ellipsoid(), False),
        (shapes.torus(), False),
    ],
    ids=["person", "animal", "bumpy sphere", "ellipsoid", "torus"],
)
def test_people_and_animals_have_limbs(mesh: Mesh, limbs: bool) -> None:
    assert has_limbs(measure(mesh).regular) is limbs


def matched(source: Mesh, target: Mesh) -> tuple[Correspondence, SurfacePoints, MapCandidate]:
    """The answer; its points had nothing been laid anew; and the candidate that it came of."""
    seen: list[MapCandidate] = []

    def observed(candidate: MapCandidate) -> MapCandidate:
        seen.append(laid(candidate))
        return seen[-1]

    with mock.patch.object(steps, "laid", observed):
        answer = match(source, target)
    (candidate,) = seen
    return answer, original_points(replace(candidate, laid=None)), candidate


def test_what_has_no_limbs_and_is_stretched_is_laid_anew_and_lies_better() -> None:
    source = shapes.bumpy_sphere(3, seed=2)
    stretched = source.vertices * [1.0, 1.12, 0.93] + 0.05 * source.vertices[:, [1]] ** 2
    order = np.random.default_rng(0).permutation(source.n_vertices)  # old number of each new vertex
    new = np.argsort(order)
    target = Mesh(stretched[order], new[source.faces])
    answer, before, candidate = matched(source, target)
    off = [np.linalg.norm(points.positions - stretched, axis=1).mean() for points in (answer.points, before)]
    assert candidate.laid is not None and candidate.final is candidate.laid
    assert off[0] < off[1]


def test_an_animal_in_another_pose_is_left_as_it_was() -> None:
    answer, before, candidate = matched(animal(), animal("walk", seed=1))
    assert candidate.laid is None and candidate.final is candidate.deformation
    assert np.array_equal(answer.points.positions, before.positions)
