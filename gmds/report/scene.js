// One surface in a panel of its own: where it is looked at from, what is under a place of the panel.
"use strict";

const HIDDEN = 0.012; // of the surface's size: so far behind what is in front of it, a point cannot be seen

class Scene {
  constructor(panel, surface) {
    this.panel = panel;
    this.surface = surface;
    this.plot = panel.querySelector(".plot");
    this.canvas = panel.querySelector("canvas");
    this.camera = FIRST;
    this.options = { wireframe: false, squares: 0 };
    this.positions = surface.vertices;
    this.moved = () => {};
    this.painter = new Painter(this.canvas, surface.faces);
    this.painter.restored = () => { this.placeAt(this.positions); this.given.forEach(([name, values]) => this.painter.give(name, values)); };
    this.given = new Map();
    this.placeAt(surface.vertices);
  }

  // moves the vertices, as a morph does
  placeAt(positions) {
    this.positions = positions;
    this.painter.give("position", Float32Array.from(positions));
    this.painter.give("normal", normals(positions, this.surface.faces));
    this.shown = null;
    this.render();
  }

  give(name, values) {
    this.given.set(name, values);
    this.painter.give(name, values);
    this.render();
  }

  paint(rgb) {
    this.painted = rgb;
    this.give("colour", rgb);
  }

  look(camera) {
    if (JSON.stringify(camera) === JSON.stringify(this.camera)) return;
    this.camera = copied(camera);
    this.shown = null;
    this.render();
    this.moved(this);
  }

  render() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    cancelAnimationFrame(this.waiting);
    this.waiting = 0;
    if (this.plot.clientWidth) this.painter.draw(this.lens, this.options);
  }

  resized() {
    this.shown = null;
    this.render();
  }

  get lens() {
    return lens(this.camera, this.plot.clientWidth, this.plot.clientHeight);
  }

  get projected() {
    this.shown = this.shown || projectAll(this.lens, this.positions);
    return this.shown;
  }

  // what is in front at a place of the panel, with its position; null beside the surface
  hit(x, y) {
    const found = front(this.projected, this.surface.faces, x, y);
    return found && { ...found, position: this.mixed(found.corners, found.weights) };
  }

  vertexAt(x, y) {
    const found = front(this.projected, this.surface.faces, x, y);
    return found ? found.vertex : -1;
  }

  // where a point is in the panel, and whether the surface hides it
  place(p) {
    const [x, y, depth] = project(this.lens, p);
    const found = front(this.projected, this.surface.faces, x, y);
    return { x, y, hidden: Boolean(found) && found.depth < depth - HIDDEN };
  }

  vertex(number) {
    return Array.from(this.positions.subarray(3 * number, 3 * number + 3));
  }

  mixed(corners, weights) {
    return [0, 1, 2].map((k) => corners.reduce((sum, corner, i) => sum + weights[i] * this.positions[3 * corner + k], 0));
  }
}

const CLICK = 4; // pixels that a pointer may stray within a click; after them is known what it does

// Hands on a panel: drag turns, shift or the right button moves, the wheel and two fingers zoom. What a finger does
// its first pixels say: upright it scrolls the page and the surface stays, else it turns the surface and the page stays.
function handle(scene, clicked) {
  const { plot } = scene;
  const fingers = new Map();
  let pressed = null;
  let working = false; // a tool has the pointer
  plot.addEventListener("pointerdown", (event) => {
    working = Boolean(scene.tool && event.button === 0 && scene.tool("down", event));
    if (working) return plot.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    pressed = { x: event.clientX, y: event.clientY, far: fingers.size > 1, scrolls: false };
    plot.setPointerCapture(event.pointerId);
  });
  plot.addEventListener("pointermove", (event) => {
    if (working) return scene.tool("move", event);
    const last = fingers.get(event.pointerId);
    if (!last) return;
    const before = spread(fingers);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (!pressed.far) begin(pressed, event);
    if (pressed.far && !pressed.scrolls) drag(scene, event, last, fingers.size > 1 ? before / (spread(fingers) || before) : 0);
  });
  const released = (event) => {
    if (working) {
      working = false;
      return scene.tool("up", event);
    }
    fingers.delete(event.pointerId);
    if (event.type === "pointerup" && pressed && !pressed.far && event.button === 0) clicked(event);
    if (!fingers.size) pressed = null;
  };
  plot.addEventListener("pointerup", released);
  plot.addEventListener("pointercancel", released);
  plot.addEventListener("touchmove", (event) => {
    if (event.cancelable && (working || (pressed && pressed.far && !pressed.scrolls))) event.preventDefault();
  }, { passive: false });
  plot.addEventListener("contextmenu", (event) => event.preventDefault());
  plot.addEventListener("wheel", (event) => {
    event.preventDefault();
    scene.look(zoomed(scene.camera, Math.exp(Math.min(Math.max(event.deltaY, -200), 200) / 600)));
  }, { passive: false });
}

// whether a pointer is more than a click by now, and whether it is a finger that scrolls the page
function begin(pressed, event) {
  const [dx, dy] = [Math.abs(event.clientX - pressed.x), Math.abs(event.clientY - pressed.y)];
  pressed.far = Math.hypot(dx, dy) >= CLICK;
  pressed.scrolls = pressed.far && event.pointerType === "touch" && dy > dx;
}

// a step of a pointer from where it was last; `closer` is by what factor two fingers bring the surface, 0 for one
function drag(scene, event, last, closer) {
  const [dx, dy] = [event.clientX - last[0], event.clientY - last[1]];
  const height = scene.plot.clientHeight;
  if (closer) scene.look(panned(zoomed(scene.camera, closer), dx / 2, dy / 2, height));
  else if (event.shiftKey || event.buttons & 2) scene.look(panned(scene.camera, dx, dy, height));
  else scene.look(rotated(scene.camera, (-dx * Math.PI) / height, (-dy * Math.PI) / height));
}

function spread(fingers) {
  const [a, b] = [...fingers.values()];
  return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
}
