// A model driven by hand: move the input, or pull the output and let the inverse answer.

import { ask, take } from "./api.js";
import { by, el, fill, save, shown, unit } from "./dom.js";
import { draw, ink, stroke } from "./plot.js";
import * as hand from "./hand.js";
import * as path from "./path.js";
import { isOpen } from "./task.js";

const STATUS = /** @type {Record<string, string>} */ ({ ok: "reached", low: "below every output of the model", high: "above every output of the model", passed: "inside a jump of the model", limited: "not in this time step: the drive is at its end" });

/** Until the user chooses a fit or moves one, it is the best. @type {{fit: number|null, chosen: boolean, loop: any, view: any, policy: string, waiting: object|null, busy: boolean, names: any}} */
const now = { fit: null, chosen: false, loop: null, view: null, policy: "hold", waiting: null, busy: false, names: null };

/** @type {(overview: any) => void} */
let changed = () => {};

/** What the form is built for. @param {import("./api.js").Overview} overview */
const names = ({ fits, files }) => JSON.stringify([fits.length, files.map(({ id, name, purpose, columns }) => [id, name, purpose, columns.length])]);

/** @param {import("./api.js").Overview} overview @param {(overview: any) => void} tell */
export async function show(overview, tell) {
  changed = tell;
  if (overview.fits.length === 0) return void (now.fit = null);
  if (!isOpen("drive")) return;
  const gone = !overview.fits.some((fit) => fit.id === now.fit);
  if (gone || (!now.chosen && now.fit !== overview.best)) {
    now.chosen = false;
    now.fit = overview.best ?? overview.fits[0].id;
    await begin(overview);
  } else if (now.names !== names(overview)) await build(overview);
  // The colours of the page may have changed.
  else if (now.view) await answer(null);
}

/** @param {import("./api.js").Overview} overview */
async function begin(overview) {
  now.view = await ask("drive", { fit: now.fit }).catch(() => null);
  const fit = overview.fits.find((fit) => fit.id === now.fit);
  const file = fit?.files.find((id) => overview.files.some((file) => file.id === id && !file.problem));
  const loop = file === undefined ? null : await ask("curves", { file, picture: "loop", pixels: [600, 440] }).catch(() => null);
  now.loop = loop?.lines[0] ?? null;
  if (now.view) await build(overview);
}

/** @param {import("./api.js").Overview} overview */
async function build(overview) {
  now.names = names(overview);
  const fit = overview.fits.find((fit) => fit.id === now.fit);
  if (!fit || !now.view) return;
  const slider = (/** @type {"input"|"output"} */ what, /** @type {string} */ text, /** @type {[number, number]} */ [low, high]) => {
    const disabled = what === "output" && !fit.inverse;
    const send = (/** @type {any} */ event) => event.target.value !== "" && move({ [what]: Number(event.target.value) });
    return el("div", { class: "field" },
      el("label", { for: `drive-${what}` }, el("strong", {}, text)),
      el("div", { class: "slider" },
        el("input", { id: `drive-${what}`, type: "range", min: low, max: high, step: "any", value: String(now.view[what]), disabled, oninput: send }),
        el("input", { id: `drive-${what}-number`, type: "number", step: "any", disabled, "aria-label": `${text}, as a number`, onchange: send })),
      el("small", { id: `value-${what}` }));
  };
  const number = (/** @type {"dt"|"load"} */ what, /** @type {string} */ text) =>
    now.view[what] === null ? null : el("label", { class: "field" }, el("span", {}, text), el("input", { type: "number", step: "any", id: `drive-${what}`, value: String(now.view[what]) }));
  fill(
    by("drive"),
    el("div", { class: "row" },
      el("label", {}, "Model ", el("select", { "data-key": "drive-fit", onchange: (/** @type {any} */ e) => (Object.assign(now, { fit: Number(e.target.value), chosen: true }), begin(overview)) }, ...overview.fits.map((fit, n) => el("option", { value: String(fit.id), selected: fit.id === now.fit }, `fit ${n + 1}`)))),
      el("button", { "data-key": "drive-again", onclick: () => begin(overview) }, "Start again")),
    slider("input", `Input: ${fit.input}`, now.view.inputs),
    slider("output", `Output wanted: ${fit.output}`, now.view.outputs),
    el("p", { id: "drive-status", role: "status" }),
    fit.inverse
      ? el("label", { class: "field" }, el("span", {}, "When the output reverses"), el("select", { "data-key": "policy", onchange: (/** @type {any} */ e) => (now.policy = e.target.value) },
          el("option", { value: "hold", selected: now.policy === "hold" }, "hold: the input stays until the output has to move"),
          el("option", { value: "anticipate", selected: now.policy === "anticipate" }, "anticipate: cross the dead band at once")))
      : el("p", { class: "problem" }, "This model has weights below zero, and so no inverse. Move the input."),
    hand.form(fit.inverse, (what) => move(what), () => now.view),
    path.form(overview, fit, (what) => move(what), (found) => (found === overview ? build(overview) : changed(found))),
    el("p", { id: "drive-path", role: "status" }),
    el("button", { id: "drive-way", "data-key": "drive-way", hidden: true, onclick: () => take({ what: "way", drive: now.view.drive }).then(save, () => {}) }, "What came of the path (CSV)"),
    number("dt", "Time step [s]"), number("load", "Load"),
  );
  await answer(fit);
}

/** Sends the latest move only: a hand is faster than any answer. @param {object} what */
async function move(what) {
  const isPath = (/** @type {object} */ what) => ["inputs", "outputs", "file"].some((name) => name in what);
  if (!isPath(what) && now.waiting && isPath(now.waiting)) return;
  now.waiting = what;
  now.chosen = true;
  if (now.busy) return;
  now.busy = true;
  while (now.waiting) {
    const next = now.waiting;
    now.waiting = null;
    const value = (/** @type {string} */ id) => { const node = /** @type {any} */ (document.getElementById(id)); return node ? Number(node.value) : null; };
    const view = await ask("file" in next ? "follow" : "pull", { drive: now.view.drive, policy: now.policy, dt: value("drive-dt"), load: value("drive-load"), ...next }).catch(() => null);
    if (view) {
      now.view = view;
      await answer(null);
    }
  }
  now.busy = false;
}

/** What came of a path, in words. @param {{of: string, samples: number, missed: [string, number][]}} followed */
function came({ of, samples, missed }) {
  if (of === "inputs") return `${samples} inputs were followed.`;
  const none = missed.reduce((sum, [, n]) => sum + n, 0);
  const why = missed.map(([status, n]) => `${n} ${STATUS[status]}`).join(", ");
  return none ? `Of ${samples} outputs wanted ${samples - none} were reached. The others: ${why}.` : `All ${samples} outputs wanted were reached.`;
}

/** @type {any} */
let known = null;

/** @param {any} fit */
async function answer(fit) {
  known = fit ?? known;
  const { input, output, wanted, status, rival, moves, dead_band: band, trail, inputs, outputs, followed } = now.view;
  const active = document.activeElement?.id;
  for (const [id, value] of [["drive-input", input], ["drive-output", output]]) {
    if (active !== id) by(id).value = String(value);
    if (active !== `${id}-number`) by(`${id}-number`).value = shown(value);
  }
  const [of, to] = [unit(known?.input), unit(known?.output)];
  by("value-input").textContent = `at ${shown(input)}${of}`;
  by("value-output").textContent = `reached: ${shown(output)}${to}`;
  const parts = [];
  if (wanted !== null) parts.push(`Wanted ${shown(wanted)}${to}: ${STATUS[status] ?? status}.`);
  if (rival) parts.push(`Input with “${now.policy}”: ${shown(input)}${of}, with “${rival.policy}”: ${shown(rival.input)}${of}.`);
  if (band) parts.push(`Dead band: ${shown(band[0])} to ${shown(band[1])}${of}.`);
  by("drive-way").hidden = !followed;
  by("drive-path").textContent = followed ? came(followed) : "";
  by("drive-status").textContent = parts.join(" ") || "Move a slider: with the mouse, or with the arrow keys.";
  const traces = [
    ...(now.loop ? [{ x: now.loop.x, y: now.loop.y, mode: "lines", name: "measured", line: { ...stroke(null), width: 1 }, opacity: 0.45, showlegend: false, hoverinfo: "skip" }] : []),
    { x: trail.map((/** @type {number[]} */ p) => p[0]), y: trail.map((/** @type {number[]} */ p) => p[1]), mode: "lines", name: "way", line: stroke(0), showlegend: false, hoverinfo: "skip" },
    ...(rival ? [{ x: rival.trail.map((/** @type {number[]} */ p) => p[0]), y: rival.trail.map((/** @type {number[]} */ p) => p[1]), mode: "lines", name: rival.policy, line: stroke(1), showlegend: false, hoverinfo: "skip" }] : []),
    ...(band ? [{ x: band, y: [output, output], mode: "lines", name: "dead band", line: { color: "#e69f00", width: 7 }, opacity: 0.75, showlegend: false }] : []),
    { x: [input], y: [output], mode: "markers", name: "now", marker: { size: 13, color: "#d55e00", line: { color: ink("card"), width: 2 } }, showlegend: false },
  ];
  const wide = (/** @type {[number, number]} */ [low, high]) => { const more = 0.07 * (high - low); return [low - more, high + more]; };
  await draw(by("plot-drive"), traces, { x: known?.input ?? "input", y: known?.output ?? "output", xaxis: { range: wide(inputs) }, yaxis: { range: wide(outputs) }, dragmode: false });
  hand.drags(by("plot-drive"), Boolean(known?.inverse), (what) => move(what));
  by("figure-moves").hidden = by("plot-moves").hidden = moves.length === 0;
  const line = (/** @type {number} */ place, /** @type {string} */ name) => ({ x: moves.map((/** @type {number[]} */ _, /** @type {number} */ n) => n + 1), y: moves.map((/** @type {number[]} */ move) => move[place]), mode: "lines", name, line: stroke(place - 1) });
  if (moves.length > 0) await draw(by("plot-moves"), [line(1, "hold"), line(2, "anticipate")], { x: "move", y: known?.input ?? "input" });
}
