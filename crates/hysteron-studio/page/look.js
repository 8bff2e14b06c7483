// Linked views of a file and of fits.

import { ask } from "./api.js";
import { by, el, fill } from "./dom.js";
import { draw, on, save, stroke } from "./plot.js";
import * as plane from "./plane.js";
import * as play from "./play.js";

const BANDS = [
  ["output", "plot-output"], ["input", "plot-input"], ["loop", "plot-loop"],
  ["residuals", "plot-residuals"], ["residuals_over_input", "plot-over-input"], ["histogram", "plot-histogram"],
];
const OVER_TIME = new Set(["output", "input", "residuals"]);

/** @typedef {{input: [number, number]|null, output: [number, number]|null}} Area */
/** @type {Area} */
const ALL = { input: null, output: null };

/** What is shown. @type {{file: number|null, window: [number, number]|null, area: Area, raw: boolean, span: [number, number]|null, marking: boolean, overview: any, drawn: Set<number>, whole: [number, number]|null, samples: number, asked: number, changed?: any}} */
const now = { file: null, window: null, area: ALL, raw: true, span: null, marking: false, overview: null, drawn: new Set(), whole: null, samples: 0, asked: 0 };

/** @param {string} band */
const view = (band) => {
  const node = by(/** @type {any} */ (BANDS.find(([name]) => name === band))[1]);
  return { file: now.file, fits: [...now.drawn], picture: band, window: now.window, area: now.area, raw: now.raw, pixels: [Math.max(100, node.clientWidth), Math.max(100, node.clientHeight)] };
};

/** The pictures that can be taken home as numbers. */
export const shownViews = () => ({ views: view, bands: BANDS });

/**
 * @param {import("./api.js").Overview} overview
 * @param {Set<number>} drawn
 * @param {(overview: any) => void} changed
 */
export function show(overview, drawn, changed) {
  const files = overview.files.filter((file) => !file.problem);
  by("look").hidden = files.length === 0;
  Object.assign(now, { overview, drawn: new Set([...drawn].filter((id) => overview.fits.some((fit) => fit.id === id))) });
  if (files.length === 0) return;
  if (!files.some((file) => file.id === now.file)) Object.assign(now, { file: files[0].id, window: null, area: ALL, whole: null });
  tools(files, changed);
  for (const node of document.querySelectorAll(".fitted")) /** @type {HTMLElement} */ (node).hidden = now.drawn.size === 0;
  return redraw();
}

/**
 * @param {import("./api.js").File[]} files
 * @param {(overview: any) => void} changed
 */
function tools(files, changed) {
  const again = () => show(now.overview, now.drawn, changed);
  const zoom = (/** @type {number} */ share, /** @type {number} */ move) => {
    const [a, b] = now.window ?? now.span ?? now.whole ?? [0, 1];
    const middle = (a + b) / 2 + move * (b - a);
    const half = ((b - a) / 2) * share;
    now.window = share > 1 && now.whole && 2 * half >= now.whole[1] - now.whole[0] ? null : [middle - half, middle + half];
    redraw();
  };
  const file = files.find((file) => file.id === now.file);
  fill(
    by("look-tools"),
    el("label", {}, "File ", el("select", { "data-key": "look-file", onchange: (/** @type {any} */ e) => (Object.assign(now, { file: Number(e.target.value), window: null, area: ALL, whole: null }), again()) }, ...files.map((file) => el("option", { value: String(file.id), selected: file.id === now.file }, file.name)))),
    el("button", { "data-key": "zoom-in", "aria-label": "Zoom in", onclick: () => zoom(0.5, 0) }, "+"),
    el("button", { "data-key": "zoom-out", "aria-label": "Zoom out", onclick: () => zoom(2, 0) }, "−"),
    el("button", { "data-key": "earlier", "aria-label": "Earlier", onclick: () => zoom(1, -0.25) }, "◀"),
    el("button", { "data-key": "later", "aria-label": "Later", onclick: () => zoom(1, 0.25) }, "▶"),
    el("button", { "data-key": "all", onclick: () => (Object.assign(now, { window: null, area: ALL }), redraw()) }, "Show all"),
    el("button", { "data-key": "mark", "aria-pressed": String(now.marking), onclick: () => ((now.marking = !now.marking), again()) }, now.marking ? "Drag over the output to mark…" : file?.marked.length ? "Mark another span for validation" : "Mark a span for validation"),
    file?.steps ? el("button", { "data-key": "as-read", "aria-pressed": String(now.raw), onclick: () => ((now.raw = !now.raw), again()) }, "As read, too") : null,
    file && now.marking
      ? el("form", { class: "row", onsubmit: (/** @type {any} */ e) => {
          e.preventDefault();
          const form = new FormData(e.target);
          now.marking = false;
          ask("mark", { file: now.file, rows: [Number(form.get("first")), Number(form.get("last"))] }).then(changed, () => again());
        } },
        el("label", {}, "or rows ", el("input", { name: "first", type: "number", min: 1, max: file.samples, required: true, style: "width:7rem" })),
        el("label", {}, "to ", el("input", { name: "last", type: "number", min: 1, max: file.samples, required: true, style: "width:7rem" })),
        el("button", {}, "Mark"))
      : null,
  );
  now.changed = changed;
}

/** Fetches what the pixels can show, and draws it. */
async function redraw() {
  const mine = ++now.asked;
  const bands = BANDS.filter(([band]) => now.drawn.size > 0 || ["output", "input", "loop"].includes(band));
  await Promise.all(bands.map((band) => picture(band, mine)));
  if (mine !== now.asked) return;
  play.show(now.overview, now.drawn, now.file, now.window ?? now.span ?? [0, 1], now.samples);
  if (mine === now.asked && now.drawn.size > 0) await plane.show(now.overview, now.drawn);
}

/**
 * @param {string[]} which its name and its place
 * @param {number} mine
 */
async function picture([band, id], mine) {
  const node = by(/** @type {any} */ (id));
  const curves = /** @type {import("./api.js").Curves} */ (await ask("curves", view(band)).catch(() => null));
  if (!curves || mine !== now.asked) return;
  const place = (/** @type {number} */ id) => now.overview.fits.findIndex((/** @type {any} */ fit) => fit.id === id);
  const traces = curves.lines.map(({ fit, raw, x, y }) => ({
    x, y,
    type: band === "histogram" ? "bar" : "scatter",
    mode: band === "residuals_over_input" ? "markers" : "lines",
    name: raw ? "as read" : fit === null ? "measured" : `fit ${place(fit) + 1}`,
    line: raw ? { color: "#e69f00", width: 1 } : stroke(fit === null ? null : place(fit)),
    marker: { color: stroke(fit === null ? null : place(fit)).color, size: 3 },
    opacity: band === "histogram" && curves.lines.length > 1 ? 0.6 : 1,
    connectgaps: false,
  }));
  const overTime = OVER_TIME.has(band);
  const isPart = now.area.input !== null || now.area.output !== null;
  if (band === "output") {
    Object.assign(now, { span: curves.span, samples: curves.samples });
    if (!now.window && !isPart) now.whole = curves.span;
  }
  const range = overTime ? now.window ?? curves.span : band === "histogram" ? null : now.area.input;
  const height = band === "loop" ? now.area.output : null;
  const shapes = overTime
    ? curves.marked.map(([x0, x1]) => ({ type: "rect", xref: "x", yref: "paper", x0, x1, y0: 0, y1: 1, fillcolor: "rgba(230,159,0,.22)", line: { width: 0 }, label: { text: band === "output" ? "validation" : "", textposition: "top left" } }))
    : [];
  await draw(node, traces, {
    x: curves.x, y: curves.y, shapes: [...shapes, ...play.shapes(id)], barmode: "overlay", bargap: 0,
    xaxis: range ? { range: [...range] } : {},
    yaxis: height ? { range: [...height] } : {},
    dragmode: now.marking && band === "output" ? "select" : band === "histogram" ? false : "zoom",
    selectdirection: "h",
    meta: { samples: curves.samples },
  });
  on(node, "plotly_relayout", (event) => {
    if (event.shapes || band === "histogram") return;
    const ends = (/** @type {string} */ axis) => {
      const [a, b] = [event[`${axis}.range[0]`], event[`${axis}.range[1]`]];
      return a === undefined || b === undefined ? null : /** @type {[number, number]} */ ([Math.min(a, b), Math.max(a, b)]);
    };
    const [along, up] = [ends("xaxis"), ends("yaxis")];
    if (event["xaxis.autorange"] || event["yaxis.autorange"]) Object.assign(now, overTime ? { window: null } : { area: ALL });
    else if (overTime && along) now.window = along;
    else if (!overTime && (along || up)) now.area = { input: along ?? now.area.input, output: band === "loop" ? up ?? now.area.output : now.area.output };
    else return;
    redraw();
  });
  if (!overTime) return;
  on(node, "plotly_click", (event) => (plane.states(), play.to(Number(event.points[0].x))));
  if (band === "output") on(node, "plotly_selected", (event) => {
    if (!event?.range || !now.marking) return;
    now.marking = false;
    ask("mark_span", { file: now.file, from: event.range.x[0], to: event.range.x[1] }).then(/** @type {any} */ (now).changed, () => {});
  });
}

/** @param {"svg" | "png"} format */
export const picturesAs = (format) => Promise.all([...document.querySelectorAll("#look figure:not([hidden]) .js-plotly-plot")].map((node) => save(/** @type {HTMLElement} */ (node), format)));
