// Where points of a surface are on the screen, and which triangle is in front there.
"use strict";

const FIELD = Math.PI / 4; // of view, from bottom to top

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const xyz = (p) => [p.x, p.y, p.z];
const named = (p) => ({ x: p[0], y: p[1], z: p[2] });

function unit(a) {
  const length = Math.sqrt(dot(a, a)) || 1;
  return a.map((c) => c / length);
}

// turned by an angle about a unit axis (Rodrigues)
function turned(p, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const [along, aside] = [dot(p, axis) * (1 - c), cross(axis, p)];
  return p.map((value, k) => value * c + aside[k] * s + axis[k] * along);
}

// right, up and backward axis of a camera, its place, and the size of one unit at distance one, in pixels
function lens(camera, width, height) {
  const eye = xyz(camera.eye);
  const back = unit(minus(eye, xyz(camera.center || { x: 0, y: 0, z: 0 })));
  const right = unit(cross(xyz(camera.up), back));
  return { eye, right, up: cross(back, right), back, width, height, focal: height / 2 / Math.tan(FIELD / 2) };
}

// x and y in pixels from the upper left corner, and the depth along the line of sight
function project(lensNow, p) {
  const { eye, right, up, back, width, height, focal } = lensNow;
  const d = minus(p, eye);
  const depth = -dot(d, back);
  return [width / 2 + (focal * dot(d, right)) / depth, height / 2 - (focal * dot(d, up)) / depth, depth];
}

function projectAll(lensNow, positions) {
  const { width, height, focal } = lensNow;
  const [[ex, ey, ez], [rx, ry, rz], [ux, uy, uz], [bx, by, bz]] = ["eye", "right", "up", "back"].map((name) => lensNow[name]);
  const shown = new Float64Array(positions.length);
  for (let i = 0; i < positions.length; i += 3) { // `project`, without an array for each
    const [x, y, z] = [positions[i] - ex, positions[i + 1] - ey, positions[i + 2] - ez];
    const depth = -(x * bx + y * by + z * bz);
    shown[i] = width / 2 + (focal * (x * rx + y * ry + z * rz)) / depth;
    shown[i + 1] = height / 2 - (focal * (x * ux + y * uy + z * uz)) / depth;
    shown[i + 2] = depth;
  }
  return shown;
}

// what is in front at (x, y): the face, the corner that weighs most there, all weights; null beside the surface
function front(shown, faces, x, y) {
  let best = null;
  for (let f = 0; f < faces.length; f += 3) {
    const [a, b, c] = [3 * faces[f], 3 * faces[f + 1], 3 * faces[f + 2]];
    const [ax, ay] = [shown[a], shown[a + 1]];
    const [ux, uy, vx, vy] = [shown[b] - ax, shown[b + 1] - ay, shown[c] - ax, shown[c + 1] - ay];
    const area = ux * vy - uy * vx;
    if (area === 0) continue;
    const [px, py] = [x - ax, y - ay];
    const [v, w] = [(px * vy - py * vx) / area, (ux * py - uy * px) / area];
    if (v < 0 || w < 0 || v + w > 1) continue;
    const shares = [(1 - v - w) / shown[a + 2], v / shown[b + 2], w / shown[c + 2]];
    const near = shares[0] + shares[1] + shares[2]; // linear on the screen
    if (near <= 0 || (best && near <= best.near)) continue;
    best = { near, depth: 1 / near, first: f, shares };
  }
  if (!best) return null;
  const { first, shares, near, depth } = best;
  const vertex = faces[first + shares.indexOf(Math.max(...shares))];
  return { depth, vertex, corners: [faces[first], faces[first + 1], faces[first + 2]], weights: shares.map((s) => s / near) };
}

const LEVEL = { up: { x: 0, y: 1, z: 0 }, center: { x: 0, y: 0, z: 0 }, eye: { x: 0, y: 0, z: 1.4 } };
const FILLED = 0.9; // of the panel

const copied = (thing) => JSON.parse(JSON.stringify(thing));

function rotated(camera, sideways, upwards) {
  const eye = minus(xyz(camera.eye), xyz(camera.center));
  const up = unit(xyz(camera.up));
  const right = unit(cross(up, unit(eye)));
  const swung = turned(turned(eye, up, sideways), right, upwards);
  const place = swung.map((c, k) => c + xyz(camera.center)[k]);
  return { ...camera, eye: named(place), up: named(turned(up, right, upwards)) };
}

const FIRST = rotated(LEVEL, 0.4, -0.2);

function zoomed(camera, factor) {
  const center = xyz(camera.center);
  return { ...camera, eye: named(minus(xyz(camera.eye), center).map((c, k) => c * factor + center[k])) };
}

function rolled(camera, angle) {
  return { ...camera, up: named(turned(xyz(camera.up), unit(minus(xyz(camera.eye), xyz(camera.center))), angle)) };
}

// moved sideways and upwards by pixels of a panel of that height
function panned(camera, dx, dy, height) {
  const { right, up } = lens(camera, 1, 1);
  const away = minus(xyz(camera.eye), xyz(camera.center));
  const pixel = (2 * Math.tan(FIELD / 2) * Math.sqrt(dot(away, away))) / height;
  const step = right.map((c, k) => (up[k] * dy - c * dx) * pixel);
  const moved = (p) => named(xyz(p).map((c, k) => c + step[k]));
  return { ...camera, eye: moved(camera.eye), center: moved(camera.center) };
}

// from as near as lets everything that is drawn of the surfaces be seen
function fitted(scenes, camera) {
  let near = camera;
  for (let i = 0; i < 4; i++) {
    const reach = scenes.map((scene) => {
      const view = lens(near, scene.plot.clientWidth, scene.plot.clientHeight);
      const shown = projectAll(view, scene.surface.vertices);
      let most = 0;
      for (let k = 0; k < shown.length; k += 3) {
        most = Math.max(most, Math.abs(2 * shown[k] / view.width - 1), Math.abs(2 * shown[k + 1] / view.height - 1));
      }
      return most;
    });
    near = zoomed(near, Math.max(...reach) / FILLED);
  }
  return near;
}
