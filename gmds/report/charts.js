// The two figures under the surfaces: how the shown values are spread, and the cumulative curve of the errors.
"use strict";

const PLAIN = { responsive: true, displayModeBar: false };
const LINES = ["solid", "dash", "dot", "dashdot"];

function ink(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function chartLayout(xTitle, yTitle, more) {
  const axis = { color: ink("--soft"), gridcolor: ink("--line"), zeroline: false, fixedrange: true, automargin: true };
  return {
    height: 250, margin: { l: 52, r: 12, t: 10, b: 44 }, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
    font: { family: "inherit", size: 12, color: ink("--soft") }, showlegend: false, bargap: 0.06,
    xaxis: { ...axis, title: { text: xTitle } }, yaxis: { ...axis, title: { text: yTitle }, rangemode: "tozero" }, ...more,
  };
}

function drawHistogram(div, mode, counts, ramp) {
  const total = counts.reduce((sum, n) => sum + n, 0) || 1;
  const width = mode.high / counts.length;
  const trace = {
    type: "bar", x: Array.from(counts, (_, i) => (i + 0.5) * width), y: Array.from(counts, (n) => (100 * n) / total),
    width, marker: { color: Array.from(counts, (_, i) => ramp((i + 0.5) / counts.length)) },
    hovertemplate: "%{y:.1f} % near %{x:.3g}<extra></extra>",
  };
  return Plotly.react(div, [trace], chartLayout(mode.axis, `% of ${mode.counted}`), PLAIN);
}

function drawCurves(div, thresholds, curves, chosen) {
  const traces = curves.map((curve, i) => ({
    type: "scatter", mode: "lines", x: Array.from(thresholds), y: Array.from(curve.share, (s) => 100 * s), name: curve.name,
    line: { color: i === chosen ? ink("--accent") : ink("--soft"), width: i === chosen ? 3 : 1.5, dash: LINES[i % 4] },
    hovertemplate: "%{y:.1f} % within %{x:.3g}<extra>%{fullData.name}</extra>",
  }));
  const shapes = [0.05, 0.1, 0.25].map((x) => ({ type: "line", x0: x, x1: x, y0: 0, y1: 100, line: { color: ink("--line"), width: 1 } }));
  const legend = { x: 1, y: 0, xanchor: "right", yanchor: "bottom", bgcolor: "rgba(0,0,0,0)" };
  const layout = chartLayout("error: distance from the true point / √area", "% of points", { shapes, legend, showlegend: traces.length > 1 });
  layout.yaxis.range = [0, 101];
  return Plotly.react(div, traces, layout, PLAIN);
}
