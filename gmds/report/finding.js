// Going to a vertex: by its number, to the worst, and to the side from which it is seen.
"use strict";

// marks a vertex by its number in the file, for whoever has no pointer
function goTo(page, side, number) {
  const vertex = page.data.surfaces[side].origin.indexOf(number);
  if (vertex >= 0) page.pin({ side, vertex });
  else at("readout").textContent = missing(page.data.surfaces[side], number);
}

function missing({ name, count }, number) {
  if (number >= count) return `${name} has no vertex ${number}: they are numbered from 0 to ${count - 1}.`;
  return `Vertex ${number} is not among the points that are drawn of ${name}.`;
}

// to what is worst: the largest value, or the lowest where low is bad
function goToWorst(page) {
  const { mode, map } = page;
  const sign = mode.reversed ? -1 : 1;
  let most = -1;
  map.values[mode.key][0].forEach((value, i, all) => { if (map.there.found[i] && Number.isFinite(value) && !(sign * value <= sign * all[most])) most = i; });
  if (most < 0) return;
  turnTo(page, 0, most);
  page.pin({ side: 0, vertex: most });
}

// to the side from which a vertex of a panel is seen best
function turnTo(page, side, vertex) {
  const scene = page.scenes[side];
  const kept = scene.camera;
  const sums = normals(scene.positions, scene.surface.faces);
  const normal = unit(Array.from(sums.subarray(3 * vertex, 3 * vertex + 3)));
  const seen = (camera) => {
    scene.camera = camera;
    scene.shown = null;
    return scene.place(scene.vertex(vertex)).hidden ? -2 : Math.abs(dot(normal, scene.lens.back));
  };
  const steps = [0, -0.7, 0.7].flatMap((rise) => Array.from({ length: 12 }, (_, i) => rotated(rotated(kept, 0, rise), (i * Math.PI) / 6, 0)));
  const worth = steps.map(seen);
  seen(kept);
  const best = steps[worth.indexOf(Math.max(...worth))];
  seen(best);
  const { x, y } = scene.place(scene.vertex(vertex));
  const inside = x > 0 && y > 0 && x < scene.plot.clientWidth && y < scene.plot.clientHeight;
  seen(kept);
  scene.look(inside ? best : fitted(page.scenes.slice(0, 2), { ...best, center: FIRST.center, eye: named(minus(xyz(best.eye), xyz(best.center))) }));
}
