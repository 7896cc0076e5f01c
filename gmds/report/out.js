// What leaves the page: pairs as a table, the view as a picture, and all that is chosen as a link.
"use strict";

function offer(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function pinsTable(page) {
  const keys = page.data.modes.filter((mode) => mode.high && page.map.values[mode.key]);
  const head = ["pair", "given_on", "source_vertex", "target_face", "target_w0", "target_w1", "target_w2", "target_vertex", ...keys.map((mode) => mode.key)];
  const rows = page.pins.map(({ side, vertex }, i) => {
    const partner = page.partner(side, vertex);
    const number = page.surfaces[side].origin[vertex];
    const values = keys.map((mode) => page.map.values[mode.key][side][vertex]);
    const weights = partner ? partner.weights.map((w) => w.toFixed(5)) : ["", "", ""];
    const there = side === 0 ? [number, partner ? partner.face : "", ...weights, partner ? partner.vertex : ""]
      : [partner ? partner.vertex : "", "", "", "", "", number];
    return [i + 1, side === 0 ? "source" : "target", ...there, ...values.map((v) => (Number.isFinite(v) ? v : ""))];
  });
  return [head, ...rows].map((row) => row.join(",")).join("\n") + "\n";
}

// a mark over the surfaces as it is styled, with all that is in it
function drawMark(pen, mark) {
  const style = getComputedStyle(mark);
  const number = (name) => Number(mark.getAttribute(name) || 0);
  const moved = /translate\((\S+) (\S+)\)/.exec(mark.getAttribute("transform") || "");
  const path = new Path2D(mark.getAttribute("d") || "");
  pen.save();
  if (moved) pen.translate(Number(moved[1]), Number(moved[2]));
  pen.globalAlpha *= Number(style.opacity);
  [pen.fillStyle, pen.strokeStyle, pen.lineWidth] = [style.fill, style.stroke, parseFloat(style.strokeWidth)];
  pen.setLineDash(style.strokeDasharray === "none" ? [] : style.strokeDasharray.split(",").map(parseFloat));
  pen.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  pen.textAlign = { start: "left", middle: "center", end: "right" }[style.textAnchor];
  if (mark.tagName === "circle") path.arc(0, 0, number("r"), 0, 2 * Math.PI);
  if (mark.tagName === "line") { path.moveTo(0, 0); path.lineTo(number("x2"), number("y2")); }
  const [filled, drawn] = [style.fill !== "none", style.stroke !== "none"];
  if (mark.tagName === "text") {
    if (drawn) pen.strokeText(mark.textContent, number("x"), number("y"));
    if (filled) pen.fillText(mark.textContent, number("x"), number("y"));
  } else if (mark.tagName !== "g") {
    if (filled) pen.fill(path);
    if (drawn) pen.stroke(path);
  }
  for (const part of mark.children) drawMark(pen, part);
  pen.restore();
}

// pins, names, axes and scale over a panel that begins at `left`
function drawMarks(pen, scene, left) {
  const [box, stage] = [scene.plot.getBoundingClientRect(), at("stage").getBoundingClientRect()];
  const { width, height } = scene.canvas;
  pen.save();
  pen.beginPath();
  pen.rect(left, 0, width, height);
  pen.clip();
  pen.translate(left, 0);
  pen.scale(width / box.width, height / box.height);
  pen.translate(stage.left - box.left, stage.top - box.top);
  for (const mark of document.querySelectorAll("#triads > g, #pins > g, #labels > g")) drawMark(pen, mark);
  pen.restore();
}

const HEAD = 26, BAR = [140, 10]; // pixels of the page: a line of words, the bar of a scale

// above each surface its name and the map that colours it, below all what the colours stand for
function drawWords(pen, page, scenes, scale) {
  const style = getComputedStyle(document.body);
  const bottom = pen.canvas.height / scale - HEAD / 2;
  pen.save();
  pen.scale(scale, scale);
  [pen.fillStyle, pen.textBaseline, pen.font] = [style.color, "middle", `14px ${style.fontFamily}`];
  let left = 0;
  scenes.forEach((scene) => {
    const panel = page.scenes.indexOf(scene);
    const maps = page.data.maps.length > 1 ? [`, ${page.map.name}`, "", `, ${page.beside ? page.beside.name : ""}`] : ["", "", ""];
    pen.fillText(page.surfaces[panel].name + maps[panel], left + 8, HEAD / 2, scene.canvas.width / scale - 16);
    left += scene.canvas.width / scale;
  });
  drawScale(pen, page, bottom);
  pen.restore();
}

function drawScale(pen, page, middle) {
  let left = 8;
  const word = (text, color = pen.fillStyle) => {
    const kept = pen.fillStyle;
    pen.fillStyle = color;
    pen.fillText(text, left, middle);
    left += pen.measureText(text).width + 6;
    pen.fillStyle = kept;
  };
  const { mode } = page;
  if (mode.key === "match") return word(at("legend-match").firstChild.textContent.trim());
  if (!mode.high) {
    for (const one of at("legend-valid").childNodes) {
      if (one.nodeType === Node.TEXT_NODE) word(one.textContent.trim());
      else word("\u25a0", getComputedStyle(one).backgroundColor);
    }
    return;
  }
  word(mode.unit);
  word(at("low").textContent);
  const top = page.top(mode);
  const kept = pen.fillStyle;
  for (let x = 0; x < BAR[0]; x++) {
    const share = (x + 0.5) / BAR[0];
    pen.fillStyle = `rgb(${Array.from(page.ramp(top * (mode.signed ? 2 * share - 1 : share), mode))})`;
    pen.fillRect(left + x, middle - BAR[1] / 2, 1.5, BAR[1]);
  }
  pen.fillStyle = kept;
  left += BAR[0] + 6;
  word(at("high").textContent);
}

// both surfaces side by side, as they are shown, with what is marked, and what the colours stand for
async function viewPicture(page) {
  page.scenes.forEach((scene) => scene.drawNow());
  const corner = ({ plot }) => plot.getBoundingClientRect();
  const scenes = [...page.scenes].sort((a, b) => corner(a).left - corner(b).left || corner(a).top - corner(b).top);
  const shown = scenes.map((scene) => scene.canvas);
  const picture = Object.assign(document.createElement("canvas"), {
    width: shown.reduce((sum, one) => sum + one.width, 0), height: Math.max(...shown.map((one) => one.height)) });
  const scale = shown[0].width / shown[0].getBoundingClientRect().width;
  picture.height += Math.ceil(2 * HEAD * scale);
  const pen = picture.getContext("2d");
  pen.fillStyle = getComputedStyle(document.querySelector(".panel")).backgroundColor;
  pen.fillRect(0, 0, picture.width, picture.height);
  pen.save();
  pen.translate(0, HEAD * scale);
  let left = 0;
  for (const scene of scenes) {
    pen.drawImage(scene.canvas, left, 0);
    drawMarks(pen, scene, left);
    left += scene.canvas.width;
  }
  pen.restore();
  drawWords(pen, page, scenes, scale);
  return new Promise((done) => picture.toBlob(done, "image/png"));
}

const CHECKS = ["together", "squares", "wireframe", "fit", "fine"];

function stateOf(page) {
  const flat = (camera) => ["eye", "up", "center"].flatMap((name) => xyz(camera[name])).map((c) => Number(c.toFixed(4))).join(",");
  const state = new URLSearchParams({
    map: at("map").selectedIndex, mode: page.mode.key, beside: at("beside").value, morph: at("morph").value,
    on: CHECKS.filter((id) => at(id).checked).join(","), pins: page.pins.map(({ side, vertex }) => `${side}.${vertex}`).join(","),
    look: page.scenes.slice(0, 2).map((scene) => flat(scene.camera)).join(";"),
  });
  return state.toString();
}

// in the address, where that is allowed: not in a frame of a notebook
function remember(page) {
  try {
    history.replaceState(null, "", `#${stateOf(page)}`);
  } catch { /* the view is as it was */ }
}

function restore(page, text) {
  const state = new URLSearchParams(text);
  const number = (value, low, high) => (Number.isFinite(Number(value)) ? Math.min(Math.max(Number(value), low), high) : low);
  at("map").selectedIndex = number(state.get("map"), 0, page.data.maps.length - 1);
  const mode = [...document.querySelectorAll("input[name=mode]")].find((input) => input.value === state.get("mode"));
  if (mode) mode.checked = true;
  at("morph").value = number(state.get("morph"), 0, 1);
  if (page.data.maps[state.get("beside")] && state.get("beside") !== "") at("beside").value = state.get("beside");
  CHECKS.forEach((id) => { at(id).checked = (state.get("on") || "").split(",").includes(id); });
  page.pins = (state.get("pins") || "").split(",").map((pin) => pin.split(".").map(Number))
    .filter(([side, vertex]) => page.data.surfaces[side] && vertex >= 0 && vertex < page.data.surfaces[side].origin.length)
    .slice(-MOST_PINS).map(([side, vertex]) => ({ side, vertex }));
  (state.get("look") || "").split(";").forEach((one, side) => {
    const c = one.split(",").map(Number);
    if (c.length !== 9 || !c.every(Number.isFinite) || !page.scenes[side]) return;
    page.scenes[side].look({ eye: named(c.slice(0, 3)), up: named(c.slice(3, 6)), center: named(c.slice(6)) });
  });
}
