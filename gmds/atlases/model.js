"use strict";
const at = (id) => document.getElementById(id);
const data = JSON.parse(at("data").textContent);
const canvas = at("shape"), pen = canvas.getContext("2d");
const scores = data.modes.map(() => 0);
let turn = [0.5, 0.2], chosen = -1, waiting = false;

function placed() {
  const points = Float64Array.from(data.vertices);
  data.modes.forEach((mode, m) => { if (scores[m]) for (let i = 0; i < points.length; i++) points[i] += scores[m] * mode[i]; });
  const [a, b] = turn, [ca, sa, cb, sb] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b)];
  for (let i = 0; i < points.length; i += 3) {
    const [x, y, z] = [points[i], points[i + 1], points[i + 2]];
    const across = ca * x + sa * z, depth = -sa * x + ca * z;
    points[i] = across; points[i + 1] = cb * y - sb * depth; points[i + 2] = sb * y + cb * depth;
  }
  return points;
}

function draw() {
  waiting = false;
  const p = placed(), scale = 0.78 * Math.min(canvas.width, canvas.height), seen = [];
  for (const face of data.faces) {
    const [i, j, k] = face.map((v) => 3 * v);
    const [ux, uy, uz] = [p[j] - p[i], p[j + 1] - p[i + 1], p[j + 2] - p[i + 2]];
    const [vx, vy, vz] = [p[k] - p[i], p[k + 1] - p[i + 1], p[k + 2] - p[i + 2]];
    const normal = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const length = Math.hypot(...normal) || 1;
    const light = Math.abs((0.3 * normal[0] + 0.5 * normal[1] + 0.81 * normal[2]) / length);
    seen.push([p[i + 2] + p[j + 2] + p[k + 2], i, j, k, Math.round(70 + 165 * light)]);
  }
  seen.sort((one, other) => one[0] - other[0]);
  pen.clearRect(0, 0, canvas.width, canvas.height);
  const x = (i) => canvas.width / 2 + scale * p[i], y = (i) => canvas.height / 2 - scale * p[i + 1];
  for (const [, i, j, k, grey] of seen) {
    pen.fillStyle = pen.strokeStyle = `rgb(${grey},${grey},${Math.round(0.96 * grey)})`;
    pen.beginPath(); pen.moveTo(x(i), y(i)); pen.lineTo(x(j), y(j)); pen.lineTo(x(k), y(k)); pen.closePath(); pen.fill(); pen.stroke();
  }
}

function show() {
  if (!waiting) { waiting = true; requestAnimationFrame(draw); }
  document.querySelectorAll("#sliders input").forEach((input, m) => { input.value = scores[m]; input.nextElementSibling.textContent = scores[m].toFixed(2); });
  const mean = scores.every((score) => !score);
  at("told").textContent = chosen >= 0 ? `${data.names[chosen]}, as the first ${data.modes.length} components have it` : mean ? "Mean shape" : "A shape of the model";
  document.querySelectorAll("circle").forEach((point, i) => point.classList.toggle("chosen", i === chosen));
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

function plot() {
  const [m, n] = [Number(at("x").value), Number(at("y").value)];
  const most = Math.max(2.5, ...data.scores.flat().map(Math.abs));
  const x = (s) => 200 + (180 * s) / most, y = (s) => 165 - (150 * s) / most;
  at("plot").replaceChildren(
    element("line", { x1: 10, x2: 390, y1: 165, y2: 165 }), element("line", { x1: 200, x2: 200, y1: 10, y2: 320 }),
    element("text", { x: 390, y: 335, "text-anchor": "end" }, `component ${m + 1}: ${(100 * data.shares[m]).toFixed(1)} %`),
    element("text", { x: 206, y: 18 }, `component ${n + 1}: ${(100 * data.shares[n]).toFixed(1)} %`));
  data.scores.forEach((row, i) => {
    const point = element("circle", { cx: x(row[m]), cy: y(n === m ? 0 : row[n]), r: 6, tabindex: 0, role: "button", "aria-label": data.names[i] });
    point.append(element("title", {}, data.names[i]));
    for (const event of ["pointerenter", "focus", "click"]) point.addEventListener(event, () => choose(i));
    at("plot").append(point);
  });
  show();
}

data.modes.forEach((_, m) => {
  const label = document.createElement("label");
  const input = Object.assign(document.createElement("input"), { type: "range", min: -3, max: 3, step: 0.05, value: 0 });
  label.append(`Component ${m + 1} (${(100 * data.shares[m]).toFixed(1)} %)`, input, document.createElement("output"));
  input.addEventListener("input", () => { chosen = -1; scores[m] = Number(input.value); show(); });
  at("sliders").append(label);
  for (const axis of ["x", "y"]) at(axis).append(new Option(`component ${m + 1}`, m, false, m === (axis === "x" ? 0 : Math.min(1, data.modes.length - 1))));
});
for (const axis of ["x", "y"]) at(axis).addEventListener("change", plot);
at("zero").addEventListener("click", () => choose(-1));
canvas.addEventListener("pointerdown", (start) => {
  canvas.setPointerCapture(start.pointerId);
  let last = [start.clientX, start.clientY];
  const move = (event) => {
    turn = [turn[0] + (event.clientX - last[0]) / 150, Math.max(-1.5, Math.min(1.5, turn[1] + (event.clientY - last[1]) / 150))];
    last = [event.clientX, event.clientY];
    show();
  };
  canvas.addEventListener("pointermove", move);
  canvas.addEventListener("pointerup", () => canvas.removeEventListener("pointermove", move), { once: true });
});
plot();
