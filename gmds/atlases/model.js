"use strict";
const at = (id) => document.getElementById(id);
const data = JSON.parse(at("data").textContent);
const stage = at("shape");
const scores = data.modes.map(() => 0);
const known = numbers(data.specimens), size = data.vertices.length;
const HOME = [0.5, 0.2];
let turn = [...HOME], chosen = -1, waiting = false;

function numbers(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Int16Array(bytes.buffer);
}

function asSpecimen(i) {
  return Float64Array.from(known.subarray(i * size, (i + 1) * size), (x) => x * data.step);
}

function asModel(values) {
  const points = Float64Array.from(data.vertices);
  data.modes.forEach((mode, m) => { if (values[m]) for (let i = 0; i < points.length; i++) points[i] += values[m] * mode[i]; });
  return points;
}

function turned(points, [a, b]) {
  const [ca, sa, cb, sb] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b)];
  for (let i = 0; i < points.length; i += 3) {
    const [x, y, z] = [points[i], points[i + 1], points[i + 2]];
    const depth = -sa * x + ca * z;
    points[i] = ca * x + sa * z; points[i + 1] = cb * y - sb * depth; points[i + 2] = sb * y + cb * depth;
  }
  return points;
}

function paint(canvas, p) {
  const pen = canvas.getContext("2d"), seen = [];
  let scale = 1.02 * Math.min(canvas.width, canvas.height * 1.25);
  for (let i = 0; i < p.length; i += 3) {  // what would leave the canvas is drawn smaller
    scale = Math.min(scale, 0.49 * canvas.width / Math.abs(p[i]), 0.49 * canvas.height / Math.abs(p[i + 1]));
  }
  const [r, g, b] = getComputedStyle(document.documentElement).getPropertyValue("--shape").match(/[0-9a-f]{2}/gi).map((two) => parseInt(two, 16));
  for (const face of data.faces) {
    const [i, j, k] = face.map((v) => 3 * v);
    const [ux, uy, uz] = [p[j] - p[i], p[j + 1] - p[i + 1], p[j + 2] - p[i + 2]];
    const [vx, vy, vz] = [p[k] - p[i], p[k + 1] - p[i + 1], p[k + 2] - p[i + 2]];
    const normal = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const length = Math.hypot(...normal) || 1;
    const light = 0.3 + 0.8 * Math.abs((0.3 * normal[0] + 0.5 * normal[1] + 0.81 * normal[2]) / length);
    seen.push([p[i + 2] + p[j + 2] + p[k + 2], i, j, k, light]);
  }
  seen.sort((one, other) => one[0] - other[0]);
  pen.clearRect(0, 0, canvas.width, canvas.height);
  const x = (i) => canvas.width / 2 + scale * p[i], y = (i) => canvas.height / 2 - scale * p[i + 1];
  for (const [, i, j, k, light] of seen) {
    pen.fillStyle = pen.strokeStyle = `rgb(${Math.min(255, r * light)},${Math.min(255, g * light)},${Math.min(255, b * light)})`;
    pen.beginPath(); pen.moveTo(x(i), y(i)); pen.lineTo(x(j), y(j)); pen.lineTo(x(k), y(k)); pen.closePath(); pen.fill(); pen.stroke();
  }
}

function fitted(canvas) {
  const sharp = Math.min(window.devicePixelRatio || 1, 2), box = canvas.getBoundingClientRect();
  const [width, height] = [Math.max(1, Math.round(box.width * sharp)), Math.max(1, Math.round(box.height * sharp))];
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  return canvas;
}

const isItself = () => chosen >= 0 && (chosen + 1) * size <= known.length && !at("asmodel").checked;

function draw() {
  waiting = false;
  paint(fitted(stage), turned(isItself() ? asSpecimen(chosen) : asModel(scores), turn));
}

function show() {
  if (!waiting) { waiting = true; requestAnimationFrame(draw); }
  document.querySelectorAll("#sliders input").forEach((input, m) => {
    input.value = scores[m];
    input.nextElementSibling.textContent = scores[m].toFixed(2);
  });
  const mean = scores.every((score) => !score), count = data.modes.length;
  const made = count > 1 ? `as the first ${count} components have it` : "as the component has it";
  at("told").textContent = chosen >= 0 ? `${data.names[chosen]}, ${isItself() ? "superimposed" : made}` : mean ? "Mean shape" : "A shape of the model";
  document.querySelectorAll("circle").forEach((point) => {
    const is = Number(point.dataset.i) === chosen;
    point.classList.toggle("chosen", is);
    point.setAttribute("r", is ? 9 : 7);
  });
  document.querySelectorAll("#specimens button").forEach((button, i) => button.setAttribute("aria-pressed", i === chosen));
}

function choose(i) {
  chosen = i;
  scores.forEach((_, m) => { scores[m] = i < 0 ? 0 : data.scores[i][m]; });
  show();
}

function element(name, attributes, text) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text) made.textContent = text;
  return made;
}

const share = (m) => `${(100 * data.shares[m]).toFixed(1)} %`;

function plot() {
  const [m, n] = [Number(at("x").value), Number(at("y").value)];
  const most = Math.max(2.5, ...data.scores.flat().map(Math.abs));
  const x = (s) => 200 + (180 * s) / most, y = (s) => 165 - (150 * s) / most;
  at("plot").replaceChildren(
    element("line", { x1: 10, x2: 390, y1: 165, y2: 165 }), element("line", { x1: 200, x2: 200, y1: 10, y2: 320 }),
    element("text", { x: 390, y: 333, "text-anchor": "end" }, `component ${m + 1}: ${share(m)}`),
    element("text", { x: 208, y: 20 }, n === m ? "" : `component ${n + 1}: ${share(n)}`));
  data.scores.forEach((row, i) => {
    const point = element("circle", { cx: x(row[m]), cy: y(n === m ? 0 : row[n]), r: 7, tabindex: 0, role: "button", "aria-label": data.names[i], "data-i": i });
    point.append(element("title", {}, data.names[i]));
    for (const event of ["pointerenter", "focus", "click"]) point.addEventListener(event, () => choose(i));
    at("plot").append(point);
  });
  show();
}

function pictures() {
  document.querySelectorAll("#specimens canvas").forEach((canvas, i) => {
    const points = (i + 1) * size <= known.length ? asSpecimen(i) : asModel(data.scores[i]);
    paint(fitted(canvas), turned(points, HOME));
  });
}

data.modes.forEach((_, m) => {
  const label = document.createElement("label"), name = document.createElement("span"), small = document.createElement("small");
  const input = Object.assign(document.createElement("input"), { type: "range", min: -3, max: 3, step: 0.01, value: 0 });
  small.textContent = share(m);
  name.append(`Component ${m + 1} `, small);
  label.append(name, input, document.createElement("output"));
  input.addEventListener("input", () => { chosen = -1; scores[m] = Number(input.value); show(); });
  at("sliders").append(label);
  for (const axis of ["x", "y"]) at(axis).append(new Option(`component ${m + 1}`, m, false, m === (axis === "x" ? 0 : Math.min(1, data.modes.length - 1))));
});
data.names.forEach((name, i) => {
  const item = document.createElement("li"), button = Object.assign(document.createElement("button"), { type: "button" });
  const words = document.createElement("bdi");
  words.textContent = name;
  button.append(document.createElement("canvas"), words);
  button.addEventListener("click", () => choose(i));
  item.append(button);
  at("specimens").append(item);
});
for (const axis of ["x", "y"]) at(axis).addEventListener("change", plot);
at("zero").addEventListener("click", () => choose(-1));
at("asmodel").addEventListener("change", show);
at("modelled").hidden = !known.length;

function turnBy(across, up) {
  turn = [turn[0] + across, Math.max(-1.5, Math.min(1.5, turn[1] + up))];
  show();
}
stage.addEventListener("pointerdown", (start) => {
  stage.setPointerCapture(start.pointerId);
  let last = [start.clientX, start.clientY];
  const move = (event) => {
    turnBy((event.clientX - last[0]) / 150, (event.clientY - last[1]) / 150);
    last = [event.clientX, event.clientY];
  };
  stage.addEventListener("pointermove", move);
  for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, () => stage.removeEventListener("pointermove", move), { once: true });
});
const STEPS = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, -0.15], ArrowDown: [0, 0.15] };
stage.addEventListener("keydown", (event) => {
  if (!STEPS[event.key]) return;
  event.preventDefault();
  turnBy(...STEPS[event.key]);
});
window.addEventListener("resize", () => { show(); pictures(); });
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { show(); pictures(); });
plot();
pictures();
document.body.dataset.ready = "";
