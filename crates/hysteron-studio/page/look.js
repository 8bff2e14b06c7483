// Linked views of a file and of fits.

import { ask } from "./api.js";
import { by, el, fill } from "./dom.js";
import * as layers from "./layers.js";
import { archive, draw, on, stroke } from "./plot.js";
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

/** What is shown; `beyond` are the pictures with samples off their scale. @type {{file: number|null, window: [number, number]|null, area: Area, span: [number, number]|null, marking: boolean, overview: any, drawn: Set<number>, whole: [number, number]|null, samples: number, asked: number, everything: boolean, beyond: Set<string>, changed?: any}} */
const now = { file: null, window: null, area: ALL, span: null, marking: false, overview: null, drawn: new Set(), whole: null, samples: 0, asked: 0, everything: false, beyond: new Set() };

/** The fit whose band, outliers and held-out samples are drawn. */
const leading = () => (now.drawn.has(now.overview.best) ? now.overview.best : [...now.drawn].at(-1) ?? null);

/** @param {string} band */
const view = (band) => {
  const node = by(/** @type {any} */ (BANDS.find(([name]) => name === band))[1]);
  return { file: now.file, fits: [...now.drawn], picture: band, window: now.window, area: now.area, raw: layers.has("raw"), of: leading(), band: layers.has("band"), pixels: [Math.max(100, node.clientWidth), Math.max(100, node.clientHeight)] };
};

/** The pictures that can be taken home as numbers. */
export const shownViews = () => ({ views: view, bands: BANDS });

/** @param {number} file */
export const isShown = (file) => now.file === file;

export const isMarking = () => now.marking;

/** Begins or ends a mark by a drag over the output. */
export function marks() {
  now.marking = !now.marking;
  now.changed?.(now.overview);
}

/**
 * Shows a file, or a part of its time.
 * @param {number} file
 * @param {[number, number] | null} window
 */
export async function choose(file, window = null) {
  Object.assign(now, { file, window, area: ALL });
  if (!window) now.whole = null;
  // The tasks are about the file that is shown.
  await now.changed?.(now.overview);
  reveal();
}

/**
 * Points at a sample of a file, and shows it.
 * @param {number} file
 * @param {number} time
 */
export async function point(file, time) {
  const isInside = now.window === null || (now.window[0] <= time && time <= now.window[1]);
  if (file !== now.file || !isInside) {
    Object.assign(now, { file, window: null, area: ALL, whole: null });
    await now.changed?.(now.overview);
  }
  await play.to(time);
  reveal();
}

/**
 * Where no picture is in view, as on a phone that shows the list of fits, goes to them. The keys go along: they
 * move the sample from there.
 */
function reveal() {
  const inView = BANDS.some(([, id]) => {
    const { top, bottom, height } = by(id).getBoundingClientRect();
    return height > 0 && (top + bottom) / 2 > 0 && (top + bottom) / 2 < innerHeight;
  });
  if (inView) return;
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  by("look").scrollIntoView({ behavior: still ? "auto" : "smooth" });
  by("play-at").focus({ preventScroll: true });
}

const again = () => show(now.overview, now.drawn, now.changed);

/**
 * @param {import("./api.js").Overview} overview
 * @param {Set<number>} drawn
 * @param {(overview: any) => void} changed
 */
export function show(overview, drawn, changed) {
  const files = overview.files.filter((file) => !file.problem);
  by("look").hidden = files.length === 0;
  Object.assign(now, { overview, changed, drawn: new Set([...drawn].filter((id) => overview.fits.some((fit) => fit.id === id))) });
  if (files.length === 0) return void (now.file = null);
  if (!files.some((file) => file.id === now.file)) Object.assign(now, { file: files[0].id, window: null, area: ALL, whole: null });
  tools();
  for (const node of document.querySelectorAll(".fitted")) if (now.drawn.size === 0) /** @type {HTMLElement} */ (node).hidden = true;
  by("figure-plane").hidden = now.drawn.size === 0;
  return redraw();
}

function tools() {
  const zoom = (/** @type {number} */ share, /** @type {number} */ move) => {
    const [a, b] = now.window ?? now.span ?? now.whole ?? [0, 1];
    const middle = (a + b) / 2 + move * (b - a);
    const half = ((b - a) / 2) * share;
    now.window = share > 1 && now.whole && 2 * half >= now.whole[1] - now.whole[0] ? null : [middle - half, middle + half];
    redraw();
  };
  const button = (/** @type {string} */ key, /** @type {string} */ sign, /** @type {string} */ name, /** @type {() => void} */ onclick) => el("button", { "data-key": key, "aria-label": name, title: name, onclick }, sign);
  const file = now.overview.files.find((/** @type {any} */ file) => file.id === now.file);
  const fit = now.overview.fits.find((/** @type {any} */ fit) => fit.id === leading());
  fill(
    by("look-tools"),
    el("div", { class: "group", role: "group", "aria-label": "Part of the time" },
      button("zoom-in", "+", "Zoom in", () => zoom(0.5, 0)),
      button("zoom-out", "−", "Zoom out", () => zoom(2, 0)),
      button("earlier", "◀", "Earlier", () => zoom(1, -0.25)),
      button("later", "▶", "Later", () => zoom(1, 0.25)),
      el("button", { "data-key": "all", onclick: () => (Object.assign(now, { window: null, area: ALL }), redraw()) }, "All")),
    el("div", { class: "row", role: "group", "aria-label": "What is drawn" },
      ...layers.buttons(file, fit, again),
      now.beyond.size > 0 || now.everything ? el("button", { class: "chip", "data-key": "everything", "aria-pressed": String(now.everything), title: "A few samples lie far from all others", onclick: () => ((now.everything = !now.everything), again()) }, "Off the scale") : null),
    now.marking ? el("strong", { role: "status" }, "Drag over the output to hold a span out.") : null,
  );
}

/** Fetches what the pixels can show, and draws it. */
async function redraw() {
  const mine = ++now.asked;
  play.of(now.file);
  const before = now.beyond.size > 0;
  const bands = BANDS.filter(([band]) => now.drawn.size > 0 || ["output", "input", "loop"].includes(band));
  for (const band of now.beyond) if (!bands.some(([name]) => name === band)) now.beyond.delete(band);
  await Promise.all(bands.map((band) => picture(band, mine)));
  if (mine !== now.asked) return;
  if (before !== now.beyond.size > 0) tools();
  play.show(now.overview, now.drawn, now.file, now.window ?? now.span ?? [0, 1], now.samples);
  if (mine === now.asked && now.drawn.size > 0) await plane.show(now.overview, now.drawn, now.file);
}

/** The ends with some room; null for all that there is. @param {import("./api.js").Ends | null} ends @returns {[number, number] | null} */
const scale = (ends) => {
  if (!ends || now.everything) return null;
  const room = 0.05 * (ends.high - ends.low || Math.abs(ends.high) || 1);
  return [ends.low - room, ends.high + room];
};

/**
 * @param {string[]} which its name and its place
 * @param {number} mine
 */
async function picture([band, id], mine) {
  const node = by(/** @type {any} */ (id));
  const curves = /** @type {import("./api.js").Curves} */ (await ask("curves", view(band)).catch(() => null));
  if (!curves || mine !== now.asked) return;
  // Where no fit can be run on this file, axes would be empty.
  const figure = /** @type {HTMLElement} */ (node.closest("figure"));
  if (figure.classList.contains("fitted")) {
    const was = figure.hidden;
    figure.hidden = curves.lines.length === 0;
    if (figure.hidden) return;
    // What it can show is known once it has its size.
    if (was) return picture([band, id], mine);
  }
  const place = (/** @type {number|null} */ id) => now.overview.fits.findIndex((/** @type {any} */ fit) => fit.id === id);
  const lines = curves.lines.map(({ fit, raw, x, y }) => ({
    x, y,
    type: band === "histogram" ? "bar" : "scatter",
    mode: band === "residuals_over_input" ? "markers" : "lines",
    name: raw ? "as read" : fit === null ? "measured" : `fit ${place(fit) + 1}`,
    line: raw ? { color: "#e69f00", width: 1 } : stroke(fit === null ? null : place(fit)),
    marker: { color: stroke(fit === null ? null : place(fit)).color, size: 3 },
    // Of several fits none hides another.
    opacity: ["histogram", "residuals_over_input"].includes(band) && curves.lines.length > 1 ? 0.6 : 1,
    connectgaps: false,
  }));
  const overTime = OVER_TIME.has(band);
  const isPart = now.area.input !== null || now.area.output !== null;
  if (band === "output") {
    by("look-left-out").hidden = curves.left_out.length === 0;
    by("look-left-out").textContent = curves.left_out.map(({ fit, why }) => `Fit ${place(fit) + 1} is not drawn on this file: ${why.problem}.`).join(" ");
    Object.assign(now, { span: curves.span, samples: curves.samples });
    if (!now.window && !isPart) now.whole = curves.span;
  }
  // A few samples far from all others do not set the scale.
  const isLoop = band === "loop";
  const [across, up] = curves.ends;
  const range = overTime ? now.window ?? curves.span : now.area.input ?? scale(across);
  const height = isLoop ? now.area.output ?? scale(up) : scale(up);
  const [below, above] = band === "histogram" ? [[], []] : layers.traces(curves, place(leading()), height);
  if (across?.beyond || up?.beyond) now.beyond.add(band);
  else now.beyond.delete(band);
  await draw(node, [...below, ...lines, ...above], {
    x: curves.x, y: curves.y, shapes: [...(overTime ? layers.shapes(curves, band === "output") : []), ...play.shapes(id, range ?? null, height)], barmode: "overlay", bargap: 0,
    xaxis: range ? { range: [...range] } : {},
    yaxis: { ...(height ? { range: [...height] } : {}), fixedrange: !isLoop },
    dragmode: now.marking && band === "output" ? "select" : band === "histogram" ? false : "zoom",
    selectdirection: "h",
    meta: { samples: curves.samples },
    aligned: band !== "loop",
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
  on(node, "plotly_click", async (event) => {
    const { x, y } = event.points[0];
    plane.states();
    if (overTime) return play.to(Number(x));
    const sample = await ask("nearest", { view: view(band), at: [Number(x), Number(y)] }).catch(() => null);
    if (sample) play.to(sample.time);
  });
  if (band === "output") on(node, "plotly_selected", (event) => {
    if (!event?.range || !now.marking) return;
    now.marking = false;
    ask("mark_span", { file: now.file, from: event.range.x[0], to: event.range.x[1] }).then(/** @type {any} */ (now).changed, () => {});
  });
}

/** The pictures that are shown, as files. @returns {Promise<{name: string, bytes: Uint8Array}[]>} */
export const pictures = () => archive(/** @type {HTMLElement[]} */ ([...document.querySelectorAll("#look figure:not([hidden]) .js-plotly-plot")]));
