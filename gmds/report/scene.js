// One surface in a panel of its own, drawn by plotly.
"use strict";

const LEVEL = { up: { x: 0, y: 1, z: 0 }, center: { x: 0, y: 0, z: 0 }, eye: { x: 0, y: 0, z: 1.4 } };
const FILLED = 0.9; // of the panel
const HIDDEN = 0.03; // of the surface's size: so far behind what is in front of it, a point cannot be seen

// an axis of which nothing is drawn (one that is not `visible` has its texts made all the same)
const BARE = { title: { text: "" }, tickvals: [], ticks: "", showticklabels: false, showgrid: false, showline: false,
  zeroline: false, showbackground: false, showspikes: false };

const copied = (thing) => JSON.parse(JSON.stringify(thing));

function column(rows, k, kind) {
  const values = new kind(rows.length / 3);
  for (let i = 0; i < values.length; i++) values[i] = rows[3 * i + k];
  return values;
}

function cssColours(rgb) {
  const colours = new Array(rgb.length / 3);
  for (let i = 0; i < colours.length; i++) colours[i] = `rgb(${rgb[3 * i]},${rgb[3 * i + 1]},${rgb[3 * i + 2]})`;
  return colours;
}

class Scene {
  constructor(panel, surface) {
    this.panel = panel;
    this.surface = surface;
    this.plot = panel.querySelector(".plot");
    this.camera = FIRST;
    this.moved = () => {};
  }

  async draw(rgb) {
    const { vertices, faces } = this.surface;
    const [x, y, z] = [0, 1, 2].map((k) => column(vertices, k, Float32Array));
    const [i, j, k] = [0, 1, 2].map((c) => column(faces, c, faces.constructor));
    const trace = {
      type: "mesh3d", x, y, z, i, j, k, vertexcolor: cssColours(rgb), hoverinfo: "skip", flatshading: false,
      lighting: { ambient: 0.66, diffuse: 0.5, specular: 0.06, roughness: 0.85, fresnel: 0.02,
        vertexnormalsepsilon: 0, facenormalsepsilon: 0 },
      lightposition: { x: 3000, y: 6000, z: 8000 },
    };
    // axes of length one about the origin: what is drawn is where `project` says
    const axis = { range: [-0.5, 0.5], ...BARE };
    const layout = {
      margin: { l: 0, r: 0, t: 0, b: 0 }, paper_bgcolor: "rgba(0,0,0,0)", hovermode: false,
      scene: { xaxis: axis, yaxis: axis, zaxis: axis, aspectmode: "cube", dragmode: "orbit", camera: copied(this.camera),
        bgcolor: "rgba(0,0,0,0)" },
    };
    await Plotly.newPlot(this.plot, [trace], layout, { responsive: true, displayModeBar: false, doubleClick: false });
    const follow = (event) => {
      const camera = event && event["scene.camera"];
      if (camera && camera.eye) this.look(camera, false);
    };
    this.plot.on("plotly_relayouting", follow);
    this.plot.on("plotly_relayout", follow);
  }

  // `tell` plotly too, unless the camera comes from there
  look(camera, tell = true) {
    if (JSON.stringify(camera) === JSON.stringify(this.camera)) return;
    this.camera = copied(camera);
    this.shown = null;
    if (tell) Plotly.relayout(this.plot, { "scene.camera": copied(camera) });
    this.moved(this);
  }

  paint(rgb) {
    return Plotly.restyle(this.plot, { vertexcolor: [cssColours(rgb)] }, [0]);
  }

  resized() {
    this.shown = null;
  }

  get lens() {
    return lens(this.camera, this.plot.clientWidth, this.plot.clientHeight);
  }

  get projected() {
    this.shown = this.shown || projectAll(this.lens, this.surface.vertices);
    return this.shown;
  }

  // the vertex in front at a place of the panel, or -1
  vertexAt(x, y) {
    const hit = front(this.projected, this.surface.faces, x, y);
    return hit ? hit.vertex : -1;
  }

  // where a point is in the panel, and whether the surface hides it
  place(p) {
    const [x, y, depth] = project(this.lens, p);
    const hit = front(this.projected, this.surface.faces, x, y);
    return { x, y, hidden: Boolean(hit) && hit.depth < depth - HIDDEN };
  }

  vertex(number) {
    return Array.from(this.surface.vertices.subarray(3 * number, 3 * number + 3));
  }
}

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

function rolled(camera, angle) {
  return { ...camera, up: named(turned(xyz(camera.up), unit(minus(xyz(camera.eye), xyz(camera.center))), angle)) };
}
