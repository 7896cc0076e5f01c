"""Carry colours, labels and vectors from one surface to another, and back."""

import numpy as np

from gmds import Correspondence
from gmds.shapes import humanoid, truth

source, target = humanoid(n_vertices=2000), humanoid("kick", n_vertices=2500, seed=1)
answer = Correspondence.from_points(source, truth(source, target))  # or gmds.match(source, target)

height = answer.transfer(target.rest[:, 2])
print("a smooth function arrives within", np.abs(height - source.rest[:, 2]).max())

parts = np.select([target.rest[:, 2] > 1.5, np.abs(target.rest[:, 1]) > 0.2], ["head", "arm"], "rest")
labels = answer.transfer(parts)
expected = np.select([source.rest[:, 2] > 1.5, np.abs(source.rest[:, 1]) > 0.2], ["head", "arm"], "rest")
print(f"{100 * (labels == expected).mean():.1f} % of the labels agree")

back = answer.inverse()
there_and_back = answer.compose(back)
moved = np.linalg.norm(there_and_back.points.positions - source.vertices, axis=1)
print(f"there and back again: {moved[there_and_back.valid].mean():.4f} away, of a height of 1.8")

answer.save("map.npz")
again = Correspondence.load("map.npz", source, target)
print("saved and loaded:", np.array_equal(again.points.face, answer.points.face))
