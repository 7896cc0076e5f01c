// What hands do: pointing, turning, choosing.
"use strict";

const TURN = Math.PI / 12;
const SIDES = { front: [0, 0], left: [-Math.PI / 2, 0], back: [Math.PI, 0], right: [Math.PI / 2, 0], top: [0, -Math.PI / 2], below: [0, Math.PI / 2] };
const KEYS = {
  ArrowLeft: (c) => rotated(c, TURN, 0), ArrowRight: (c) => rotated(c, -TURN, 0),
  ArrowUp: (c) => rotated(c, 0, -TURN), ArrowDown: (c) => rotated(c, 0, TURN),
  "+": (c) => zoomed(c, 0.85), "=": (c) => zoomed(c, 0.85), "-": (c) => zoomed(c, 1 / 0.85),
};

function link(page) {
  page.scenes.forEach((scene, side) => {
    scene.moved = () => {
      const other = page.scenes[1 - side];
      if (at("together").checked) other.look(scene.camera);
      page.placeMarks();
    };
  });
}

function point(page) {
  page.scenes.forEach((scene, side) => {
    const under = (event) => {
      const box = scene.plot.getBoundingClientRect();
      const vertex = scene.vertexAt(event.clientX - box.left, event.clientY - box.top);
      return vertex < 0 ? null : { side, vertex };
    };
    let waiting = null;
    let pressed = null;
    const hover = (event) => {
      if (page.pinned || event.buttons) return;
      if (!waiting) requestAnimationFrame(() => { page.mark(under(waiting)); waiting = null; });
      waiting = event;
    };
    // plotly keeps these events to itself once they reach its canvas
    scene.panel.addEventListener("pointermove", hover, true);
    scene.panel.addEventListener("pointerleave", () => { if (!page.pinned) page.mark(null); });
    scene.panel.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; }, true);
    scene.panel.addEventListener("pointerup", (event) => {
      const still = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4;
      if (still) page.pin(under(event));
    }, true);
    scene.panel.addEventListener("keydown", (event) => {
      const move = KEYS[event.key];
      if (!move || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      scene.look(move(scene.camera));
    });
  });
}

function choose(page) {
  const both = (camera) => page.scenes.forEach((scene) => scene.look(camera(scene.camera)));
  const from = (camera) => both(() => fitted(page.scenes, camera));
  page.data.maps.forEach((map) => at("map").add(new Option(map.name)));
  at("map-choice").hidden = page.data.maps.length < 2;
  at("map").addEventListener("change", () => page.show());
  document.querySelectorAll("input[name=mode]").forEach((input) => input.addEventListener("change", () => page.show()));
  document.querySelectorAll("[data-side]").forEach((button) =>
    button.addEventListener("click", () => from(rotated(LEVEL, ...SIDES[button.dataset.side]))));
  at("reset").addEventListener("click", () => from(FIRST));
  at("roll").addEventListener("click", () => both((camera) => rolled(camera, Math.PI / 2)));
  at("largest").addEventListener("click", () => page.goToLargest());
  at("go").addEventListener("submit", (event) => {
    event.preventDefault();
    page.goTo(Number(at("go-side").value), Number(at("go-vertex").value));
  });
  document.addEventListener("keydown", (event) => { if (event.key === "Escape") page.pin(null); });
  addEventListener("resize", () => {
    page.scenes.forEach((scene) => scene.resized());
    page.placeMarks();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => page.drawCharts());
}

function fail(message) {
  at("trouble").textContent = message;
  at("trouble").hidden = false;
  document.body.dataset.ready = "no";
}

async function start() {
  if (!("DecompressionStream" in window)) return fail("This page needs a newer browser: one from 2023 or later.");
  if (!document.createElement("canvas").getContext("webgl")) {
    return fail("This browser cannot draw in 3-D (WebGL is off). The figures and tables below can still be read.");
  }
  const [data] = await Promise.all([unpackedData("data"), runLibrary("library")]);
  const page = new Page(data);
  window.gmdsPage = page;
  choose(page);
  page.scenes.forEach((scene) => { scene.camera = fitted(page.scenes, FIRST); });
  await Promise.all([page.scenes[0].draw(page.colours(0)), page.scenes[1].draw(page.colours(1))]);
  link(page);
  point(page);
  await page.show();
  document.body.dataset.ready = "yes";
}

start().catch((error) => fail(`The page could not be drawn: ${error.message}`));
