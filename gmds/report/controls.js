// What hands do: pointing, turning, choosing.
"use strict";

const NEARBY = 6, AROUND = 8; // pixels about the pointer that are tried, and at how many places
const TURN = Math.PI / 12;
const SIDES = { front: [0, 0], left: [-Math.PI / 2, 0], back: [Math.PI, 0], right: [Math.PI / 2, 0], top: [0, -Math.PI / 2], below: [0, Math.PI / 2] };
const KEYS = {
  ArrowLeft: (c) => rotated(c, TURN, 0), ArrowRight: (c) => rotated(c, -TURN, 0),
  ArrowUp: (c) => rotated(c, 0, -TURN), ArrowDown: (c) => rotated(c, 0, TURN),
  "+": (c) => zoomed(c, 0.85), "=": (c) => zoomed(c, 0.85), "-": (c) => zoomed(c, 1 / 0.85),
};

// a scene looks where its panel is turned to, and the others with it
function link(page, scene) {
  scene.moved = () => {
    if (at("together").checked || scene === page.scenes[2]) page.scenes.forEach((other) => other.look(scene.camera));
    else if (scene === page.scenes[0] && page.scenes[2]) page.scenes[2].look(scene.camera);
    page.marks.moved();
    page.changed();
  };
}

function point(page, scene, panel) {
  const side = panel === 1 ? 1 : 0;
  const under = (event, snaps = false) => {
    const box = scene.plot.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    let hit = scene.hit(x, y);
    for (const far of [NEARBY / 2, NEARBY]) { // a click just beside an outline is meant to be on it
      if (hit || !snaps) break;
      const turns = Array.from({ length: AROUND }, (_, i) => (2 * Math.PI * i) / AROUND);
      const near = turns.map((angle) => scene.hit(x + far * Math.cos(angle), y + far * Math.sin(angle))).filter(Boolean);
      hit = near.sort((a, b) => a.depth - b.depth)[0];
    }
    return hit ? { side, vertex: hit.vertex, panel, hit } : null;
  };
  let waiting = null;
  scene.under = under;
  scene.plot.addEventListener("pointermove", (event) => {
    if (event.buttons) return;
    if (!waiting) requestAnimationFrame(() => { page.mark(under(waiting)); waiting = null; });
    waiting = event;
  });
  // a finger leaves as soon as it is lifted: what it tapped is still to be read
  scene.panel.addEventListener("pointerleave", (event) => { if (event.pointerType !== "touch") page.mark(null); });
  handle(scene, (event) => {
    const found = under(event, true);
    if (!(page.work && page.work.clicked(found)) && found) page.pin(found);
  });
  scene.panel.addEventListener("keydown", (event) => {
    const move = KEYS[event.key];
    if (!move || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    scene.look(move(scene.camera));
  });
  link(page, scene);
}

// the source once more, with another map
function showBeside(page) {
  const map = at("beside").value === "" ? null : page.data.maps[Number(at("beside").value)];
  at("panel-2").hidden = !map;
  at("stage").classList.toggle("three", Boolean(map));
  if (map && !page.scenes[2]) {
    page.scenes[2] = page.kept || new Scene(at("panel-2"), page.surfaces[2]);
    if (!page.kept) point(page, page.scenes[2], 2);
    page.kept = page.scenes[2];
    page.scenes[2].look(page.scenes[0].camera);
  } else if (!map) page.scenes.length = 2;
  if (map) at("beside-name").textContent = map.name;
  page.scenes.forEach((scene) => scene.resized());
  if (page.panels && page.panels !== page.scenes.length) { // narrower or wider panels: all is to be seen again
    const near = fitted(page.scenes, page.scenes[0].camera);
    page.scenes.forEach((scene) => scene.look(near));
  }
  page.panels = page.scenes.length;
  options(page);
  page.show();
}

function options(page) {
  page.scenes.forEach((scene) => {
    scene.options = { wireframe: at("wireframe").checked, squares: at("squares").checked && page.mode.key === "match" ? SQUARES : 0 };
    scene.render();
  });
}

function listMaps(page) {
  const chosen = [at("map").selectedIndex, at("beside").value];
  at("map").replaceChildren(...page.data.maps.map((map) => new Option(map.name)));
  at("beside").replaceChildren(new Option("nothing", ""), ...page.data.maps.map((map, i) => new Option(map.name, i)));
  at("map").selectedIndex = Math.max(chosen[0], 0);
  at("beside").value = chosen[1];
  for (const id of ["map-choice", "beside-choice"]) at(id).hidden = page.data.maps.length < 2;
  page.keepRoom();
}

function choose(page) {
  const both = (camera) => page.scenes.forEach((scene) => scene.look(camera(scene.camera)));
  const from = (camera) => both(() => fitted(page.scenes, camera));
  const show = () => { options(page); page.show(); };
  listMaps(page);
  ["map", "fit", "fine"].forEach((id) => at(id).addEventListener("change", show));
  at("beside").addEventListener("change", () => showBeside(page));
  document.querySelectorAll("input[name=mode]").forEach((input) => input.addEventListener("change", () => { page.wanted = null; show(); }));
  ["squares", "wireframe"].forEach((id) => at(id).addEventListener("change", () => { options(page); page.changed(); }));
  at("morph").addEventListener("input", () => { page.morph(); page.marks.draw(); page.changed(); });
  at("named").addEventListener("change", () => page.marks.draw());
  at("named-choice").hidden = !page.landmarks.length && !page.data.work;
  document.querySelectorAll("[data-side]").forEach((button) =>
    button.addEventListener("click", () => from(rotated(LEVEL, ...SIDES[button.dataset.side]))));
  at("reset").addEventListener("click", () => from(FIRST));
  at("roll").addEventListener("click", () => both((camera) => rolled(camera, Math.PI / 2)));
  at("largest").addEventListener("click", () => goToWorst(page));
  at("go").addEventListener("submit", (event) => {
    event.preventDefault();
    goTo(page, Number(at("go-side").value), Number(at("go-vertex").value));
  });
  at("save-pins").addEventListener("click", () => offer(new Blob([pinsTable(page)], { type: "text/csv" }), "pairs.csv"));
  at("drop-pins").addEventListener("click", () => page.pin(null));
  at("save-view").addEventListener("click", async () => offer(await viewPicture(page), "view.png"));
  at("copy-link").addEventListener("click", async () => {
    remember(page);
    const copied = navigator.clipboard && await navigator.clipboard.writeText(location.href).then(() => true, () => false);
    at("copy-link").textContent = copied ? "Copied" : "It is the address of this page";
    setTimeout(() => { at("copy-link").textContent = "Copy link to this view"; }, 2000);
  });
  document.addEventListener("keydown", (event) => { if (event.key === "Escape" && !(page.work && page.work.escaped())) page.pin(null); });
  new ResizeObserver(() => { page.scenes.forEach((scene) => scene.resized()); page.marks.draw(); }).observe(at("stage"));
  addEventListener("resize", () => page.keepRoom());
  addEventListener("beforeprint", () => page.scenes.forEach((scene) => { scene.drawNow(); }));
}

function fail(message) {
  at("trouble").textContent = message;
  at("trouble").hidden = false;
  document.body.dataset.ready = "no";
}

async function start() {
  if (!("DecompressionStream" in window)) return fail("This page needs a newer browser: one from 2023 or later.");
  const page = new Page(await unpackedText(at("data").textContent));
  window.gmdsPage = page;
  choose(page);
  const first = fitted(page.scenes, FIRST);
  page.scenes.forEach((scene, panel) => { scene.camera = first; scene.shown = null; point(page, scene, panel); });
  if (location.hash.length > 1) restore(page, location.hash.slice(1));
  page.panels = at("beside").value === "" ? 2 : 3;
  showBeside(page);
  if (page.data.work) page.work = new Work(page);
  page.scenes.forEach((scene) => scene.drawNow());
  let writing = 0;
  page.changed = () => { clearTimeout(writing); writing = setTimeout(() => remember(page), 400); };
  document.body.dataset.ready = "yes";
}

start().catch((error) => fail(error.told || `The page could not be drawn: ${error.message}`));
