// The page: what is shown, what is pointed at, and the controls.
"use strict";

const at = (id) => document.getElementById(id);
const count = (n) => n.toLocaleString("en");
const figure = (x) => (Number.isFinite(x) ? x.toPrecision(3) : "unknown");

class Page {
  constructor(data) {
    this.data = data;
    this.scenes = data.surfaces.map((surface, side) => new Scene(at(`panel-${side}`), surface));
    this.pinned = null; // {side, vertex}: stays marked while the surfaces are turned
    this.pointed = null;
  }

  get map() {
    return this.data.maps[at("map").selectedIndex];
  }

  get mode() {
    const key = document.querySelector("input[name=mode]:checked").value;
    return this.data.modes.find((mode) => mode.key === key);
  }

  // colours of the ramp at shares (n,) of it; grey where there is no value
  ramp(share) {
    const { ramp, missing } = this.data;
    if (!Number.isFinite(share)) return missing;
    const step = 3 * Math.round(Math.min(Math.max(share, 0), 1) * (ramp.length / 3 - 1));
    return ramp.subarray(step, step + 3);
  }

  colours(side) {
    const { map, mode } = this;
    if (mode.key === "match") return side === 0 ? map.colours : this.covered(this.data.colours);
    const values = map.values[mode.key][side];
    const rgb = new Uint8Array(3 * values.length);
    values.forEach((value, i) => rgb.set(mode.swatches ? mode.swatches[value] : this.ramp(value / mode.high), 3 * i));
    return rgb;
  }

  covered(colours) {
    // those of the target, grey where it has no counterpart
    const rgb = Uint8Array.from(colours);
    this.map.values.valid[1].forEach((is, i) => is || rgb.set(this.data.missing, 3 * i));
    return rgb;
  }

  async show() {
    for (const input of document.querySelectorAll("input[name=mode]")) {
      const known = input.value === "match" || input.value in this.map.values;
      input.disabled = !known;
      input.parentElement.title = known ? "" : "Known for the best map only";
      if (!known && input.checked) document.querySelector("input[name=mode]").checked = true;
    }
    this.tell();
    const { map, mode } = this;
    at("help").textContent = mode.help;
    at("note").textContent = map.note;
    at("legend-ramp").hidden = !mode.high;
    at("legend-valid").hidden = !mode.swatches;
    if (mode.high) {
      at("low").textContent = "0";
      at("high").textContent = `${figure(mode.high)}${mode.beyond ? " and more" : ""}`;
    }
    await Promise.all([this.scenes[0].paint(this.colours(0)), this.scenes[1].paint(this.colours(1))]);
    await this.drawCharts();
    this.mark(this.pinned);
  }

  // the badge, the figures and the advice are those of the map that is shown
  tell() {
    const { told } = this.map;
    const made = (tag, text) => Object.assign(document.createElement(tag), { textContent: text });
    const both = (tag, first, second) => { const whole = document.createElement(tag); whole.append(first, second); return whole; };
    at("badge").className = `badge ${told.badge}`;
    at("badge").textContent = told.verdict;
    at("status").textContent = told.status;
    at("next").textContent = told.next;
    at("cards").replaceChildren(...told.cards.map(([value, name]) => both("li", made("b", value), made("span", name))));
    at("facts").replaceChildren(...told.facts.map(([name, value]) => both("tr", made("th", name), made("td", value))));
  }

  async drawCharts() {
    const { map, mode, data } = this;
    const counts = map.histograms[mode.key];
    at("histogram-part").hidden = !counts;
    at("curve-part").hidden = !map.curve;
    if (counts) {
      at("histogram-title").textContent = `How the ${mode.label.toLowerCase()} is spread`;
      await drawHistogram(at("histogram"), mode, counts, (share) => `rgb(${Array.from(this.ramp(share))})`);
    }
    const known = data.maps.filter((one) => one.curve);
    const curves = known.map((one) => ({ name: one.name, share: one.curve }));
    if (map.curve) await drawCurves(at("curve"), data.thresholds, curves, known.indexOf(map));
  }

  partner(side, vertex) {
    const images = side === 0 ? this.map.there : this.map.back;
    if (!images.found[vertex]) return null;
    return {
      face: images.face[vertex], vertex: images.vertex[vertex],
      weights: Array.from(images.weights.subarray(3 * vertex, 3 * vertex + 3), (w) => w / 65535),
      position: Array.from(images.position.subarray(3 * vertex, 3 * vertex + 3), (c) => c / 65535 - 0.5),
    };
  }

  // lights up a vertex and its partner; nothing when there is no such vertex
  mark(point) {
    this.pointed = point;
    at("marks").toggleAttribute("hidden", !point);
    const readout = at("readout");
    readout.setAttribute("aria-live", point && point === this.pinned ? "polite" : "off"); // hovering would chatter
    if (!point) {
      readout.textContent = "Point at either surface: its partner lights up on the other one. A click keeps the pair marked.";
      for (const key of Object.keys(readout.dataset)) delete readout.dataset[key];
      return;
    }
    const { side, vertex } = point;
    const partner = this.partner(side, vertex);
    const [here, there] = [this.data.surfaces[side], this.data.surfaces[1 - side]];
    this.placeMarks();
    const number = here.origin[vertex];
    const hidden = partner && this.scenes[1 - side].place(partner.position).hidden;
    const values = this.data.modes.filter((mode) => mode.high && this.map.values[mode.key])
      .map((mode) => ` ${mode.label}: ${figure(this.map.values[mode.key][side][vertex])}.`).join("");
    readout.textContent = `Vertex ${number} of ${here.name}` + (partner
      ? ` belongs to the point in face ${partner.face} of ${there.name}, nearest to its vertex ${partner.vertex}` +
        ` (weights ${partner.weights.map((w) => w.toFixed(3)).join(", ")}).${values}${hidden ? " It is on the far side: turn the surface." : ""}`
      : ` has no counterpart on ${there.name}.`);
    Object.assign(readout.dataset, { side, vertex: number, face: partner ? partner.face : "",
      weights: partner ? partner.weights.join(" ") : "" });
  }

  placeMarks() {
    if (!this.pointed) return;
    const { side, vertex } = this.pointed;
    const partner = this.partner(side, vertex);
    const stage = at("stage").getBoundingClientRect();
    const ends = this.scenes.map((scene, i) => {
      const point = i === side ? scene.vertex(vertex) : partner && partner.position;
      const dot = at(`mark-${i}`);
      dot.style.display = point ? "" : "none";
      if (!point) return null;
      const place = scene.place(point);
      const box = scene.plot.getBoundingClientRect();
      const [x, y] = [box.left - stage.left + place.x, box.top - stage.top + place.y];
      dot.setAttribute("transform", `translate(${x} ${y})`);
      dot.classList.toggle("hidden", place.hidden);
      dot.classList.toggle("partner", i !== side);
      return [x, y];
    });
    const line = at("mark-line");
    line.style.display = ends[0] && ends[1] ? "" : "none";
    if (ends[0] && ends[1]) line.setAttribute("d", `M${ends[0].join(" ")} L${ends[1].join(" ")}`);
  }

  pin(point) {
    this.pinned = point;
    this.mark(point);
  }

  // marks a vertex by its number in the file, for whoever has no pointer
  goTo(side, number) {
    const vertex = this.data.surfaces[side].origin.indexOf(number);
    if (vertex >= 0) this.pin({ side, vertex });
    else at("readout").textContent = `Vertex ${number} is not among the points that are drawn of ${this.data.surfaces[side].name}.`;
  }

  goToLargest() {
    const values = this.map.values[this.mode.key][0];
    const found = this.map.there.found;
    let most = -1;
    values.forEach((value, i) => { if (found[i] && Number.isFinite(value) && !(value <= values[most])) most = i; });
    if (most < 0) return;
    this.pin({ side: 0, vertex: most });
    const scene = this.scenes[0];
    const steps = Array.from({ length: 12 }, (_, i) => rotated(scene.camera, (i * Math.PI) / 6, 0));
    const clear = steps.find((camera) => { // the first side from which it can be seen
      const probe = new Scene(scene.panel, scene.surface);
      probe.camera = camera;
      return !probe.place(scene.vertex(most)).hidden;
    });
    if (clear) scene.look(clear);
  }
}
