// One surface drawn by WebGL: colours of its vertices under a light that comes with the viewer, edges, and dots.
"use strict";

const NEAR = 0.01, FAR = 20; // of what is drawn, in sizes of the surface
const SEEN = `#version 300 es
precision highp float;
uniform vec3 eye, right, up, back; uniform vec2 focal; uniform float nearer;
in vec3 position; in vec3 normal; in vec3 colour; in vec3 place;
out vec3 shade, facing, seat, spot;
void main() {
  vec3 d = position - eye;
  float depth = -dot(d, back);
  float z = (depth * float(${FAR + NEAR}) - float(${2 * FAR * NEAR})) / float(${FAR - NEAR});
  gl_Position = vec4(dot(d, right) * focal.x, dot(d, up) * focal.y, z - nearer * depth, depth);
  gl_PointSize = 9.0;
  shade = colour; facing = normal; seat = place; spot = position;
}`;
const SHADED = `#version 300 es
precision highp float;
uniform vec3 right, up, back; uniform float kind, squares;
in vec3 shade, facing, seat, spot;
out vec4 pixel;
void main() {
  if (kind > 1.5) { // dots
    float away = length(gl_PointCoord - 0.5);
    if (away > 0.5) discard;
    pixel = vec4(away > 0.36 ? vec3(1.0) : shade, 1.0);
  } else if (kind > 0.5) { // edges
    bool dark = dot(shade, vec3(0.3, 0.6, 0.1)) < 0.2; // about the luminance, which dark blue is below
    pixel = vec4(vec3(dark ? 0.9 : 0.1), 1.0) * 0.35;
  } else {
    vec3 n = normalize(gl_FrontFacing ? facing : -facing);
    float light = 0.56 + 0.46 * max(dot(n, normalize(back + 0.5 * up - 0.3 * right)), 0.0);
    if (squares > 0.0) {
      vec3 cell = floor(seat * squares);
      light *= mod(cell.x + cell.y + cell.z, 2.0) < 0.5 ? 1.0 : 0.72;
    }
    pixel = vec4(shade * min(light, 1.0), 1.0);
  }
}`;

const NO_WEBGL = "This browser cannot draw in 3-D (WebGL is off). The figures and tables below can still be read.";

class Painter {
  constructor(canvas, faces) {
    this.gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!this.gl) throw Object.assign(new Error("no WebGL"), { told: NO_WEBGL });
    this.canvas = canvas;
    this.faces = faces;
    this.buffers = {};
    this.dots = 0;
    this.prepare();
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => { this.prepare(); this.restored(); });
  }

  restored() {}

  prepare() {
    const { gl } = this;
    this.program = gl.createProgram();
    [[gl.VERTEX_SHADER, SEEN], [gl.FRAGMENT_SHADER, SHADED]].forEach(([type, text]) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(this.program, shader);
    });
    ["position", "normal", "colour", "place"].forEach((name, i) => gl.bindAttribLocation(this.program, i, name));
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.program) || "no shader");
    gl.useProgram(this.program);
    this.uniform = (name) => gl.getUniformLocation(this.program, name);
    this.buffers = {};
    this.index = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.index);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, Uint32Array.from(this.faces), gl.STATIC_DRAW);
    this.edges = null;
  }

  // `name` of a table with three entries a row, floats or bytes
  give(name, values) {
    const { gl } = this;
    this.buffers[name] = this.buffers[name] || gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name]);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    if (name === "dot") this.dots = values.length / 3;
  }

  bind(slot, name, bytes) {
    const { gl } = this;
    if (!this.buffers[name]) return gl.disableVertexAttribArray(slot);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name]);
    gl.enableVertexAttribArray(slot);
    gl.vertexAttribPointer(slot, 3, bytes ? gl.UNSIGNED_BYTE : gl.FLOAT, bytes, 0, 0);
  }

  draw(view, { wireframe, squares }) {
    const { gl, canvas } = this;
    const fine = Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = [Math.round(view.width * fine), Math.round(view.height * fine)];
    if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
    gl.viewport(0, 0, w, h);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    ["eye", "right", "up", "back"].forEach((name) => gl.uniform3fv(this.uniform(name), view[name]));
    gl.uniform2f(this.uniform("focal"), (2 * view.focal) / view.width, (2 * view.focal) / view.height);
    gl.uniform1f(this.uniform("squares"), squares || 0);
    const kind = (number, nearer) => { gl.uniform1f(this.uniform("kind"), number); gl.uniform1f(this.uniform("nearer"), nearer); };
    this.bind(0, "position", false);
    this.bind(1, "normal", false);
    this.bind(2, "colour", true);
    this.bind(3, "place", false);
    kind(0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.index);
    gl.drawElements(gl.TRIANGLES, this.faces.length, gl.UNSIGNED_INT, 0);
    if (wireframe) {
      kind(1, 0.0005);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.edgeIndex());
      gl.drawElements(gl.LINES, 2 * this.faces.length, gl.UNSIGNED_INT, 0);
    }
    if (this.dots) {
      kind(2, 0.002);
      this.bind(0, "dot", false);
      this.bind(2, "dotColour", true);
      gl.drawArrays(gl.POINTS, 0, this.dots);
    }
  }

  edgeIndex() {
    if (this.edges) return this.edges;
    const { gl, faces } = this;
    const ends = new Uint32Array(2 * faces.length);
    for (let f = 0; f < faces.length; f += 3) ends.set([faces[f], faces[f + 1], faces[f + 1], faces[f + 2], faces[f + 2], faces[f]], 2 * f);
    this.edges = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.edges);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, ends, gl.STATIC_DRAW);
    return this.edges;
  }
}

// of every vertex, the sum of those of its faces, as long as twice their area
function normals(positions, faces) {
  const sums = new Float32Array(positions.length);
  for (let f = 0; f < faces.length; f += 3) {
    const [a, b, c] = [3 * faces[f], 3 * faces[f + 1], 3 * faces[f + 2]];
    const [ux, uy, uz] = [positions[b] - positions[a], positions[b + 1] - positions[a + 1], positions[b + 2] - positions[a + 2]];
    const [vx, vy, vz] = [positions[c] - positions[a], positions[c + 1] - positions[a + 1], positions[c + 2] - positions[a + 2]];
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const k of [a, b, c]) { sums[k] += x; sums[k + 1] += y; sums[k + 2] += z; }
  }
  return sums;
}
