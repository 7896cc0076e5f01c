"""A model finds the directions along which shapes were made to vary, and a file, a mesh and scores come back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from generated_shapes import bumpy_sphere

from geodesics.errors import BadArgument, BadShape
from gmds.errors import ModelFileError
from gmds.morphometrics.quality import broken_stick, compactness, generalisation, specificity
from gmds.morphometrics.shape_model import ShapeModel

MESH = bumpy_sphere(2)
RNG = np.random.default_rng(0)
SCORES = RNG.normal(size=(12, 2)) * [0.2, 0.1]


def varying() -> np.ndarray:
    """Twelve shapes along two directions, in random places."""
    x = MESH.vertices
    along = np.stack([x * [0, 0, 1], np.abs(x) * [1, -1, 0]])
    return np.stack([x + a * along[0] + b * along[1] + RNG.normal(size=3) for a, b in SCORES])


def model() -> ShapeModel:
    found = ShapeModel().fit(varying())
    found.faces_, found.names_ = MESH.faces, tuple(f"s{i}" for i in range(12))
    return found


def test_two_directions_are_two_components() -> None:
    found = model()
    assert found.explained_variance_ratio_[:2].sum() > 0.98
    assert abs(np.corrcoef(found.scores_[:, 0], SCORES[:, 0])[0, 1]) > 0.98
    assert np.allclose(found.components_ @ found.components_.T, np.eye(found.n_components_))
    assert np.allclose(found.scores_.var(axis=0, ddof=1), found.explained_variance_)
    assert np.allclose(found.scores_.mean(axis=0), 0)
    assert np.allclose(compactness(found)[-1], 1) and np.allclose(broken_stick(found).sum(), 1)


def test_scores_and_shapes_are_two_ways_to_say_one_thing() -> None:
    found, shapes = model(), varying()
    assert np.allclose(found.transform(found.aligned_), found.scores_, atol=1e-6)
    assert np.allclose(found.inverse_transform(found.scores_).reshape(12, -1, 3), found.aligned_)
    assert np.allclose(ShapeModel(2).fit_transform(shapes.reshape(12, -1)), ShapeModel(2).fit(shapes).scores_)
    assert found.reconstruct([0.01]).n_vertices == MESH.n_vertices
    with pytest.raises(BadShape, match="components"):
        found.inverse_transform(np.zeros((1, 99)))


def test_missing_points_of_a_new_shape_are_foretold() -> None:
    found, shape = model(), varying()[3]
    valid = np.ones((1, len(shape)), dtype=bool)
    valid[0, :20] = False
    part = np.where(valid[0][:, None], shape, 1e3)[None]
    whole = found.transform(shape[None])
    assert np.abs(found.transform(part, valid=valid) - whole)[0, :2].max() < 0.1 * np.sqrt(found.explained_variance_[0])


def test_generalisation_falls_to_nothing_and_specificity_does_not() -> None:
    found = model()
    general, specific = generalisation(found), specificity(found, drawn=20)
    assert general[2] < 0.1 * general[0] and np.all(np.diff(general) < 1e-9)
    assert (specific > 0).all() and np.array_equal(specific, specificity(found, drawn=20))


def test_a_file_holds_the_model(tmp_path: Path) -> None:
    found = model()
    found.save(tmp_path / "model.npz")
    again = ShapeModel.load(tmp_path / "model.npz")
    assert np.array_equal(again.components_, found.components_) and again.names_ == found.names_
    assert np.array_equal(again.reconstruct([0.1]).vertices, found.reconstruct([0.1]).vertices)
    (tmp_path / "bad.npz").write_bytes(b"no archive")
    with pytest.raises(ModelFileError, match="E233"):
        ShapeModel.load(tmp_path / "bad.npz")


def test_another_mesh_is_fitted() -> None:
    found = model()
    fitted = found.fit(MESH)
    assert fitted.mesh.n_vertices == MESH.n_vertices and fitted.scores.shape == (found.n_components_,)
    assert np.nanmean(fitted.residual) < 0.1 * np.sqrt(MESH.area)


def test_one_shape_is_no_model() -> None:
    with pytest.raises(BadArgument, match="2 shapes or more"):
        ShapeModel().fit(varying()[:1])
    with pytest.raises(BadArgument, match="no faces"):
        ShapeModel().fit(varying()).reconstruct([0.0])


def test_it_is_a_step_of_a_pipeline_of_scikit_learn() -> None:
    base = pytest.importorskip("sklearn.base", reason="scikit-learn is not installed")
    from sklearn.linear_model import LinearRegression
    from sklearn.model_selection import GridSearchCV
    from sklearn.pipeline import make_pipeline

    x = varying().reshape(12, -1)
    again = base.clone(ShapeModel(2, scale=False))
    assert repr(again) == "ShapeModel(n_components=2, scale=False)" and again.get_params() == {
        "n_components": 2,
        "scale": False,
    }
    steps = make_pipeline(ShapeModel(), LinearRegression())
    found = GridSearchCV(steps, {"shapemodel__n_components": [1, 2]}, cv=3).fit(x, SCORES.sum(axis=1))
    assert found.best_params_ == {"shapemodel__n_components": 2} and found.best_score_ > 0.9
    with pytest.raises(BadArgument, match="no parameter 'n_component'; did you mean"):
        again.set_params(n_component=1)
