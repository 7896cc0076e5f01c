"""Match an animal with itself in another pose, its head twice as big and triangulated anew, and judge the map."""

import gmds
from gmds.evaluation import protocol_subset
from gmds.pictures.panels import write_picture
from gmds.report.page import write_report
from gmds.shapes import demo_pair

source, target, truth = demo_pair()
answer = gmds.match(source, target)
print(answer.status.value)

some = protocol_subset(len(truth))
print(gmds.summary(gmds.geodesic_error(answer, truth[some], some)))
answer.save("map.npz")
write_report("map.html", answer, title="An animal and itself with a big head")
write_picture("map.png", answer)
