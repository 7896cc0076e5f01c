// What a page to work in asks of its server: to keep what was placed, to match again, for maps and files.
"use strict";

const POLL = 400; // ms between two looks at the progress

class Asking {
  // maps that were made before this page was opened once more, and what is being made
  async catchUp() {
    for (let number = 1; number < this.page.data.work.maps; number++) await this.fetchMap(number, false);
    const { job } = await askJson("/state");
    if (job && job.running) this.follow();
  }

  // the server knows what was placed: one message after the other, the last one always
  keep() {
    const { landmarks } = this.page;
    const given = { landmarks: landmarks.map(({ name, at: places }) => ({ name, at: places })), wrong: this.brush.numbers };
    this.sending = (this.sending || Promise.resolve()).then(() => askJson("/work", given)).catch((error) => this.tell(error.message, true));
    return this.sending;
  }

  tell(text, bad = false) {
    at("work-told").textContent = text;
    at("work-told").classList.toggle("bad", bad);
  }

  async again() {
    const { page } = this;
    const complete = page.landmarks.filter((mark) => mark.at[0] && mark.at[1]).length;
    if (!complete && !this.brush.marked.size) return this.tell("Place landmarks on both surfaces first, or mark what is wrong.", true);
    at("again").disabled = true;
    try {
      await this.keep();
      await askJson("/match", { from: this.origins[Math.max(at("map").selectedIndex, 0)][0], tolerance: Number(at("tolerance").value) });
      this.follow();
    } catch (error) {
      at("again").disabled = false;
      this.tell(error.message, true);
    }
  }

  async follow() {
    at("again").disabled = true;
    for (const id of ["progress", "stop"]) at(id).hidden = false;
    try {
      for (;;) {
        const { job } = await askJson("/state");
        at("progress").value = job.fraction;
        this.tell(`${job.stage}, ${Math.round(100 * job.fraction)} %`);
        if (!job.running) {
          if (job.error) this.tell(job.error, job.error !== "stopped");
          else await this.fetchMap(job.map, true);
          break;
        }
        await new Promise((done) => setTimeout(done, POLL));
      }
    } catch (error) {
      this.tell(error.message, true);
    }
    at("again").disabled = false;
    for (const id of ["progress", "stop"]) at(id).hidden = true;
  }

  // a map that the server has made, with its candidates, beside those that were there
  async fetchMap(number, show) {
    const { page } = this;
    const maps = await unpackedText(await (await ask(`/map?number=${number}`)).text());
    const first = page.data.maps.length;
    page.data.maps.push(...maps);
    this.origins.push(...maps.map((_, i) => [number, i]));
    listMaps(page);
    if (!show) return;
    const before = at("map").selectedIndex;
    at("map").selectedIndex = first;
    at("beside").value = String(before);
    showBeside(page);
    this.unsaved = true;
    this.tell(`${maps[0].name} is shown, with the map before it beside it. ${maps[0].note}`);
  }

  async save() {
    const [kind, side] = at("save-kind").value.split(" ");
    const [map, candidate] = this.origins[Math.max(at("map").selectedIndex, 0)];
    try {
      await this.keep();
      await fetchFile(kind === "map" ? { kind, map, candidate } : { kind, side: Number(side) });
      this.unsaved = false;
      this.tell("Saved.");
    } catch (error) {
      this.tell(error.message, true);
    }
  }
}
