// The page: which map and colours are shown, and what is pointed at.
"use strict";

const at = (id) => document.getElementById(id);
const figure = (x) => (Number.isFinite(x) ? x.toPrecision(3) : "unknown");
const figureShort = (x) => String(Number(x.toPrecision(3)));
const made = (tag, ...children) => { const whole = document.createElement(tag); whole.append(...children); return whole; };
const about = (meaning) => {
  const mark = Object.assign(made("abbr"), { className: "about", title: meaning, tabIndex: 0 });
  mark.setAttribute("aria-label", meaning);
  return mark;
};
const MOST_PINS = 20;
const SQUARES = 14; // from one end of the target to the other

class Page extends Telling {
  constructor(data) {
    super();
    this.data = data;
    this.surfaces = [data.surfaces[0], data.surfaces[1], data.surfaces[0]];
    this.scenes = [0, 1].map((side) => new Scene(at(`panel-${side}`), this.surfaces[side]));
    this.marks = new Marks(this);
    this.pins = []; // {side, vertex}: stay marked while the surfaces are turned
    this.pointed = null;
    this.chosenLandmark = -1;
    this.landmarks = data.landmarks; // {name, at: [position on the source or null, on the target or null]}
    this.scenes[1].give("place", data.surfaces[1].vertices);
  }

  get map() {
    return this.data.maps[Math.max(at("map").selectedIndex, 0)];
  }

  get beside() {
    return this.scenes[2] ? this.data.maps[Number(at("beside").value)] : null;
  }

  get mode() {
    const key = document.querySelector("input[name=mode]:checked").value;
    return this.data.modes.find((mode) => mode.key === key);
  }

  // where the scale of a way of colouring ends, for a map
  top(mode, map = this.map) {
    if (at("fit").checked && map.tops[mode.key]) return map.tops[mode.key];
    return at("fine").checked && mode.fine ? mode.fine : mode.high;
  }

  // the colour of a value; grey where there is none
  ramp(value, mode) {
    const { missing } = this.data;
    const ramp = mode.signed ? this.data.signedRamp : this.data.ramp;
    if (!Number.isFinite(value)) return missing;
    const part = value / this.top(mode);
    const share = Math.min(Math.max(mode.signed ? (1 + part) / 2 : part, 0), 1);
    const step = 3 * Math.round((mode.reversed ? 1 - share : share) * (ramp.length / 3 - 1));
    return ramp.subarray(step, step + 3);
  }

  colours(side, map = this.map) {
    const { mode } = this;
    if (mode.key === "match") return side === 0 ? map.colours : this.covered(this.data.colours, map);
    const values = map.values[mode.key];
    if (!values || this.dots(map)) return Uint8Array.from({ length: this.surfaces[side].vertices.length }, (_, i) => this.data.missing[i % 3]);
    const rgb = new Uint8Array(3 * values[side].length);
    values[side].forEach((value, i) => rgb.set(mode.swatches ? mode.swatches[value] : this.ramp(value, mode), 3 * i));
    return rgb;
  }

  covered(colours, map) {
    // those of the target, grey where it has no counterpart
    const rgb = Uint8Array.from(colours);
    map.values.valid[1].forEach((is, i) => is || rgb.set(this.data.missing, 3 * i));
    return rgb;
  }

  show() {
    this.offerModes();
    this.tell();
    this.legend();
    this.paint();
    this.drawCharts();
    this.mark(this.pointed);
    this.listPins();
  }

  paint() {
    this.scenes[0].paint(this.colours(0));
    this.scenes[1].paint(this.colours(1));
    [this.map, , this.beside].forEach((map, side) => {
      const scene = this.scenes[side];
      if (!scene || !map) return;
      if (side === 2) scene.paint(this.colours(0, map));
      scene.give("place", this.images(map));
      const dots = this.dots(map) || { position: [], error: [] };
      scene.give("dot", Float32Array.from(dots.position));
      scene.give("dotColour", Uint8Array.from(Array.from(dots.error, (e) => Array.from(this.ramp(e, this.mode))).flat()));
    });
    this.morph();
  }

  // the few points whose truth is known, where their errors are shown: there alone is a colour
  dots(map) {
    return this.mode.key === "error" && map.dots;
  }

  // where the vertices of the source go, as the target is drawn
  images(map) {
    map.images = map.images || Float32Array.from(map.there.position, (c) => c / 65535 - 0.5);
    return map.images;
  }

  morph() {
    const share = Number(at("morph").value);
    const scene = this.scenes[0];
    const own = this.surfaces[0].vertices;
    const goal = this.images(this.map);
    if (share || scene.positions !== own) scene.placeAt(share ? own.map((c, i) => (1 - share) * c + share * goal[i]) : own);
  }

  partner(side, vertex, map = this.map) {
    const images = side === 0 ? map.there : map.back;
    if (!images.found[vertex]) return null;
    return {
      face: images.face[vertex], vertex: images.vertex[vertex],
      weights: Array.from(images.weights.subarray(3 * vertex, 3 * vertex + 3), (w) => w / 65535),
      position: Array.from(images.position.subarray(3 * vertex, 3 * vertex + 3), (c) => c / 65535 - 0.5),
    };
  }

  // what is known of a vertex and its partner, in words
  told({ side, vertex }) {
    const partner = this.partner(side, vertex);
    const [here, there] = [this.data.surfaces[side], this.data.surfaces[1 - side]];
    const number = here.origin[vertex];
    if (!partner) return `Vertex ${number} of ${here.name} has no counterpart on ${there.name}.`;
    const hidden = this.scenes[1 - side].place(partner.position).hidden;
    const values = this.data.modes.filter((mode) => mode.high && this.map.values[mode.key])
      .map((mode) => ` ${mode.label}${mode.key === "error" && this.map.dots ? " at the nearest known point" : ""} ${figure(this.map.values[mode.key][side][vertex])}.`).join("");
    return `Vertex ${number} of ${here.name} goes to face ${partner.face} of ${there.name}, nearest vertex ${partner.vertex}, ` +
      `weights ${partner.weights.map((w) => w.toFixed(3)).join(", ")}.${values}${hidden ? " It is on the far side (dashed)." : ""}`;
  }

  // lights up a vertex and its partner; nothing when there is no such vertex
  mark(point) {
    this.pointed = point;
    const readout = at("readout");
    this.marks.draw();
    if (!point) {
      readout.textContent = this.idle || "Point at either surface: its partner lights up on the other one. A click keeps the pair marked.";
      for (const key of Object.keys(readout.dataset)) delete readout.dataset[key];
      return;
    }
    const { side, vertex } = point;
    const partner = this.partner(side, vertex);
    readout.setAttribute("aria-live", point.kept ? "polite" : "off"); // hovering would chatter
    readout.textContent = this.told(point) + this.toldBeside(point);
    Object.assign(readout.dataset, { side, vertex: this.data.surfaces[side].origin[vertex], face: partner ? partner.face : "",
      weights: partner ? partner.weights.join(" ") : "" });
  }

  pin(point) {
    if (!point) this.pins = [];
    else if (!this.pins.some((one) => one.side === point.side && one.vertex === point.vertex)) {
      this.pins = [...this.pins.slice(-MOST_PINS + 1), { side: point.side, vertex: point.vertex }];
    }
    this.mark(point && { ...point, kept: true });
    this.listPins();
  }

  listPins() {
    at("pin-part").hidden = !this.pins.length;
    at("pin-table").replaceChildren(...this.pins.map((pin, i) => {
      const drop = made("button", "×");
      drop.type = "button";
      drop.setAttribute("aria-label", `Let go of pair ${i + 1}`);
      drop.addEventListener("click", () => { this.pins = this.pins.filter((one) => one !== pin); this.mark(null); this.listPins(); });
      return made("tr", made("th", String(i + 1)), made("td", this.told(pin)), made("td", drop));
    }));
    this.changed();
  }

  changed() {}
}
