"""A model of the variation of shape: the mean, and the principal components of superimposed configurations."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh
from geodesics.arguments import real_numbers, whole_number
from geodesics.arrays import Bools, Floats, Integers
from geodesics.errors import BadArgument, BadShape
from geodesics.io import atomic_write
from gmds.errors import ModelFileError
from gmds.files.npz import read_npz
from gmds.morphometrics.components import ALIKE, LEAST_VARIANCE, principal_components
from gmds.morphometrics.fitted_shape import FittedShape, Registered
from gmds.morphometrics.model_members import MEMBERS, checked_members
from gmds.morphometrics.parameters import Parameters
from gmds.morphometrics.procrustes import fitted, superimposed

# Variance of the place of a point, over the mean variance in the model, that is noise; set by hand.
NOISE = 0.01
POSES = 20  # times that place and scores are found in turn, a bound


class ShapeModel(Parameters):
    """Principal components of shape, with the conventions of scikit-learn.

    Parameters
    ----------
    n_components : int, optional
        How many are kept; all there are, at most k - 1, unless given.
    scale : bool
        Whether configurations are brought to one size; their centroid sizes are kept in `centroid_sizes_`.

    Attributes
    ----------
    mean_ : float64 array of shape (n, 3)
        The mean shape, of centroid size 1 with `scale`.
    components_ : float64 array of shape (c, 3 n)
        Orthonormal, the one of largest variance first; its largest entry is positive.
    explained_variance_, explained_variance_ratio_ : float64 arrays of shape (c,)
        The variance of the scores (of k - 1 degrees of freedom), and its share of the whole.
    scores_ : float64 array of shape (k, c)
        Of the configurations the model was made of.
    centroid_sizes_ : float64 array of shape (k,)
        In the units of the configurations.
    faces_, names_ : int64 array of shape (m, 3), tuple of str
        Of the meshes, where it was made of meshes.

    Examples
    --------
    >>> import gmds
    >>> import numpy as np
    >>> shapes = np.random.default_rng(0).normal(size=(5, 8, 3))  # 5 specimens of 8 points
    >>> model = gmds.ShapeModel(n_components=2)
    >>> model.fit(shapes).scores_.shape
    (5, 2)
    """

    _parameters = ("n_components", "scale")

    def __init__(self, n_components: int | None = None, *, scale: bool = True) -> None:
        self.n_components, self.scale = n_components, scale
        self.faces_: Integers = np.zeros((0, 3), dtype=np.int64)
        self.names_: tuple[str, ...] = ()

    @classmethod
    def from_atlas(cls, atlas: Registered, n_components: int | None = None, *, scale: bool = True) -> ShapeModel:
        """The model of an atlas, or of anything with `configurations` (k, n, 3), `faces`, `valid` and names."""
        model = cls(n_components, scale=scale)
        model.fit(atlas.configurations, valid=atlas.valid)
        model.faces_, model.names_ = atlas.faces, tuple(atlas.names)
        return model

    def fit(self, X: Any, y: Any = None, *, valid: ArrayLike | None = None) -> Any:
        """The model of configurations X (k, n, 3) or (k, 3 n); of a mesh, what `fit_mesh` gives.

        Raises `BadShape` (E108) for another shape, `BadArgument` (E604) for fewer than 2 shapes, or all the same.
        """
        if isinstance(X, Mesh):
            return self.fit_mesh(X)
        x = _configurations(X)
        if len(x) < 2:
            raise BadArgument(f"a model takes 2 shapes or more, not {len(x)}")
        if self.n_components is not None:
            whole_number(self.n_components, "n_components", 1)
        laid = superimposed(x, valid, scale=self.scale)
        mean = laid.aligned.mean(axis=0)
        deviations = (laid.aligned - mean).reshape(len(x), -1)
        variance, components = principal_components(deviations, self.n_components)
        total = float((deviations**2).sum()) / (len(x) - 1)
        if not total > ALIKE * (mean**2).sum():
            raise BadArgument("the shapes are all the same, so there is nothing that varies")
        self.mean_, self.centroid_sizes_ = mean, laid.sizes
        self.components_, self.explained_variance_ = components, variance
        self.explained_variance_ratio_ = variance / (total or 1.0)
        self.scores_, self.n_components_ = deviations @ components.T, len(components)
        self.aligned_, self.n_features_in_ = laid.aligned, mean.size
        return self

    @property
    def scores(self) -> Floats:
        """`scores_` (k, c)."""
        return self.scores_

    @property
    def mean(self) -> Mesh:
        """The mean shape as a mesh."""
        return self.reconstruct(np.zeros(0))

    def transform(self, X: Any, *, valid: ArrayLike | None = None) -> Floats:
        """Scores (k, c) of configurations X (k, n, 3) or (k, 3 n), each laid on the mean first."""
        x = _configurations(X)
        there: Bools = np.asarray(np.isfinite(x).all(axis=2) if valid is None else valid, dtype=np.bool_)
        return np.stack([self._scores(np.nan_to_num(one), mask)[0] for one, mask in zip(x, there, strict=True)])

    def fit_transform(self, X: Any, y: Any = None, *, valid: ArrayLike | None = None) -> Floats:
        """`fit`, then the scores (k, c) of the same configurations."""
        self.fit(X, valid=valid)
        return self.scores_

    def inverse_transform(self, scores: ArrayLike) -> Floats:
        """Configurations (k, 3 n) of scores (k, c'), c' at most c; the others are 0."""
        given = np.atleast_2d(real_numbers(scores, "scores"))
        if given.shape[1] > self.n_components_:
            raise BadShape(f"there are {self.n_components_} components, and scores of {given.shape[1]}")
        return np.asarray(self.mean_.ravel() + given @ self.components_[: given.shape[1]], dtype=np.float64)

    def reconstruct(self, scores: ArrayLike) -> Mesh:
        """The shape with these scores (c',), the others 0, as a mesh of the size of the mean."""
        if not len(self.faces_):
            raise BadArgument("the model has no faces: make it with from_atlas, or set faces_")
        vertices = self.inverse_transform(np.atleast_1d(scores)[None])[0].reshape(-1, 3)
        return Mesh(vertices, self.faces_)

    def fit_mesh(self, mesh: Mesh) -> FittedShape:
        """The shape of the model nearest to any mesh, which is matched with the mean first.

        Scores are pulled to 0 as far as points are missing or off, as the variances of the components say.
        """
        from gmds.matching.pipeline import match

        answer = match(self.mean, mesh)
        goal = answer.points.positions
        scores, move = self._scores(goal, answer.valid)
        shape = Mesh(move.inverse(self.reconstruct(scores).vertices), self.faces_)
        gap = np.linalg.norm(shape.vertices - goal, axis=1)
        return FittedShape(scores, shape, np.where(answer.valid, gap, np.nan))

    def _scores(self, points: Floats, there: Bools) -> tuple[Floats, Any]:
        """Scores (c,) of points (n, 3), and what laid them on the shape of these scores."""
        scores, rows = np.zeros(self.n_components_), np.repeat(there, 3)
        basis = self.components_[:, rows]
        system = basis @ basis.T
        if not there.all():  # what is missing would leave scores without bound
            spread = np.maximum(self.explained_variance_, LEAST_VARIANCE)
            system = system + np.diag(NOISE * spread.sum() / self.mean_.size / spread)
        size = float(np.linalg.norm(self.mean_)) if self.scale else 1.0  # shapes were laid on a mean of size 1
        onto, everything = self.mean_ / size, np.ones(len(points), dtype=np.bool_)
        move = fitted(points, onto, there, scale=self.scale)
        for _ in range(1 if there.all() else POSES):
            deviation = (move(points) - self.mean_).ravel()[rows]
            scores = np.linalg.solve(system, basis @ deviation)
            if not there.all():  # what is missing, as the scores have it, has a say in how the whole is laid
                whole = move.inverse(self.inverse_transform(scores)[0].reshape(-1, 3))
                move = fitted(np.where(there[:, None], points, whole), onto, everything, scale=self.scale)
        return scores, move

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a .npz that numpy alone reads, atomically: all attributes, without the trailing underscore."""
        names = np.array(self.names_ or [""], dtype=np.str_)
        arrays = {name: getattr(self, f"{name}_") for name in MEMBERS}
        with atomic_write(path) as stream:
            np.savez(stream, format="gmds-model", version=1, scale=self.scale, names=names, **arrays)  # type: ignore[arg-type]

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> ShapeModel:
        """Read what `save` wrote. Raises `ModelFileError` (E233), `OSError`."""
        try:
            read = checked_members(read_npz(Path(path)))
            model = cls(scale=bool(read["scale"]))
            for name in MEMBERS:
                setattr(model, f"{name}_", read[name])
            model.names_ = tuple(str(one) for one in read["names"] if one)
            model.n_components_, model.n_features_in_ = len(model.components_), model.mean_.size
        except (ValueError, KeyError, TypeError, IndexError) as error:
            raise ModelFileError(f"{path} is no model that `gmds model` wrote ({error})") from error
        return model


def _configurations(X: Any) -> Floats:
    x = real_numbers(X, "configurations")
    if x.ndim == 2 and x.shape[1] % 3 == 0:
        x = x.reshape(len(x), -1, 3)
    if x.ndim != 3 or x.shape[2] != 3:
        raise BadShape(f"configurations must have shape (k, n, 3) or (k, 3 n), not {x.shape}")
    return x
