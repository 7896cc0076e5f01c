// The two figures under the surfaces: how the shown values are spread, and the cumulative curve of the errors.
"use strict";

const SIZE = { width: 520, height: 250, left: 52, right: 14, top: 12, bottom: 46 };
const LINES = ["", "7 4", "2 4", "9 3 2 3"];

function svg(tag, attributes, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  Object.entries(attributes).forEach(([name, value]) => made.setAttribute(name, value));
  made.append(...children);
  return made;
}

// round numbers from 0 to `top`, some five of them
function ticks(top) {
  const rough = top / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= rough);
  return Array.from({ length: Math.floor(top / step + 1e-9) + 1 }, (_, i) => Number((i * step).toPrecision(6)));
}

function frame(div, right, top, xTitle, yTitle) {
  const { width, height } = SIZE;
  const x = (v) => SIZE.left + ((width - SIZE.left - SIZE.right) * v) / right;
  const y = (v) => height - SIZE.bottom - ((height - SIZE.bottom - SIZE.top) * v) / top;
  const plot = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "chart", role: "img", "aria-label": `${yTitle} against ${xTitle}` });
  for (const v of ticks(top)) {
    plot.append(svg("line", { x1: SIZE.left, x2: width - SIZE.right, y1: y(v), y2: y(v), class: "grid" }));
    plot.append(svg("text", { x: SIZE.left - 6, y: y(v) + 4, "text-anchor": "end" }, String(v)));
  }
  for (const v of ticks(right)) plot.append(svg("text", { x: x(v), y: height - SIZE.bottom + 16, "text-anchor": "middle" }, String(v)));
  plot.append(svg("text", { x: (SIZE.left + width - SIZE.right) / 2, y: height - 6, "text-anchor": "middle" }, xTitle));
  plot.append(svg("text", { x: 0, y: 0, transform: `translate(13 ${(height - SIZE.bottom + SIZE.top) / 2}) rotate(-90)`, "text-anchor": "middle" }, yTitle));
  div.replaceChildren(plot);
  return { plot, x, y };
}

function titled(element, text) {
  element.append(svg("title", {}, text));
  return element;
}

function drawHistogram(div, { axis, counted, high, counts }, colour) {
  const total = counts.reduce((sum, n) => sum + n, 0) || 1;
  const share = counts.map((n) => (100 * n) / total);
  const { plot, x, y } = frame(div, high, Math.max(...share) || 1, axis, `% of ${counted}`);
  const width = high / counts.length;
  share.forEach((s, i) => {
    const [left, right] = [x(i * width), x((i + 1) * width)];
    const bar = svg("rect", { x: left, y: y(s), width: Math.max(right - left - 0.6, 0.4), height: y(0) - y(s), fill: colour((i + 0.5) / counts.length) });
    plot.append(titled(bar, `${s.toFixed(1)} % from ${figure(i * width)} to ${figure((i + 1) * width)}`));
  });
}

function drawCurves(div, thresholds, curves, chosen) {
  const { plot, x, y } = frame(div, thresholds[thresholds.length - 1], 100, "error: distance from the true point / √area", "% of points");
  [0.05, 0.1].forEach((v) => plot.append(svg("line", { x1: x(v), x2: x(v), y1: y(0), y2: y(100), class: "grid" })));
  curves.forEach((curve, i) => {
    const points = curve.share.map((s, k) => `${x(thresholds[k]).toFixed(1)},${y(100 * s).toFixed(1)}`).join(" ");
    const line = svg("polyline", { points, "stroke-dasharray": LINES[i % 4], class: i === chosen ? "curve chosen" : "curve" });
    plot.append(titled(line, curve.name));
  });
  if (curves.length < 2) return;
  curves.forEach((curve, i) => {
    const height = y(0) - 10 - 16 * (curves.length - 1 - i);
    const end = SIZE.width - SIZE.right - 4;
    plot.append(svg("line", { x1: end - 28, x2: end, y1: height - 4, y2: height - 4, "stroke-dasharray": LINES[i % 4], class: i === chosen ? "curve chosen" : "curve" }));
    plot.append(svg("text", { x: end - 34, y: height, "text-anchor": "end" }, curve.name));
  });
}
