"""Words of a chart cover neither each other nor its points, as far as there is room."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from gmds.comparison.labels import place_labels

figures = pytest.importorskip("matplotlib.figure")


def test_names_of_points_close_together_do_not_collide() -> None:
    rng = np.random.default_rng(3)
    places = np.vstack([rng.normal(0, 0.02, (8, 2)), rng.normal(1, 0.3, (12, 2))])
    figure = figures.Figure(figsize=(6, 6), dpi=100, layout="constrained")
    axis = figure.subplots()
    axis.scatter(*places.T)
    names = [f"specimen {i}" for i in range(len(places))]
    labels = [
        axis.annotate(name, place, xytext=(4, 4), textcoords="offset points", fontsize=8)
        for name, place in zip(names, places, strict=True)
    ]

    def collisions() -> int:
        boxes = [label.get_window_extent() for label in labels]
        return sum(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))

    figure.draw_without_rendering()
    assert collisions() > 10
    place_labels(figure, axis, labels, places)
    assert collisions() == 0
    inside = axis.get_window_extent()
    assert all(inside.overlaps(label.get_window_extent()) for label in labels)
