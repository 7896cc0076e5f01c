// What stands about the surfaces: badge, figures and advice of the map that is shown, its scale, its charts.
"use strict";

class Telling {
  // the colours that are known for this map; those that were chosen come back with the next map that has them
  offerModes() {
    const inputs = [...document.querySelectorAll("input[name=mode]")];
    const chosen = this.wanted || this.mode.key;
    for (const input of inputs) {
      input.disabled = input.value !== "match" && !(input.value in this.map.values);
      input.parentElement.title = input.disabled ? "Not known for this map" : "";
    }
    const wanted = inputs.find((input) => input.value === chosen);
    (wanted.disabled ? inputs[0] : wanted).checked = true;
    this.wanted = wanted.disabled ? chosen : null;
  }

  legend() {
    const { map, mode } = this;
    at("help").textContent = mode.help;
    at("note").textContent = map.note;
    at("legend-ramp").hidden = !mode.high;
    at("legend-valid").hidden = !mode.swatches;
    at("legend-match").hidden = mode.key !== "match";
    at("fit-choice").style.visibility = mode.high && mode.key in map.tops ? "" : "hidden";
    at("fine-choice").hidden = !mode.fine;
    at("fine").disabled = at("fit").checked;
    at("largest").textContent = mode.reversed ? "Lowest" : "Largest";
    at("largest").style.visibility = mode.high ? "" : "hidden";
    if (!mode.high) return;
    const top = this.top(mode);
    at("legend-label").replaceChildren(mode.unit, about(mode.help));
    at("low").textContent = mode.signed ? figureShort(-top) : "0";
    at("high").textContent = `${figureShort(top)}${map.largest[mode.key] > top * 1.0001 ? " and more" : ""}`;
    at("ramp").classList.toggle("reversed", Boolean(mode.reversed));
    at("ramp").classList.toggle("signed", Boolean(mode.signed));
  }

  // the badge, the figures and the advice are those of the map that is shown
  tell({ told } = this.map) {
    at("badge").className = `badge ${told.badge}`;
    at("badge").textContent = told.verdict;
    at("status").textContent = told.status;
    at("next").textContent = told.next;
    at("cards").replaceChildren(...told.cards.map(([value, name, word]) =>
      made("li", made("b", value), made("span", name, ...(word ? [about(this.data.words[word])] : [])))));
    at("facts").replaceChildren(...told.facts.map(([name, value]) => made("tr", made("th", name), made("td", value))));
  }

  // where the map beside it has the partner, which is the ring of the other colour
  toldBeside({ side, vertex }) {
    if (!this.beside) return "";
    const partner = this.partner(side, vertex, this.beside);
    const [here, there] = side === 0 ? ["goes to", "the other ring"] : ["comes from", "the ring in the middle"];
    return ` With ${this.beside.name} it ${partner ? `${here} nearest vertex ${partner.vertex} (${there})` : "has no counterpart"}.`;
  }

  // as much room for these words as any map needs, so that nothing jumps when another is shown
  keepRoom() {
    const header = document.querySelector("header");
    header.style.minHeight = "";
    const heights = this.data.maps.map((map) => { this.tell(map); return header.offsetHeight; });
    header.style.minHeight = `${Math.max(...heights)}px`;
    this.tell();
  }

  drawCharts() {
    const { map, mode, data } = this;
    const spread = map.histograms[mode.key];
    at("histogram-part").hidden = !spread;
    at("curve-part").hidden = !map.curve;
    if (spread) {
      const high = this.top(mode);
      at("histogram-title").textContent = `How the ${mode.label.toLowerCase()} is spread`;
      drawHistogram(at("histogram"), { ...mode, high, counts: spread[at("fit").checked ? 1 : high === mode.high ? 0 : 2] }, (share) => `rgb(${Array.from(this.ramp(share * high, mode))})`);
    }
    const known = data.maps.filter((one) => one.curve);
    const curves = known.map((one) => ({ name: one.name, share: one.curve }));
    if (map.curve) drawCurves(at("curve"), data.thresholds, curves, known.indexOf(map));
  }
}
