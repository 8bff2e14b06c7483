// The sample pointed at: its mark in every view, and a play through the time.

import { ask } from "./api.js";
import { by, capital, el, fill, shown, unit, which } from "./dom.js";
import * as plane from "./plane.js";
import { mark } from "./plot.js";

const OVER_TIME = ["plot-output", "plot-input", "plot-residuals"];
/** A play takes so many seconds for the part that is shown. */
const SPEEDS = [60, 20, 8, 3];

/** @typedef {{number: number, place: string|null, time: number, input: number, output: number, modelled: [number, number][]}} Sample */

/** @type {{file: number|null, range: [number, number], at: number|null, sample: Sample|null, overview: any, drawn: Set<number>, seconds: number, timer: number, waiting: boolean, busy: boolean, steps: number}} */
const now = { file: null, range: [0, 1], at: null, sample: null, overview: null, drawn: new Set(), seconds: 20, timer: 0, waiting: false, busy: false, steps: 1 };

/** Says which file is shown: a sample of another one is forgotten. @param {number|null} file */
export function of(file) {
  if (file !== now.file) Object.assign(now, { file, at: null, sample: null });
}

/**
 * The bar with the button, the speed, and the place in time.
 * @param {any} overview
 * @param {Set<number>} drawn
 * @param {number|null} file
 * @param {[number, number]} range of the time that is shown
 * @param {number} samples in it
 */
export function show(overview, drawn, file, range, samples) {
  of(file);
  // After a preparation or another fit the same time may be another sample and value.
  const stale = now.at !== null && now.overview !== null && now.overview !== overview;
  Object.assign(now, { overview, drawn, range, steps: Math.max(1, samples) });
  if (stale) to(/** @type {number} */ (now.at));
  const [low, high] = range;
  const title = now.timer ? "Pause" : "Play";
  fill(
    by("play"),
    el("button", { id: "play-button", "data-key": "play", "aria-keyshortcuts": "Space", onclick: toggle }, now.timer ? "❚❚ Pause" : "▶ Play"),
    el("label", {}, "in ", el("select", { "data-key": "play-speed", "aria-label": `${title} the part that is shown in`, onchange: (/** @type {any} */ e) => (now.seconds = Number(e.target.value)) }, ...SPEEDS.map((s) => el("option", { value: String(s), selected: s === now.seconds }, `${s} s`)))),
    el("input", { id: "play-at", "data-key": "play-at", type: "range", min: low, max: high, step: (high - low) / Math.min(now.steps, 2000) || "any", value: String(now.at ?? low), "aria-label": "Sample, by its time", oninput: (/** @type {any} */ e) => to(Number(e.target.value)) }),
    el("span", { id: "play-sample", role: "status", "aria-live": "off" }, words()),
  );
}

const words = () => {
  if (!now.sample) return "Click a sample in any picture. Space plays, arrow keys move.";
  const { time, input, output, modelled } = now.sample;
  const file = now.overview.files.find((/** @type {any} */ file) => file.id === now.file);
  const of = unit(file?.output);
  const fits = modelled.map(([id, value]) => `, fit ${now.overview.fits.findIndex((/** @type {any} */ fit) => fit.id === id) + 1}: ${shown(value)}${of} (off by ${shown(value - output)})`);
  // Of several files one might be taken for another.
  const name = now.overview.files.length > 1 && file ? `${file.name}, ${which(now.sample)}` : capital(which(now.sample));
  return `${name}${file?.roles.time ? `, at ${shown(time)} s` : ""}: input ${shown(input)}${unit(file?.input)}, measured ${shown(output)}${of}${fits.join("")}`;
};

/** Starts a play, or pauses it. */
export function toggle() {
  if (now.timer) {
    clearInterval(now.timer);
    now.timer = 0;
  } else {
    if (now.at === null || now.at >= now.range[1]) now.at = now.range[0];
    let last = performance.now();
    now.timer = setInterval(() => {
      const [low, high] = now.range;
      const way = ((performance.now() - last) / 1000 / now.seconds) * (high - low);
      last = performance.now();
      to(Math.min(high, Math.max(low, (now.at ?? low) + way)));
      if ((now.at ?? high) >= high) toggle();
    }, 40);
  }
  by("play-button").textContent = now.timer ? "❚❚ Pause" : "▶ Play";
}

/** Points at the sample nearest to a time. The latest wish counts. @param {number} time */
export async function to(time) {
  now.at = time;
  now.waiting = true;
  if (now.busy) return;
  now.busy = true;
  while (now.waiting && now.at !== null) {
    now.waiting = false;
    const file = now.file;
    const sample = await ask("sample", { file, fits: [...now.drawn], at: now.at }).catch(() => null);
    if (file !== now.file) continue;
    now.sample = sample;
    by("play-sample").textContent = words();
    by("play-at").value = String(now.at);
    for (const id of [...OVER_TIME, "plot-loop", "plot-over-input"]) if (by(id).layout) await mark(by(id), shapes(id));
    if (file === now.file && now.at !== null && now.drawn.size > 0) await plane.at(file, now.at, now.overview, now.drawn);
  }
  now.busy = false;
}

/** A value on an axis; one beyond it is at its end. @param {number} value @param {[number, number] | null} ends */
const within = (value, ends) => (ends ? Math.min(ends[1], Math.max(ends[0], value)) : value);

/**
 * The mark of the sample in a view. Off the scale it is at the edge, as outliers are.
 * @param {string} id
 * @param {[number, number] | null} across the ends of the axes; null for all that there is
 * @param {[number, number] | null} up
 * @returns {object[]}
 */
export function shapes(id, across = by(id).layout?.xaxis.range, up = by(id).layout?.yaxis.range) {
  if (!now.sample) return [];
  const { time, input, output } = now.sample;
  const line = { color: "#d55e00", width: 2 };
  if (OVER_TIME.includes(id)) return [{ type: "line", name: "now", xref: "x", yref: "paper", x0: time, x1: time, y0: 0, y1: 1, line }];
  const round = { type: "circle", name: "now", xsizemode: "pixel", ysizemode: "pixel", xanchor: within(input, across), yanchor: within(output, up), x0: -7, x1: 7, y0: -7, y1: 7 };
  // One circle for each fit.
  if (id === "plot-over-input") return now.sample.modelled.map(([, value]) => ({ ...round, yanchor: within(value - output, up), fillcolor: "rgba(213,94,0,.5)", line }));
  return id === "plot-loop" ? [{ ...round, fillcolor: "rgba(213,94,0,.5)", line }] : [];
}

addEventListener("keydown", (event) => {
  const target = /** @type {HTMLElement} */ (event.target);
  const inside = target === document.body || (target.closest?.("#look") && !target.closest("button, select, input"));
  const isSlider = target.id === "play-at";
  if (by("look").hidden || !(inside || isSlider)) return;
  const [low, high] = now.range;
  const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  if (event.key === " ") toggle();
  // The slider moves itself.
  else if (way && !isSlider) to(Math.min(high, Math.max(low, (now.at ?? low) + (way * (high - low)) / Math.max(1, now.steps - 1))));
  else return;
  event.preventDefault();
});

plane.onChoice(to);
