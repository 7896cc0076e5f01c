"""A few known points settle what the surfaces alone leave open."""

import numpy as np

import gmds
from gmds.shapes import humanoid, truth

source = humanoid(n_vertices=1500)
target = humanoid("wave", hand_scale=1.5, n_vertices=1500, seed=1)
true = truth(source, target)

# the tips of the two hands and the two feet, and the nose, as (source vertex, target vertex)
x, y, z = source.rest.T
tips = [y.argmax(), y.argmin(), (x + y - 3 * z).argmax(), (x - y - 3 * z).argmax(), (3 * x + z).argmax()]
landmarks = np.stack([tips, true.nearest_vertices()[tips]], axis=1)
for name, known in (("without", None), ("with", landmarks)):
    answer = gmds.match(source, target, landmarks=known)
    errors = gmds.geodesic_error(answer, true)
    print(f"{name:8} landmarks: mean error x100 {100 * errors.mean():.2f}; {answer.status.name}")
