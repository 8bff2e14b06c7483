// Fits: options with their meaning, work under way, the list.

import { ask } from "./api.js";
import { by, capital, el, fill, shown, unit, which } from "./dom.js";
import * as look from "./look.js";
import { colour } from "./plot.js";

const FIRST = ["levels", "smooth", "spacing", "start"];
/** Options that are one of a few words. */
const WORDS = /** @type {Record<string, string[]>} */ ({
  spacing: ["auto", "uniform"], start: ["auto", "off", "on", "rest", "unknown"], operator: ["mkp", "kp", "relay"], solver: ["nnls", "ols"],
  sign: ["", "positive", "negative"], robust: ["auto", "off"], load_law: ["auto", "shift", "weights"],
  dynamics: ["auto", "off", "lag", "ring"], thermal: ["", "first-order", "auto"],
});

/**
 * Builds the form once: its options come from the table of the library.
 * @param {import("./api.js").Option[]} options
 */
function build(options) {
  const field = (/** @type {import("./api.js").Option} */ option) => {
    const start = option.default.replaceAll("`", "");
    const words = WORDS[option.name];
    const control = words
      ? el("select", { name: option.name }, ...words.map((word) => el("option", { value: word === start ? "" : word }, word || start)))
      : el("input", { name: option.name, type: "text", placeholder: start, autocomplete: "off", inputmode: option.name === "levels" ? "numeric" : null });
    return el("label", { class: "field" }, el("span", {}, option.name.replaceAll("_", " ")), control, el("small", {}, `${sentence(option.purpose)} May be: ${option.range.replaceAll("`", "")}.`));
  };
  const isFirst = (/** @type {import("./api.js").Option} */ option) => FIRST.includes(option.name);
  const held = el(
    "label",
    { class: "field" },
    el("span", {}, "hold-out"),
    el("select", { name: "hold_out" }, el("option", { value: "usual" }, "usual"), el("option", { value: "branches:33%" }, "branches:33%"), el("option", { value: "nothing" }, "nothing")),
    el("small", {}, "What takes no part in the fit and tests it. Usual: what “Split” says."),
  );
  const form = by("options");
  form.addEventListener("submit", (/** @type {Event} */ event) => (event.preventDefault(), begin(form)));
  by("fit-now").addEventListener("click", () => begin(form));
  fill(
    form,
    el("div", { class: "row" }, el("button", { class: "first", type: "submit", id: "begin" }, "Fit"), el("span", { class: "quiet" }, "The defaults suit most recordings.")),
    el("div", { class: "fields" }, ...options.filter(isFirst).map(field), held),
    el("details", {}, el("summary", {}, "All other options"), el("div", { class: "fields" }, ...options.filter((option) => !isFirst(option)).map(field))),
  );
}

/** @param {string} text */
const sentence = (text) => {
  const plain = text.replaceAll("`", "");
  return `${capital(plain)}.`;
};

/** @param {HTMLFormElement} form */
function begin(form) {
  /** @type {Record<string, string>} */
  const options = {};
  for (const [name, value] of new FormData(form)) if (name !== "hold_out" && String(value).trim()) options[name] = String(value).trim();
  const held = String(new FormData(form).get("hold_out"));
  ask("fit", { options, hold_out: held === "usual" || held === "nothing" ? held : { words: held } }).catch(() => {});
}

/** @type {Map<number, {stage: string, since: number, from: number}>} */
const seen = new Map();

/**
 * Shows work under way.
 * @param {import("./api.js").JobView[]} jobs
 */
export function working(jobs) {
  for (const id of seen.keys()) if (!jobs.some((job) => job.id === id)) seen.delete(id);
  fill(by("jobs"), ...jobs.map((job) => {
    const known = seen.get(job.id);
    if (!known || known.stage !== job.stage) seen.set(job.id, { stage: job.stage, since: Date.now(), from: job.share ?? 0 });
    const { since, from } = /** @type {any} */ (seen.get(job.id));
    const way = (job.share ?? 0) - from;
    const left = way > 0.02 ? ((1 - (job.share ?? 0)) * (Date.now() - since)) / way / 1000 : null;
    return el(
      "div",
      { class: "card" },
      el("div", { class: "head" }, el("strong", {}, job.stage ? `Fitting: ${job.stage}` : "Fitting"), el("span", { class: "quiet" }, left !== null && `about ${Math.max(1, Math.round(left))} s of this step left`)),
      el("progress", { max: 1, value: job.share ?? undefined, "aria-label": "Progress of the fit" }),
      el("button", { "data-key": `cancel-${job.id}`, onclick: () => ask("cancel", { job: job.id }).catch(() => {}) }, "Cancel"),
    );
  }));
}

/** Verdicts that were opened or closed, by fit. @type {Map<number, boolean>} */
const told = new Map();

/** The card has these otherwise. */
const NUMBERS = new Set(["verdict", "error", "inverse", "worst"]);

/** The worst samples that were shown, in words, by fit. @type {{of: any, words: Map<number, string>}} */
const worsts = { of: null, words: new Map() };

/**
 * Shows the list of fits.
 * @param {import("./api.js").Overview} overview
 * @param {Set<number>} drawn
 * @param {() => void} draw
 * @param {(overview: any) => void} changed
 */
export function show(overview, drawn, draw, changed) {
  by("found").hidden = overview.files.length === 0;
  if (!by("options").firstChild) build(overview.options);
  const nothing = !overview.files.some((file) => file.purpose === "fit" && !file.problem);
  for (const id of ["begin", "fit-now"]) by(id).disabled = nothing;
  by("fit-now").textContent = overview.fits.length > 0 ? "Fit again" : "Fit";
  if (overview.fits.length === 0) return fill(by("fits"), nothing ? null : el("p", { class: "quiet" }, "None yet. The defaults suit most recordings; “Fit” above has the options."));
  if (worsts.of !== overview) Object.assign(worsts, { of: overview, words: new Map() });
  const last = overview.fits.length - 1;
  fill(
    by("fits"),
    ...overview.fits.map((fit, place) => card(overview, fit, place, { isOpen: told.get(fit.id) ?? (place === last || fit.id === overview.best), drawn, draw, changed })).reverse(),
    el("p", { class: "quiet" }, `Errors are RMSE, in percent of the range. Best is ${overview.best_by}.`),
  );
}

/**
 * @param {import("./api.js").Overview} overview
 * @param {import("./api.js").Fit} fit
 * @param {number} place in the list
 * @param {{isOpen: boolean, drawn: Set<number>, draw: () => void, changed: (overview: any) => void}} how
 */
function card(overview, fit, place, { isOpen, drawn, draw, changed }) {
  // Of one there is no best.
  const best = fit.id === overview.best && overview.fits.length > 1;
  const rival = fit.held_out?.rivals.reduce((a, b) => (a.rmse < b.rmse ? a : b));
  const wins = rival && rival.rmse < (fit.held_out?.model.rmse ?? 0);
  const options = Object.entries(fit.options).filter(([name]) => name !== "levels").map(([name, text]) => `${name} ${text}`).join(", ") || "defaults";
  const [grade, meaning] = (fit.verdict[0]?.[1] ?? "").split(": ");
  const toggle = (/** @type {any} */ event) => (event.target.checked ? drawn.add(fit.id) : drawn.delete(fit.id), draw());
  const error = (/** @type {string} */ name, /** @type {{rmse: number, nrmse_percent: number|null} | null | undefined} */ errors, /** @type {string} */ of, kind = "") =>
    errors && el("tr", { class: kind }, el("th", { scope: "row" }, name), el("td", {}, errors.nrmse_percent === null ? "–" : `${shown(errors.nrmse_percent)} %`), el("td", {}, `${shown(errors.rmse)}${unit(of)}`));
  return el(
    "article",
    { class: best ? "card best" : "card", "aria-label": `Fit ${place + 1}` },
    el("div", { class: "head" },
      el("label", {}, el("input", { type: "checkbox", "data-key": `draw-${fit.id}`, checked: drawn.has(fit.id), onchange: toggle, "aria-label": `Draw fit ${place + 1}` }), el("span", { class: "swatch", style: `border-color:${colour(place)}` }), el("strong", {}, `Fit ${place + 1}`)),
      best && el("span", { class: "badge", title: `By ${overview.best_by}` }, "best"),
      grade && el("span", { class: `grade ${grade.split(" ")[0]}` }, grade),
      el("button", { class: "plain", "aria-label": `Remove fit ${place + 1}`, title: "Remove", onclick: () => ask("forget", { fit: fit.id }).then(changed, () => {}) }, "✕")),
    stale(overview, fit, changed),
    meaning && el("p", {}, `${capital(meaning)}.`),
    el("table", { class: "errors" }, el("tbody", {},
      error("held out", fit.held_out?.model, fit.output),
      rival && error(wins ? `${rival.name} is better` : rival.name, rival, fit.output, wins ? "worse" : "quiet"),
      error("fitted", fit, fit.output),
      error("inverse, of the input", fit.inverse_errors, fit.input))),
    ...fit.late.map((words) => el("p", {}, `Found: ${words}.`)),
    !fit.inverse && el("p", { class: "warn" }, "It has weights below zero, and so no inverse."),
    ...fit.advice.map((text) => el("p", { class: "warn" }, text)),
    el("details", { open: isOpen, ontoggle: (/** @type {any} */ e) => told.set(fit.id, e.target.open) },
      el("summary", {}, "Why, and what next"),
      el("dl", { class: "verdict" }, ...fit.verdict.filter(([heading]) => !NUMBERS.has(heading)).flatMap(([heading, text]) => [el("dt", {}, heading), el("dd", {}, text)])),
      el("p", { class: "quiet" }, `${fit.levels} levels, ${options}. Held out: ${fit.hold_out.replace("files", "other files").replace("rows:", "samples ") || "nothing"}.`)),
    el("button", { class: "chip", "data-key": `worst-${fit.id}`, onclick: () => worst(overview, fit) }, "Show the worst sample"),
    el("p", { class: "quiet", role: "status", "data-worst": fit.id }, worsts.words.get(fit.id) ?? ""),
  );
}

/**
 * Says that files have changed since a fit, and offers its errors anew.
 * @param {import("./api.js").Overview} overview
 * @param {import("./api.js").Fit} fit
 * @param {(overview: any) => void} changed
 */
function stale(overview, fit, changed) {
  if (fit.changed.length === 0) return null;
  const names = overview.files.filter((file) => fit.changed.includes(file.id)).map((file) => file.name);
  const anew = async () => {
    // Fits are compared where they had the same test.
    for (const { id } of overview.fits.filter((fit) => fit.can_be_judged_anew)) await ask("judge_anew", { fit: id }).catch(() => {});
    changed(await ask("overview"));
  };
  return el("div", { class: "warn" },
    el("p", {}, `${names.join(", ")} ${names.length === 1 ? "has" : "have"} changed since: the errors are of before.${fit.can_be_judged_anew ? "" : " “Fit again” makes a fit to what it is now."}`),
    fit.can_be_judged_anew && el("button", { "data-key": `anew-${fit.id}`, onclick: anew }, "Compute the errors anew"));
}

/** Points at the sample with the largest residual. @param {import("./api.js").Overview} overview @param {import("./api.js").Fit} fit */
async function worst(overview, fit) {
  const found = await ask("worst", { fit: fit.id }).catch(() => null);
  if (!found) return;
  const file = overview.files.find(({ id }) => id === found.file);
  const { output, modelled } = found.sample;
  const words = `${file?.name}, ${which(found.sample)}: off by ${shown(modelled[0]?.[1] - output)}${unit(fit.output)}.`;
  worsts.words.set(fit.id, words);
  await look.point(found.file, found.sample.time);
  const place = document.querySelector(`[data-worst="${fit.id}"]`);
  if (place) place.textContent = words;
}
