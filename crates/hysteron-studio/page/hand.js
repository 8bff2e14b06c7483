// What a hand does in the drive: it drags in the picture, or draws a path.

import { by, el } from "./dom.js";

const NS = "http://www.w3.org/2000/svg";
/** Samples of a path that is drawn. */
const SAMPLES = 200;

/** @type {{moves: "input"|"output", path: "inputs"|"outputs"}} */
const now = { moves: "input", path: "inputs" };

/**
 * The choices, and the pad for a path.
 * @param {boolean} inverse whether the model has one
 * @param {(what: object) => void} move
 * @param {() => {inputs: [number, number], outputs: [number, number]}} ends
 */
export function form(inverse, move, ends) {
  if (!inverse) Object.assign(now, { moves: "input", path: "inputs" });
  const choice = (/** @type {"moves"|"path"} */ what, /** @type {string} */ title, /** @type {string[][]} */ all) =>
    el("label", { class: "field" }, el("span", {}, title), el("select", { "data-key": `hand-${what}`, onchange: (/** @type {any} */ e) => Object.assign(now, { [what]: e.target.value }) }, ...all.map(([value, text], n) => el("option", { value, selected: now[what] === value, disabled: n === 1 && !inverse }, text))));
  const typed = (/** @type {any} */ event) => {
    event.preventDefault();
    const numbers = String(new FormData(event.target).get("path")).split(/[\s,;]+/).filter(Boolean).map(Number);
    const isPath = numbers.length > 0 && numbers.every(Number.isFinite);
    const field = event.target.elements.path;
    field.setCustomValidity(isPath ? "" : "Numbers with a point, apart by spaces: 20 60.5 30");
    field.reportValidity();
    if (isPath) move({ [now.path]: numbers });
  };
  return el("div", {},
    choice("moves", "Dragging in the picture moves", [["input", "the input: to the side"], ["output", "the output: up and down"]]),
    choice("path", "A path drawn here is", [["inputs", "the input over time"], ["outputs", "the output wanted over time"]]),
    pad(move, ends),
    el("form", { class: "row", onsubmit: typed }, el("label", {}, "or as numbers ", el("input", { name: "path", type: "text", oninput: (/** @type {any} */ event) => event.target.setCustomValidity(""), placeholder: "20 60 30", autocomplete: "off", "data-key": "hand-numbers" })), el("button", {}, "Follow")));
}

/**
 * @param {(what: object) => void} move
 * @param {() => {inputs: [number, number], outputs: [number, number]}} ends
 */
function pad(move, ends) {
  const svg = document.createElementNS(NS, "svg");
  svg.id = "path";
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", "Draw a path here from left to right");
  const line = document.createElementNS(NS, "polyline");
  for (const [name, value] of [["fill", "none"], ["stroke", "currentColor"], ["stroke-width", "2"]]) line.setAttribute(name, value);
  svg.append(line);
  /** @type {[number, number][]} */
  let points = [];
  const add = (/** @type {PointerEvent} */ event) => {
    const box = svg.getBoundingClientRect();
    const point = /** @type {[number, number]} */ ([event.clientX - box.left, Math.min(box.height, Math.max(0, event.clientY - box.top))]);
    // Time goes on only.
    if (points.length === 0 || point[0] > points[points.length - 1][0]) points.push(point);
    line.setAttribute("points", points.map((p) => p.join(",")).join(" "));
  };
  svg.addEventListener("pointerdown", (event) => {
    points = [];
    svg.setPointerCapture?.(event.pointerId);
    add(event);
  });
  svg.addEventListener("pointermove", (event) => points.length > 0 && event.buttons > 0 && add(event));
  svg.addEventListener("pointerup", () => {
    if (points.length < 2) return;
    const [low, high] = ends()[now.path];
    const height = svg.getBoundingClientRect().height;
    const [from, to] = [points[0][0], points[points.length - 1][0]];
    let n = 0;
    const values = Array.from({ length: SAMPLES }, (_, k) => {
      const x = from + ((to - from) * k) / (SAMPLES - 1);
      while (n < points.length - 2 && points[n + 1][0] < x) n += 1;
      const [[x0, y0], [x1, y1]] = [points[n], points[n + 1]];
      const y = y0 + (y1 - y0) * Math.min(1, (x - x0) / (x1 - x0));
      return high - (y / height) * (high - low);
    });
    points = [];
    move({ [now.path]: values });
  });
  return /** @type {any} */ (svg);
}

/**
 * Dragging in the picture of the drive.
 * @param {any} node
 * @param {boolean} inverse
 * @param {(what: object) => void} move
 */
export function drags(node, inverse, move) {
  node.style.touchAction = "none";
  const follow = (/** @type {PointerEvent} */ event) => {
    const { xaxis, yaxis } = node._fullLayout;
    const box = node.getBoundingClientRect();
    const what = inverse ? now.moves : "input";
    move({ [what]: what === "input" ? xaxis.p2d(event.clientX - box.left - xaxis._offset) : yaxis.p2d(event.clientY - box.top - yaxis._offset) });
  };
  node.onpointerdown = (/** @type {PointerEvent} */ event) => (node.setPointerCapture?.(event.pointerId), follow(event));
  node.onpointermove = (/** @type {PointerEvent} */ event) => event.buttons > 0 && follow(event);
}
