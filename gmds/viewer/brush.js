// Marking a region of the source as wrong: a brush that follows the surface.
"use strict";

const WRONG = [201, 28, 122];

class Brush {
  constructor(surface, marked) {
    const place = new Map(Array.from(surface.origin, (number, i) => [number, i]));
    this.surface = surface;
    this.marked = new Set(marked.map((number) => place.get(number)).filter((i) => i !== undefined));
  }

  // vertices of the source, by their numbers in its file
  get numbers() {
    return [...this.marked].map((i) => this.surface.origin[i]);
  }

  get neighbours() {
    if (this.around) return this.around;
    const { faces, vertices } = this.surface;
    this.around = Array.from({ length: vertices.length / 3 }, () => []);
    for (let f = 0; f < faces.length; f += 3) {
      for (let k = 0; k < 3; k++) this.around[faces[f + k]].push(faces[f + ((k + 1) % 3)], faces[f + ((k + 2) % 3)]);
    }
    return this.around;
  }

  // all that is joined to a vertex within the radius about it
  paint(vertex, radius, erase) {
    const { vertices } = this.surface;
    const far = (i) => Math.hypot(...[0, 1, 2].map((k) => vertices[3 * i + k] - vertices[3 * vertex + k]));
    const seen = new Set([vertex]);
    const ahead = [vertex];
    while (ahead.length) {
      const i = ahead.pop();
      if (erase) this.marked.delete(i);
      else this.marked.add(i);
      for (const j of this.neighbours[i]) if (!seen.has(j) && far(j) <= radius) { seen.add(j); ahead.push(j); }
    }
  }

  over(rgb) {
    if (!this.marked.size) return rgb;
    const mixed = Uint8Array.from(rgb);
    for (const i of this.marked) WRONG.forEach((c, k) => { mixed[3 * i + k] = 0.25 * mixed[3 * i + k] + 0.75 * c; });
    return mixed;
  }
}
