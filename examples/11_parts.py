"""Match a part of an animal with the whole animal in another pose; nothing says that it is a part, or which."""

import numpy as np

import gmds
from gmds.deformations import cut
from gmds.pictures import write_picture
from gmds.shapes import quadruped, truth

walking, target = quadruped("walk", seed=1), quadruped()
part = cut(walking, 0.4, normal=(-1, 0, 0))  # a plane takes away 40 % of the area: hind legs, tail, and what is between
source, kept = part.mesh, np.flatnonzero(~part.missing)
answer = gmds.match(source, target)  # parts="neither" would match it as a whole, parts="source" try nothing else
print(answer.status.value)

here, there = answer.overlap
print(f"{100 * here:.0f} % of the part and {100 * there:.0f} % of the whole correspond")
print(f"{(~answer.valid).sum()} of {source.n_vertices} vertices of the part have no counterpart")
print(f"{(~answer.covered).sum()} of {target.n_vertices} vertices of the whole have none")

errors = gmds.geodesic_error(answer, truth(walking, target)[kept])
print(f"mean error x100 {100 * errors.mean():.2f}")
write_picture("parts.png", answer, errors, names=("part", "whole"), pixels=330)

back = gmds.match(target, source)  # the other way round: hind legs and tail have no counterpart
print(f"back: {100 * back.valid.mean():.0f} % of the vertices are valid")
