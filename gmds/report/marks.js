// What lies over the surfaces: rings about a pair, pins, names of landmarks, axes and a scale.
"use strict";

const SETTLED = 120; // ms after the last turn until what is hidden is asked anew
const AXES = ["x", "y", "z"];
const AWAY = 9, HALO = 3; // pixels: from a point to its name, and about that

// a name stands on the outer side of its point, unless the panel ends there
function beside([left, right], wide) {
  const leftwards = left < right ? left > wide : right < wide && left > wide;
  return leftwards ? { x: -AWAY, "text-anchor": "end" } : { x: AWAY };
}

class Marks {
  constructor(page) {
    this.page = page;
    this.hidden = new Map(); // what was hidden when that was last asked
  }

  // where a point of a panel is over the stage
  place(side, position, key) {
    const scene = this.page.scenes[side];
    const box = scene.plot.getBoundingClientRect();
    const stage = at("stage").getBoundingClientRect();
    const moving = key && performance.now() < this.movedAt + SETTLED && this.hidden.has(key);
    const [x, y] = project(scene.lens, position);
    const hidden = moving ? this.hidden.get(key) : scene.place(position).hidden;
    if (key) this.hidden.set(key, hidden);
    const inside = x >= 0 && y >= 0 && x <= box.width && y <= box.height;
    return { x: box.left - stage.left + x, y: box.top - stage.top + y, hidden, inside, room: [x, box.width - x] };
  }

  moved() {
    this.movedAt = performance.now();
    clearTimeout(this.later);
    this.later = setTimeout(() => this.draw(), SETTLED + 10);
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.waiting = 0;
    this.rings();
    this.pins();
    this.labels();
    this.triads();
  }

  rings() {
    const { page } = this;
    at("pointed").toggleAttribute("hidden", !page.pointed);
    if (!page.pointed) return;
    const { side, vertex } = page.pointed;
    const partner = page.partner(side, vertex);
    const ends = [];
    const ring = (id, panel, position, kind) => {
      const dot = at(id);
      dot.style.display = position && page.scenes[panel] ? "" : "none";
      if (dot.style.display) return;
      const place = this.place(panel, position);
      if (!place.inside) dot.style.display = "none";
      dot.setAttribute("transform", `translate(${place.x} ${place.y})`);
      dot.classList.toggle("hidden", place.hidden);
      dot.classList.toggle("partner", kind === "partner");
      if (panel < 2) ends[panel] = ends[panel] || place;
    };
    ring("mark-0", 0, side === 0 ? page.scenes[0].vertex(vertex) : partner && partner.position, side === 0 ? "" : "partner");
    ring("mark-1", 1, side === 1 ? page.scenes[1].vertex(vertex) : partner && partner.position, side === 1 ? "" : "partner");
    const beside = page.beside;
    const other = beside && page.partner(side, vertex, beside);
    ring("mark-2", 2, beside && (side === 0 ? page.scenes[2].vertex(vertex) : other && other.position), side === 0 ? "" : "partner");
    ring("mark-3", 1, side === 0 && other && other.position, "other");
    const line = at("mark-line");
    line.style.display = ends[0] && ends[1] ? "" : "none";
    if (ends[0] && ends[1]) line.setAttribute("d", `M${ends[0].x} ${ends[0].y} L${ends[1].x} ${ends[1].y}`);
  }

  pins() {
    const { page } = this;
    at("pins").replaceChildren(...page.pins.flatMap((pin, i) => {
      const partner = page.partner(pin.side, pin.vertex);
      const ends = [[pin.side, page.scenes[pin.side].vertex(pin.vertex)], [1 - pin.side, partner && partner.position]];
      return ends.filter(([, position]) => position).map(([side, position]) => {
        const place = this.place(side, position, `pin ${i} ${side} ${pin.vertex}`);
      if (!place.inside) return "";
        return svg("g", { class: `pin${place.hidden ? " hidden" : ""}`, transform: `translate(${place.x} ${place.y})` },
          svg("circle", { r: 9 }), svg("text", { y: 4, "text-anchor": "middle" }, String(i + 1)));
      });
    }));
  }

  // pixels from a point to the end of its name
  wide(name) {
    this.pen = this.pen || document.createElement("canvas").getContext("2d");
    const { fontSize, fontFamily } = getComputedStyle(at("labels"));
    this.pen.font = `${fontSize} ${fontFamily}`;
    return AWAY + this.pen.measureText(name).width + HALO;
  }

  labels() {
    const { page } = this;
    const shown = at("named").checked && !Number(at("morph").value) ? page.landmarks : [];
    at("labels").replaceChildren(...shown.flatMap((mark, i) => [0, 1].filter((side) => mark.at[side]).map((side) => {
      const place = this.place(side, mark.at[side], `mark ${side} ${mark.at[side]}`);
      if (!place.inside) return "";
      const kind = `label${place.hidden ? " hidden" : ""}${mark.at[1 - side] ? "" : " alone"}${i === page.chosenLandmark ? " chosen" : ""}`;
      return svg("g", { class: kind, transform: `translate(${place.x} ${place.y})`, "data-landmark": i, "data-panel": side },
        svg("path", { d: "M0 -6 L6 0 L0 6 L-6 0 Z" }), svg("text", { ...beside(place.room, this.wide(mark.name)), y: 4 }, mark.name));
    })));
  }

  // the axes of each mesh in a corner, and a length in its units
  triads() {
    const { page } = this;
    at("triads").replaceChildren(...page.scenes.map((scene, side) => {
      const box = scene.plot.getBoundingClientRect();
      const stage = at("stage").getBoundingClientRect();
      const [left, bottom] = [box.left - stage.left, box.bottom - stage.top];
      const view = scene.lens;
      const { axes, unit: size } = scene.surface;
      const arrows = AXES.flatMap((name, k) => {
        const way = [axes[k], axes[3 + k], axes[6 + k]];
        const [x, y] = [24 * dot(way, view.right), -24 * dot(way, view.up)];
        return [svg("line", { x2: x, y2: y, class: `axis ${name}` }), svg("text", { x: 1.3 * x, y: 1.3 * y + 4, "text-anchor": "middle" }, name)];
      });
      const away = minus(xyz(scene.camera.eye), xyz(scene.camera.center));
      const pixels = view.focal / Math.sqrt(dot(away, away)) / size; // of one unit of the mesh, in the middle
      const length = ticks(150 / pixels).filter((v) => v * pixels > 25)[0] || 0;
      const ruler = svg("g", { transform: `translate(${box.width - length * pixels - 16} -16)` },
        svg("path", { d: `M0 -5 V0 H${length * pixels} V-5`, class: "ruler" }), svg("text", { x: (length * pixels) / 2, y: -6, "text-anchor": "middle" }, figureShort(length)));
      return svg("g", { class: "triad", transform: `translate(${left} ${bottom})` }, svg("g", { transform: "translate(38 -38)" }, ...arrows), ruler);
    }));
  }
}
