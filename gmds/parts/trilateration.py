"""Every vertex of a part by its distances from assigned extremities, and by the sense in which they turn around it."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Floats, Integers
from geodesics.caching import cached_property
from geodesics.euclidean import euclidean_distances
from geodesics.intrinsic import areas, squared_lengths, vertex_sums
from gmds.parts.assignments import Assignment, indices
from gmds.parts.extremities import Anchors

# Root areas that a right angle between the gradients of two distances is worth, all forms taken together; with 0.1 and
# 0.2 trilateration from true extremities was as good on development pairs, without forms a half worse.
FORM_WEIGHT = 0.15
JUDGED = 4  # every so-many-th row tells a residual
PER_EXTREMITY = 0.004  # root areas of residual that one more extremity is worth; set by hand


@dataclass(frozen=True, eq=False)
class Trilateration:
    """Vertices `rows` of two surfaces of unit area, seen from the anchors of each."""

    source: Mesh
    target: Mesh
    ours: Anchors
    theirs: Anchors
    source_rows: Integers
    target_rows: Integers

    def images(self, assignment: Assignment) -> Integers:
        """For each source row (p,) the number of the target row it goes to.

        A row goes where distances from the assigned extremities, divided by the scale, are most alike, and the 2-forms
        d d_i ^ d d_j as well: the sine of the angle between the gradients of two distances, which changes sign under a
        reflection. That tells a chest from a back where distances do not.
        """
        return np.asarray(self._gaps(assignment, self.source_rows).argmin(axis=1), dtype=np.int64)

    def residual(self, assignment: Assignment) -> float:
        """What is typically left, in root areas, judged on some of the rows; less where more extremities agree."""
        nearest = self._gaps(assignment, self.source_rows[::JUDGED]).min(axis=1)
        count = len(assignment.ours)
        return float(np.median(nearest)) / float(np.sqrt(count)) - PER_EXTREMITY * count

    def _gaps(self, assignment: Assignment, rows: Integers) -> Floats:
        """Distances (p, q) between what some source rows and all target rows see."""
        ours, theirs = indices(assignment)
        pairs = list(itertools.combinations(range(len(ours)), 2))
        weight = FORM_WEIGHT * np.sqrt(len(ours) / len(pairs))
        here = [self.ours.distances[ours][:, rows] / assignment.scale]
        there = [self.theirs.distances[theirs][:, self.target_rows]]
        here += [weight * self._source_forms[ours[i], ours[j]][None, rows] for i, j in pairs]
        there += [weight * self._target_forms[theirs[i], theirs[j]][None, self.target_rows] for i, j in pairs]
        return euclidean_distances(np.vstack(here).T, np.vstack(there).T)

    @cached_property
    def _source_forms(self) -> Floats:
        return distance_forms(self.source, self.ours.distances)

    @cached_property
    def _target_forms(self) -> Floats:
        return distance_forms(self.target, self.theirs.distances)


def distance_forms(mesh: Mesh, distances: Floats) -> Floats:
    """The 2-forms d d_i ^ d d_j per area (k, k, n) of distances (k, n): sines of the angles between their gradients."""
    corner = distances[:, mesh.faces]
    first, second = corner[:, :, 1] - corner[:, :, 0], corner[:, :, 2] - corner[:, :, 0]
    area = vertex_sums(mesh.faces, areas(squared_lengths(mesh.vertices, mesh.faces)), mesh.n_vertices)
    k = len(distances)
    forms = np.zeros((k, k, mesh.n_vertices))
    for i, j in itertools.combinations(range(k), 2):
        wedge = 0.5 * (first[i] * second[j] - first[j] * second[i])  # the integral over each face
        total = vertex_sums(mesh.faces, wedge, mesh.n_vertices)
        forms[i, j] = np.clip(np.divide(total, area, out=np.zeros_like(area), where=area > 0), -1.0, 1.0)
        forms[j, i] = -forms[i, j]
    return forms
