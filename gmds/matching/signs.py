r"""Signs of how far off a map may be, at each vertex and as a whole: what its confidence is made of.

Averages at a vertex are over the surface around it, :math:`\langle f \rangle_t = e^{-t \Delta} f` on the source of
unit area. With P the map, y the source as it was deformed onto the target, n a unit normal and :math:`\kappa` the
squashed mean curvature, the local signs are

- `curvature_near`, `curvature_far`: :math:`1 - r_t`, the correlation of :math:`\kappa` with :math:`\kappa \circ P`;
- `spectral`: what a functional map in 40 eigenfunctions :math:`\phi` leaves of :math:`\phi_T \circ P`;
- `stress`: the mean of :math:`|d_S - d_T \circ P|` to samples, of commute time, over the mean of :math:`d_S`;
- `normals`, `folds`: :math:`\langle 1 - n \cdot (n_T \circ P) \rangle`, n of y and of the image of the source;
- `uneven_growth`: how much more or less area grew near the vertex than far around it, as a logarithm;
- `gap`: the root of :math:`\langle |P - y|^2 \rangle`; `strain`: of the elastic energy per area;
- `laid`: :math:`\langle |P - P'| \rangle`, where P' is the map laid in space anew; 0 where P is the answer itself;

and those of the whole map are what speaks for it (`gmds.matching.evidence`) and its `margin` over any other.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.euclidean import euclidean_distances
from gmds.matching.candidates import MapCandidate
from gmds.matching.rivals import Rivals

Signs: TypeAlias = dict[str, Floats]

NEAR, FAR = 1e-3, 1e-2  # heat times of averages, in units of the area: what a fingertip and a hand is; set by hand
FUNCTIONS = 40  # eigenfunctions of the functional map, as of stress
SAMPLES = 200  # points that distances are compared to; set by hand
LEAST = 1e-4  # of what a logarithm is taken of: a bound
FLAT = 1e-4  # variance of squashed curvature that is noise: a bound, so that nothing correlates on a plane
SURE = 8.0  # margins above are as good as this: a bound


def signs_of(candidate: MapCandidate, rivals: Rivals) -> Signs:
    """The signs of a map, each (n,), for every vertex of the source in `candidate.pair`.

    Of the `rivals` the margin is one.
    """
    source, target = candidate.pair.full
    image, y = candidate.points.positions, candidate.deformation.y
    near, far = source.laplacian.heat_step(NEAR), source.laplacian.heat_step(FAR)
    there = candidate.points.interpolate(target.normals)
    there /= np.maximum(np.linalg.norm(there, axis=1, keepdims=True), np.finfo(float).tiny)
    areas = source.areas

    def angles(positions: Floats) -> Floats:
        return near(areas * (1 - np.clip((source.moved_normals(positions) * there).sum(axis=1), -1, 1)))

    curvatures = source.curvature, candidate.points.interpolate(target.curvature)
    growth = [source.log_growth(image, time) for time in (NEAR, FAR)]
    local = {
        "curvature_far": _logarithm(_uncorrelated(*(far(areas * x) for x in _moments(*curvatures)))),
        "curvature_near": _logarithm(_uncorrelated(*(near(areas * x) for x in _moments(*curvatures)))),
        "spectral": _logarithm(_left_by_functional_map(candidate, areas)),
        "stress": _logarithm(_stress(candidate)),
        "normals": _logarithm(angles(y)),
        "folds": _logarithm(angles(image)),
        "uneven_growth": np.abs(growth[0] - growth[1]),
        "gap": _logarithm(np.sqrt(np.maximum(near(areas * ((image - y) ** 2).sum(axis=1)), 0))),
        "strain": _logarithm(np.sqrt(np.maximum(far(areas * candidate.deformation.strain), 0))),
        "laid": near(areas * np.linalg.norm(candidate.answer.positions - image, axis=1)),
    }
    n = source.mesh.n_vertices
    return local | {name: np.full(n, value) for name, value in _of_the_whole(candidate, rivals.margin).items()}


def _of_the_whole(candidate: MapCandidate, margin: float) -> dict[str, float]:
    whole, back = candidate.evidence.whole, candidate.evidence.simplified_back
    logarithms = {
        "whole_energy": np.sqrt(max(whole.energy, 0.0)),
        "whole_curvature": 1 - whole.curvature,
        "whole_curvature_back": 1 - whole.curvature_back,
        "simplified_curvature": 1 - back.curvature_back,
        "simplified_misfit": back.misfit_back,
    }
    return {
        "folded": candidate.evidence.folded,
        "rival": float(np.exp(-np.clip(margin, 0.0, SURE))),
        **{name: float(np.log(max(value, LEAST))) for name, value in logarithms.items()},
    }


def _logarithm(values: Floats) -> Floats:
    return np.asarray(np.log(np.maximum(values, LEAST)), dtype=np.float64)


def _moments(a: Floats, b: Floats) -> tuple[Floats, ...]:
    return a, b, a * a, b * b, a * b


def _uncorrelated(a: Floats, b: Floats, aa: Floats, bb: Floats, ab: Floats) -> Floats:
    """1 less the correlation, of averages."""
    spread = np.sqrt(np.maximum((aa - a * a) * (bb - b * b), 1e-9) + FLAT)
    return np.asarray(1 - (ab - a * b) / spread, dtype=np.float64)


def _left_by_functional_map(candidate: MapCandidate, areas: Floats) -> Floats:
    source, target = candidate.pair.source.regular, candidate.pair.target.regular
    k = min(FUNCTIONS, source.functions.shape[1], target.functions.shape[1])
    here, there = source.functions[:, :k], candidate.points.interpolate(target.functions[:, :k])
    rest = there - here @ (here.T @ (areas[:, None] * there))
    return np.asarray(np.sqrt((rest**2).mean(axis=1)), dtype=np.float64)


def _stress(candidate: MapCandidate) -> Floats:
    views = candidate.views
    ours, theirs = (view.distance(min(FUNCTIONS, view.functions.shape[1])).embedding for view in views)
    samples: Integers = views[0].samples(SAMPLES)
    images = candidate.points.interpolate(theirs)
    here, there = (euclidean_distances(rows, rows[samples]) for rows in (ours, images))
    return np.asarray(np.abs(here - there).mean(axis=1) / max(here.mean(), np.finfo(float).tiny), dtype=np.float64)
