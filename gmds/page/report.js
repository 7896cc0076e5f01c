"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const plot = document.getElementById("view");
const choice = document.getElementById("choice");
const together = document.getElementById("together");
const caption = document.getElementById("caption");
const [source, target] = data.surfaces;

function columns(rows) {
  return { x: rows.map((r) => r[0]), y: rows.map((r) => r[1]), z: rows.map((r) => r[2]) };
}

function hex(numbers) {
  return numbers.map((c) => "#" + c.toString(16).padStart(6, "0"));
}

function surface(shape, scene, colours) {
  const [i, j, k] = [0, 1, 2].map((c) => shape.faces.map((f) => f[c]));
  return {
    type: "mesh3d", ...columns(shape.vertices), i, j, k, scene, vertexcolor: hex(colours), hoverinfo: "none",
    flatshading: false, lighting: { ambient: 0.65, diffuse: 0.5, specular: 0.05, roughness: 0.9, fresnel: 0 },
    lightposition: { x: 2000, y: 3000, z: 4000 },
  };
}

function pin(scene) {
  return { type: "scatter3d", x: [], y: [], z: [], scene, mode: "markers", hoverinfo: "none", showlegend: false,
    marker: { size: 7, color: "#000", line: { color: "#fff", width: 2 } } };
}

function space(left, right) {
  const hidden = { visible: false };
  return { domain: { x: [left, right], y: [0, 1] }, aspectmode: "data", xaxis: hidden, yaxis: hidden, zaxis: hidden,
    camera: JSON.parse(JSON.stringify(data.camera)) };
}

const traces = [
  surface(source, "scene", data.views[0].source), surface(target, "scene2", data.views[0].target),
  pin("scene"), pin("scene2"),
];
const layout = { margin: { l: 0, r: 0, t: 0, b: 0 }, showlegend: false, scene: space(0, 0.5), scene2: space(0.5, 1) };

function show(number) {
  const view = data.views[number];
  Plotly.restyle(plot, { vertexcolor: [hex(view.source), hex(view.target)] }, [0, 1]);
  Plotly.restyle(plot, { x: [[], []], y: [[], []], z: [[], []] }, [2, 3]);
  caption.textContent = view.caption;
  document.getElementById("legend").hidden = !view.range;
  if (view.range) {
    document.getElementById("low").textContent = view.range[0];
    document.getElementById("high").textContent = view.range[1];
  }
}

function mark(vertex) {
  const view = data.views[choice.selectedIndex];
  const face = target.faces[view.face[vertex]];
  const weights = view.weights[vertex];
  const place = [0, 1, 2].map((c) => face.reduce((sum, v, k) => sum + weights[k] * target.vertices[v][c], 0));
  const [a, b] = [source.vertices[vertex], place];
  Plotly.restyle(plot, { x: [[a[0]], [b[0]]], y: [[a[1]], [b[1]]], z: [[a[2]], [b[2]]] }, [2, 3]);
  caption.textContent = `Source vertex ${vertex} goes to face ${view.face[vertex]} of the target, near vertex ` +
    `${face[weights.indexOf(Math.max(...weights))]}.`;
}

data.views.forEach((view) => choice.add(new Option(view.name)));
Plotly.newPlot(plot, traces, layout, {
  responsive: true, displaylogo: false, modeBarButtons: [["toImage", "resetCameraDefault3d"]],
}).then(() => {
  let busy = false;
  const follow = (event) => {
    const from = ["scene", "scene2"].find((scene) => event[scene + ".camera"]);
    if (busy || !from || !together.checked) return;
    const camera = JSON.parse(JSON.stringify(event[from + ".camera"]));
    busy = true; // the other scene answers with an event of its own
    setTimeout(() => Plotly.relayout(plot, { [(from === "scene" ? "scene2" : "scene") + ".camera"]: camera })
      .then(() => { busy = false; }), 0);
  };
  plot.on("plotly_relayout", follow);
  let marked = -1;
  plot.on("plotly_click", (event) => {
    const point = event.points[0];
    if (point.curveNumber !== 0 || point.pointNumber === marked) return;
    marked = point.pointNumber;
    setTimeout(() => mark(marked), 0); // the event comes out of drawing, and marking draws
  });
  choice.addEventListener("change", () => show(choice.selectedIndex));
  show(0);
  document.body.dataset.ready = "yes";
});
