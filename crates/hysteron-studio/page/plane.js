// The plane of operators of one fit: weights, how well they are known, and their states at a sample.

import { ask } from "./api.js";
import { by, el, fill, shown, unit, which } from "./dom.js";
import { draw, on, plain, roundest, rounds } from "./plot.js";

const KINDS = [["weights", "weights"], ["excitation", "how well determined"], ["errors", "standard errors"], ["states", "states at a sample"]];
export const CLASSES = ["never excited", "excited once", "not told apart", "well determined"];

/** Until the user chooses a fit, it is the best. @type {{kind: string, fit: number|null, chosen: boolean, at: [number, number]|null, file: number|null, followed: {number: number, words: string}|null}} */
const now = { kind: "weights", fit: null, chosen: false, at: null, file: null, followed: null };

/** Shows the states of the operators from now on. */
export const states = () => (now.kind = "states");

/**
 * Shows the staircase at the sample that was pointed at.
 * @param {number|null} file
 * @param {number} time
 * @param {any} overview
 * @param {Set<number>} drawn
 */
export function at(file, time, overview, drawn) {
  if (file === null || drawn.size === 0) return;
  now.at = [file, time];
  return show(overview, drawn);
}

/** Told which sample a click in the plane chose. @type {(time: number) => void} */
let chosen = () => {};

/** @param {(time: number) => void} tell */
export const onChoice = (tell) => (chosen = tell);

/** Goes to the next sample at which the operator of a cell switches. @param {number[]} levels @param {number} alpha @param {number} beta */
async function follow(levels, alpha, beta) {
  if (now.file === null || now.fit === null) return;
  const here = now.at?.[0] === now.file ? now.at[1] : null;
  const sample = await ask("switch", { fit: now.fit, file: now.file, operator: [alpha + 1, beta + 1], after: here }).catch(() => null);
  if (!sample) return;
  const operator = `The operator that was clicked, on at ${shown(levels[beta])} and off at ${shown(levels[alpha])},`;
  if (sample.response === "never") {
    by("plane-text").textContent = `${operator} never switches in this file. Click a cell that the staircase passes.`;
    return;
  }
  now.kind = "states";
  now.followed = { number: sample.number, words: `${operator} switches at ${which(sample)}. ` };
  chosen(sample.time);
}

/** The place of an input between the levels of a plane. @param {number[]} levels @param {number} value */
const place = (levels, value) => {
  const after = Math.max(1, levels.findIndex((level) => level >= value));
  return after - 1 + (value - levels[after - 1]) / (levels[after] - levels[after - 1]);
};

/** Round inputs at their places between the levels of a plane. @param {number[]} levels */
function ticks(levels) {
  const last = levels.length - 1;
  const every = Math.max(1, last / 7);
  const apart = (/** @type {number[]} */ values) => {
    /** @type {[number, number][]} */
    const found = [];
    for (const value of values) {
      const at = place(levels, value);
      if (found.length === 0 || at - found[found.length - 1][0] >= 0.7 * every) found.push([at, value]);
    }
    return found;
  };
  let found = last > 0 ? apart(rounds(levels[0], levels[last])) : [];
  // Levels may lie close together in one part: then the roundest number between each two of them.
  if (found.length < 4) found = apart(levels.slice(1).flatMap((level, n) => roundest(levels[n], level)));
  return { tickvals: found.map(([at]) => at), ticktext: found.map(([, value]) => shown(value)), showgrid: false, zeroline: false };
}

const STEPS = ["#b0b7bf", "#e69f00", "#56b4e9", "#0072b2"];
const SCALE = STEPS.flatMap((step, n) => [[n / 4, step], [(n + 1) / 4, step]]);

/** The scale of how well operators are determined. A narrow page has short words. @param {boolean} narrow */
const bar = (narrow) => ({ tickvals: [0, 1, 2, 3], ticktext: narrow ? ["never", "once", "together", "well"] : CLASSES, thickness: 12 });

/**
 * A plane of how well operators are determined.
 * @param {HTMLElement} node
 * @param {number[]} levels
 * @param {(number|null)[][]} values
 * @param {string} unit
 */
export function classes(node, levels, values, unit) {
  const heat = { type: "heatmap", x: levels.map((_, n) => n), y: levels.map((_, n) => n), z: values, colorscale: SCALE, zmin: -0.5, zmax: 3.5, hoverongaps: false, xgap: 1, ygap: 1, colorbar: bar(node.clientWidth < 480) };
  return draw(node, [heat], { x: `α, falling: ${unit}`, y: `β, rising: ${unit}`, xaxis: ticks(levels), yaxis: ticks(levels), dragmode: false });
}

/**
 * @param {any} overview
 * @param {Set<number>} drawn
 * @param {number|null} file that is shown
 */
export async function show(overview, drawn, file = now.file) {
  now.file = file;
  const ids = [...drawn];
  if (now.fit === null || !drawn.has(now.fit) || !now.chosen) {
    now.fit = drawn.has(overview.best) ? overview.best : ids[ids.length - 1];
    now.chosen = false;
  }
  const fits = overview.fits.filter((/** @type {any} */ fit) => drawn.has(fit.id));
  const at = now.at?.[0] === now.file ? now.at : null;
  const there = /** @type {Record<string, boolean>} */ ({ states: Boolean(at) });
  there.errors = there.excitation = Boolean(fits.find((/** @type {any} */ fit) => fit.id === now.fit)?.confidence);
  const asked = there[now.kind] ?? true ? now.kind : "weights";
  const again = () => show(overview, drawn);
  const name = (/** @type {any} */ fit) => `fit ${overview.fits.indexOf(fit) + 1}`;
  fill(
    by("plane-tools"),
    el("label", {}, "Plane of ", el("select", { "data-key": "plane-fit", onchange: (/** @type {any} */ e) => (Object.assign(now, { fit: Number(e.target.value), chosen: true }), again()) }, ...fits.map((/** @type {any} */ fit) => el("option", { value: String(fit.id), selected: fit.id === now.fit }, name(fit))))),
    el("label", {}, "Show ", el("select", { "data-key": "plane-kind", onchange: (/** @type {any} */ e) => ((now.kind = e.target.value), again()) }, ...KINDS.map(([kind, text]) => el("option", { value: kind, selected: kind === asked, disabled: there[kind] === false }, text)))),
  );
  const seen = await ask("plane", { fit: now.fit, kind: asked, at }).catch(() => null);
  if (!seen) return;
  /** @type {any} */ (by("plane-tools").querySelector('[data-key="plane-kind"]')).value = seen.kind;
  const isClass = seen.kind === "excitation";
  const ends = isClass ? { zmin: -0.5, zmax: 3.5 } : seen.kind === "states" ? { zmin: 0, zmax: 1 } : { zmin: 0 };
  const scale = isClass ? SCALE : "Viridis";
  const axis = ticks(seen.levels);
  // Cell n, counted from 0, is drawn around n, and ends at n + 1 in the units of the staircase.
  const along = (/** @type {0|1} */ axis) => seen.staircase.map((/** @type {number[]} */ point) => point[axis] - 0.5);
  const stairs = (/** @type {string} */ color, /** @type {number} */ width) => ({ x: along(0), y: along(1), mode: "lines", line: { color, width }, hoverinfo: "skip", showlegend: false });
  await draw(by("plot-plane"), [{
    type: "heatmap", z: seen.values, customdata: seen.levels.map((/** @type {number} */ beta) => seen.levels.map((/** @type {number} */ alpha) => [shown(alpha), shown(beta)])), colorscale: scale, ...ends, hoverongaps: false, xgap: 1, ygap: 1,
    hovertemplate: `α %{customdata[0]}, β %{customdata[1]}${plain(unit(seen.unit))}: %{z:.4g}<extra></extra>`,
    colorbar: isClass ? bar(by("plot-plane").clientWidth < 480) : { title: { text: seen.of, side: "right" }, thickness: 12, exponentformat: "power" },
  }, ...(seen.staircase.length > 0 ? [stairs("#ffffff", 6), stairs("#d55e00", 3)] : [])], { x: `α, falling: ${seen.unit}`, y: `β, rising: ${seen.unit}`, xaxis: axis, yaxis: { ...axis }, dragmode: false });
  on(by("plot-plane"), "plotly_click", (event) => {
    const { x, y, z } = event.points[0];
    if (z !== null && !seen.left_out) follow(seen.levels, Number(x), Number(y));
  });
  by("plane-text").textContent = seen.sample
    ? `${now.followed?.number === seen.sample.number ? now.followed?.words : ""}The line is the staircase at ${which(seen.sample)}: its corners are the turning points that the model remembers. Below it operators are on, above it off. Click a cell for the next sample at which it switches.`
    : seen.left_out ? `There is no staircase: fit ${overview.fits.findIndex((/** @type {any} */ fit) => fit.id === now.fit) + 1} cannot be run on this file.`
    : "One cell for each operator, which switches on at β and off at α. Click a cell for the sample at which it switches, or a sample for its staircase.";
}
