// What is drawn besides the lines: band, outliers, what is held out, where recordings begin.

import { el } from "./dom.js";
import { ink, tint } from "./plot.js";

/** @typedef {"band" | "outliers" | "held" | "segments" | "raw"} Layer */
/** @type {[Layer, string][]} */
const NAMES = [["band", "Band"], ["outliers", "Outliers"], ["held", "Held out"], ["segments", "Recordings"], ["raw", "As read"]];

/** @type {Set<Layer>} */
const on = new Set(["band", "outliers", "held", "segments", "raw"]);

/** @param {Layer} layer */
export const has = (layer) => on.has(layer);

/**
 * Buttons for the layers that there are.
 * @param {import("./api.js").File} file
 * @param {import("./api.js").Fit | undefined} fit whose layers are drawn
 * @param {() => void} changed
 */
export function buttons(file, fit, changed) {
  const there = {
    band: Boolean(fit?.confidence),
    outliers: Boolean(fit?.outliers),
    held: file.marked.length > 0 || Boolean(fit?.hold_out),
    segments: file.begins.length > 1,
    raw: file.steps !== null,
  };
  const button = (/** @type {[Layer, string]} */ [layer, name]) =>
    el("button", { class: "chip", "data-key": layer === "raw" ? "as-read" : `layer-${layer}`, "aria-pressed": String(on.has(layer)), onclick: () => (on.has(layer) ? on.delete(layer) : on.add(layer), changed()) }, name);
  return NAMES.filter(([layer]) => there[layer]).map(button);
}

/**
 * The band and the outliers as traces. The band lies below all lines.
 * @param {import("./api.js").Curves} curves
 * @param {number} place of the fit in the list
 * @param {[number, number] | null} height of the picture; outliers beyond it are drawn at its edge
 * @returns {[object[], object[]]} below the lines and above them
 */
export function traces({ band, band_name, outliers }, place, height) {
  const below = [];
  if (band && on.has("band")) {
    const [low, high] = band.map(([x, y]) => pieces(x, y));
    /** @type {{x: (number|null)[], y: (number|null)[]}} */
    const area = { x: [], y: [] };
    low.forEach((piece, n) => {
      const back = [...(high[n] ?? [])].reverse();
      for (const [x, y] of [...piece, ...back]) (area.x.push(x), area.y.push(y));
      area.x.push(null);
      area.y.push(null);
    });
    below.push({ ...area, mode: "lines", fill: "toself", fillcolor: tint(place), line: { width: 0 }, hoverinfo: "skip", name: band_name });
  }
  const above = outliers.length > 0 && on.has("outliers")
    ? [{ x: outliers.map(([x]) => x), y: outliers.map(([, y]) => (height ? Math.min(height[1], Math.max(height[0], y)) : y)), mode: "markers", name: "outliers", marker: { symbol: "x-thin", size: 9, line: { width: 2, color: ink("bad") } } }]
    : [];
  return [below, above];
}

/**
 * The pieces of a line between its gaps.
 * @param {(number|null)[]} x
 * @param {(number|null)[]} y
 */
function pieces(x, y) {
  /** @type {[number, number][][]} */
  const found = [[]];
  x.forEach((x, n) => {
    const value = y[n];
    if (x === null || value === null) found.push([]);
    else found[found.length - 1].push([x, value]);
  });
  return found;
}

/**
 * Spans and beginnings over the time.
 * @param {import("./api.js").Curves} curves
 * @param {boolean} named whether they are named
 */
export function shapes({ held, marked, begins }, named) {
  const isPast = (/** @type {[number, number]} */ [a, b]) => held.some(([from, to]) => from <= a && b <= to);
  const span = (/** @type {string} */ colour, /** @type {string} */ name) => (/** @type {[number, number]} */ [x0, x1], /** @type {number} */ n) => ({
    type: "rect", xref: "x", yref: "paper", x0, x1, y0: 0, y1: 1, layer: "below", fillcolor: colour, line: { width: 0 },
    label: named && n === 0 ? { text: name, textposition: "top left", font: { size: 11, color: ink("quiet") } } : {},
  });
  const spans = on.has("held") ? [...held.map(span(ink("held"), "held out")), ...marked.filter((one) => !isPast(one)).map(span(ink("marked"), "for validation"))] : [];
  const line = (/** @type {number} */ x, /** @type {number} */ n) => ({
    type: "line", xref: "x", yref: "paper", x0: x, x1: x, y0: 0, y1: 1, line: { width: 1, dash: "dot", color: ink("quiet") },
    label: named && begins.length < 12 ? { text: String(n + 2), textposition: "end", textangle: 0, xanchor: "left", yanchor: "top", font: { size: 11, color: ink("quiet") } } : {},
  });
  return [...spans, ...(on.has("segments") ? begins.slice(0, 200).map(line) : [])];
}
