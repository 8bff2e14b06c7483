// Fits: options with their meaning, work under way, the list.

import { ask } from "./api.js";
import { by, el, fill, shown } from "./dom.js";
import { colour } from "./plot.js";

const FIRST = ["levels", "smooth", "spacing", "start"];
/** Options that are one of a few words. */
const WORDS = /** @type {Record<string, string[]>} */ ({
  spacing: ["auto", "uniform"], start: ["auto", "off", "on", "rest", "unknown"], operator: ["mkp", "kp", "relay"], solver: ["nnls", "ols"],
  sign: ["", "positive", "negative"], robust: ["auto", "off"], load_law: ["auto", "shift", "weights"],
  dynamics: ["auto", "off", "lag", "ring"], thermal: ["", "first-order"],
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
    el("small", {}, "What takes no part in the fit and tests it. Usual: the files for validation, or the rows marked, or a fifth of the branches."),
  );
  const form = by("options");
  form.addEventListener("submit", (/** @type {Event} */ event) => (event.preventDefault(), begin(form)));
  fill(
    form,
    el("div", { class: "fields" }, ...options.filter(isFirst).map(field), held),
    el("details", {}, el("summary", {}, "All other options"), el("div", { class: "fields" }, ...options.filter((option) => !isFirst(option)).map(field))),
    el("div", { class: "row" }, el("button", { class: "first", type: "submit", id: "begin" }, "Fit"), el("span", { class: "quiet" }, "The defaults suit most recordings.")),
  );
}

/** @param {string} text */
const sentence = (text) => {
  const plain = text.replaceAll("`", "");
  return `${plain[0].toUpperCase()}${plain.slice(1)}.`;
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

/**
 * Shows the list of fits.
 * @param {import("./api.js").Overview} overview
 * @param {Set<number>} drawn
 * @param {() => void} draw
 * @param {(overview: any) => void} changed
 */
export function show(overview, drawn, draw, changed) {
  by("fit").hidden = overview.files.length === 0;
  if (!by("options").firstChild) build(overview.options);
  by("begin").disabled = !overview.files.some((file) => file.purpose === "fit" && !file.problem);
  if (overview.fits.length === 0) return fill(by("fits"));
  const error = (/** @type {number | null | undefined} */ percent) => (percent === null || percent === undefined ? "–" : `${shown(percent)} %`);
  const wins = (/** @type {import("./api.js").Fit} */ fit) => fit.held_out?.rivals.some((rival) => rival.rmse < (fit.held_out?.model.rmse ?? 0));
  const row = (/** @type {import("./api.js").Fit} */ fit, /** @type {number} */ place) => {
    const options = Object.entries(fit.options).map(([name, text]) => `${name} ${text}`).join(", ") || "defaults";
    const rival = fit.held_out?.rivals.reduce((a, b) => (a.rmse < b.rmse ? a : b));
    const grade = fit.verdict[0]?.[1].split(":")[0];
    const verdict = grade && el("details", {}, el("summary", { class: `grade ${grade.split(" ")[0]}` }, grade), el("dl", { class: "verdict" }, ...fit.verdict.flatMap(([heading, text]) => [el("dt", {}, heading), el("dd", {}, text)])));
    const toggle = (/** @type {any} */ event) => (event.target.checked ? drawn.add(fit.id) : drawn.delete(fit.id), draw());
    return el(
      "tr",
      { class: fit.id === overview.best ? "best" : null },
      el("td", {}, el("label", { style: "white-space:nowrap" }, el("input", { type: "checkbox", "data-key": `draw-${fit.id}`, checked: drawn.has(fit.id), onchange: toggle, "aria-label": `Draw fit ${place + 1}` }), " ", el("span", { class: "swatch", style: `border-color:${colour(place)}` }), `Fit ${place + 1}`), fit.id === overview.best && el("div", {}, el("span", { class: "badge", title: `By ${overview.best_by}` }, "best"))),
      el("td", {}, verdict || "–"),
      el("td", { class: "number" }, error(fit.held_out?.model.nrmse_percent), rival && el("div", { class: wins(fit) ? "worse" : "quiet" }, `${wins(fit) ? "worse than " : ""}${rival.name} ${error(rival.nrmse_percent)}`)),
      el("td", { class: "number" }, error(fit.nrmse_percent)),
      el("td", {}, options, el("div", { class: "quiet" }, `${fit.levels} levels`)),
      el("td", {}, fit.hold_out || "nothing"),
      el("td", {}, fit.advice.length === 0 ? "–" : el("details", {}, el("summary", {}, `${fit.advice.length} to know`), el("ul", { class: "notes" }, ...fit.advice.map((text) => el("li", {}, text))))),
      el("td", {}, el("button", { "aria-label": `Remove fit ${place + 1}`, onclick: () => ask("forget", { fit: fit.id }).then(changed, () => {}) }, "Remove")),
    );
  };
  fill(
    by("fits"),
    el("div", { class: "card scroll", style: "margin-top:1rem" },
      el("table", {},
        el("thead", {}, el("tr", {}, ...["Fit", "Verdict", "Error, held out", "Error, fitted", "Options", "Held out", "Advice", ""].map((text, n) => el("th", { scope: "col", class: n === 2 || n === 3 ? "number" : null }, text)))),
        el("tbody", {}, ...overview.fits.map(row)))),
    el("p", { class: "quiet" }, `Errors are RMSE in percent of the output's range. Below the error on what was held out stands that of the best simple predictor. Best is ${overview.best_by}.`),
  );
}
