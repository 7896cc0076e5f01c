// Working on a map: landmarks placed and moved, and a region marked as wrong.
"use strict";

const KEPT = 100; // steps that can be undone
const MISSING_SIDE = ["not yet on the source", "not yet on the target"];

class Work extends Asking {
  constructor(page) {
    super();
    this.page = page;
    this.steps = [];
    this.tool = "";
    page.landmarks = page.data.work.landmarks.map(({ name, at: places }) => ({ name, at: places }));
    page.chosenLandmark = -1;
    this.brush = new Brush(page.surfaces[0], page.data.work.wrong);
    this.origins = page.data.maps.map((_, i) => [0, i]); // of every map in the list: which match it is of, which candidate
    const colours = page.colours.bind(page);
    page.colours = (side, map) => (side === 0 ? this.brush.over(colours(side, map)) : colours(side, map));
    this.listen();
    this.list();
    page.paint();
    this.catchUp().catch((error) => this.tell(error.message, true));
  }

  listen() {
    const { page } = this;
    const on = (id, kind, act) => at(id).addEventListener(kind, act);
    for (const tool of ["place", "wrong"]) on(`tool-${tool}`, "click", () => this.take(this.tool === tool ? "" : tool));
    on("undo", "click", () => this.undo());
    on("wrong-none", "click", () => this.change(() => this.brush.marked.clear()));
    on("again", "click", () => this.again());
    on("stop", "click", () => askJson("/stop", {}).catch((error) => this.tell(error.message, true)));
    on("save", "click", () => this.save());
    addEventListener("beforeunload", (event) => { if (this.unsaved) event.preventDefault(); });
    page.scenes.slice(0, 2).forEach((scene, side) => { scene.tool = (kind, event) => this.brushed(side, scene, kind, event); });
    on("marks", "pointerdown", (event) => this.grab(event));
  }

  take(tool) {
    this.tool = tool;
    for (const one of ["place", "wrong"]) at(`tool-${one}`).setAttribute("aria-pressed", String(tool === one));
    document.body.classList.toggle("placing", tool === "place");
    document.body.classList.toggle("marking", tool === "wrong");
    at("brush-choice").hidden = tool !== "wrong";
    this.page.chosenLandmark = -1;
    if (tool) { at("morph").value = 0; this.page.morph(); }
    this.page.idle = { place: "Click or tap a point on one surface, then the same point on the other. Drag a diamond to move it. Drag beside it turns, as ever.",
      wrong: "Paint over what is wrong on the source. With Alt the paint is taken away." }[tool];
    this.list();
    this.page.mark(null);
  }

  get chosen() {
    return this.page.landmarks[this.page.chosenLandmark];
  }

  // what is placed may be taken back
  change(act) {
    this.steps = [...this.steps.slice(-KEPT + 1), this.snapshot()];
    act();
    this.changed();
  }

  snapshot() {
    return JSON.stringify([this.page.landmarks, [...this.brush.marked], this.page.chosenLandmark]);
  }

  undo() {
    const last = this.steps.pop();
    if (!last) return;
    const [landmarks, marked, chosen] = JSON.parse(last);
    this.page.landmarks = landmarks;
    this.page.chosenLandmark = chosen;
    this.brush.marked = new Set(marked);
    this.changed();
  }

  changed() {
    this.unsaved = true;
    at("undo").disabled = !this.steps.length;
    this.list();
    this.page.paint();
    this.page.marks.draw();
    this.keep();
  }

  freeName() {
    const taken = new Set(this.page.landmarks.map((one) => one.name));
    let i = this.page.landmarks.length + 1;
    while (taken.has(String(i))) i++;
    return String(i);
  }

  // a click on a surface places a landmark there, the half that is missing first
  clicked(found) {
    if (this.tool === "wrong") return true;
    if (this.tool !== "place" || !found) return false;
    const { side, hit } = found;
    this.change(() => {
      const { page } = this;
      if (!this.chosen || (this.chosen.at[0] && this.chosen.at[1])) {
        page.chosenLandmark = page.landmarks.length;
        page.landmarks = [...page.landmarks, { name: this.freeName(), at: [null, null] }];
      }
      this.chosen.at[side] = hit.position;
    });
    return true;
  }

  // Escape takes the tool away first; only without one it lets pins go
  escaped() {
    const had = this.tool !== "";
    if (had) this.take("");
    return had;
  }

  // a diamond follows the pointer along its surface
  grab(event) {
    const label = event.target.closest(".label");
    if (!label) return;
    event.preventDefault();
    const [i, side] = [Number(label.dataset.landmark), Number(label.dataset.panel)];
    const { page } = this;
    const scene = page.scenes[side];
    const before = this.snapshot();
    let moved = false;
    const follow = (now) => {
      const found = scene.under(now);
      if (!found) return;
      moved = true;
      page.landmarks[i].at[side] = found.hit.position;
      page.marks.draw();
    };
    const drop = () => {
      removeEventListener("pointermove", follow);
      removeEventListener("pointerup", drop);
      page.chosenLandmark = i;
      if (moved) this.steps.push(before);
      if (moved) this.changed();
      else this.list();
    };
    addEventListener("pointermove", follow);
    addEventListener("pointerup", drop);
  }

  // a stroke of the brush; true where the surface is not to turn
  brushed(side, scene, kind, event) {
    if (this.tool !== "wrong" || side !== 0) return false;
    if (kind === "down" && !scene.under(event)) return false;
    if (kind === "down") this.stroke = this.snapshot();
    if (!this.stroke) return false;
    if (kind === "up") {
      this.steps.push(this.stroke);
      this.stroke = null;
      this.changed();
      return true;
    }
    const found = scene.under(event);
    if (found) this.brush.paint(found.vertex, Number(at("brush").value), event.altKey);
    scene.paint(this.page.colours(0));
    return true;
  }

  list() {
    const { page } = this;
    at("landmark-list").replaceChildren(...page.landmarks.map((mark, i) => {
      const name = Object.assign(document.createElement("input"), { type: "text", value: mark.name, maxLength: 100 });
      name.setAttribute("aria-label", `Name of landmark ${i + 1}`);
      name.addEventListener("change", () => this.change(() => { mark.name = name.value.trim() || this.freeName(); }));
      name.addEventListener("focus", () => { page.chosenLandmark = i; page.marks.draw(); });
      const drop = made("button", "×");
      drop.type = "button";
      drop.setAttribute("aria-label", `Delete landmark ${mark.name}`);
      drop.addEventListener("click", () => this.change(() => { page.landmarks = page.landmarks.filter((one) => one !== mark); page.chosenLandmark = -1; }));
      const lacking = mark.at.findIndex((place) => !place);
      const item = made("li", name, ...(lacking < 0 ? [] : [made("small", MISSING_SIDE[lacking])]), drop);
      item.classList.toggle("chosen", i === page.chosenLandmark);
      return item;
    }));
    const list = at("landmark-list"), row = list.children[page.chosenLandmark];
    if (row) list.scrollTop = row.offsetTop - list.offsetTop; // the list is low, and the page stays where it is
    page.marks.draw();
  }
}
