"""Match an animal with itself in another pose, its head twice as big and triangulated anew, and judge the map."""

import gmds
from gmds.pictures import write_picture
from gmds.report import write_report
from gmds.shapes import quadruped, truth

source = quadruped(n_vertices=1500)
target = quadruped("walk", head_scale=2.0, n_vertices=1500, seed=1)
answer = gmds.match(source, target)
print(answer.status.value)

errors = gmds.geodesic_error(answer, truth(source, target))
print(gmds.summary(errors))
answer.save("map.npz")
write_report("map.html", answer, errors, title="An animal and itself with a big head")
write_picture("map.png", answer, errors)
