// What can be taken home.

import { take } from "./api.js";
import { by, el, fill, save } from "./dom.js";
import { pictures, shownViews } from "./look.js";
import { zip } from "./zip.js";

/** Until the user chooses a fit, it is the best. @type {{fit: number|null, chosen: boolean, file: number|null, language: string, seen: string}} */
const now = { fit: null, chosen: false, file: null, language: "command", seen: "" };

/** @param {import("./api.js").Overview} overview */
export async function show(overview) {
  const files = overview.files.filter((file) => !file.problem);
  if (files.length === 0) return;
  if (!now.chosen || !overview.fits.some((fit) => fit.id === now.fit)) now.fit = overview.best;
  if (!files.some((file) => file.id === now.file)) now.file = files[0].id;
  const fit = overview.fits.find((fit) => fit.id === now.fit);
  const get = (/** @type {string} */ text, /** @type {object} */ what) => el("button", { "data-key": text, onclick: () => take(what).then(save, () => {}) }, text);
  const choose = (/** @type {"fit"|"file"} */ what, /** @type {[number, string][]} */ all) =>
    el("select", { "data-key": `home-${what}`, onchange: (/** @type {any} */ e) => ((now[what] = Number(e.target.value)), (now.chosen ||= what === "fit"), show(overview)) }, ...all.map(([id, text]) => el("option", { value: String(id), selected: id === now[what] }, text)));
  const archive = async () => {
    const { views, bands } = shownViews();
    const files = await pictures();
    for (const [band, id] of bands) {
      if (by(id).closest("[hidden]")) continue;
      const numbers = await take({ what: "csv", ...views(band) }).catch(() => null);
      if (numbers) files.push({ name: `${id.slice(5)}.csv`, bytes: new Uint8Array(await numbers.blob.arrayBuffer()) });
    }
    save({ name: "pictures.zip", blob: zip(files) });
  };
  const samples = (/** @type {string} */ what) => take({ what, ...shownViews().views("output") }).then(save, () => {});
  const code = el("pre", { tabindex: 0, role: "group", "aria-label": "What was clicked, as text" });
  const language = (/** @type {string} */ what, /** @type {string} */ text) =>
    el("button", { "data-key": `as-${what}`, "aria-pressed": String(now.language === what), onclick: () => ((now.language = what), show(overview)) }, text);
  fill(
    by("home"),
    fit ? el("div", {},
      el("h3", {}, "The model"),
      el("div", { class: "row" },
        el("label", {}, "Model ", choose("fit", overview.fits.map((fit, n) => [fit.id, `fit ${n + 1}${fit.id === overview.best ? " (best)" : ""}`]))),
        get("Model (JSON)", { what: "model", fit: fit.id }),
        get("C (ZIP)", { what: "c", fit: fit.id }),
        get("FMU", { what: "fmu", fit: fit.id }),
        fit.inverse ? get("Inverse as FMU", { what: "fmu", fit: fit.id, inverse: true }) : null),
      el("h3", {}, "The report"),
      el("div", { class: "row" },
        el("label", {}, "On ", choose("file", files.map((file) => [file.id, file.name]))),
        get("Report (HTML)", { what: "report", fit: fit.id, file: now.file }))) : null,
    el("h3", {}, "What is shown"),
    el("div", { class: "row" },
      el("button", { id: "take-pictures", title: "Each picture as SVG, PNG and CSV", onclick: archive }, "Pictures and numbers (ZIP)"),
      el("button", { id: "take-csv", onclick: () => samples("table") }, "All samples shown (CSV)"),
      el("button", { id: "take-parquet", onclick: () => samples("parquet") }, "All samples shown (Parquet)")),
    el("h3", {}, "The session"),
    el("div", { class: "row" }, get("Session", { what: "session" }), el("span", { class: "quiet" }, "It holds recordings and fits. Drop it here to go on.")),
    fit ? el("div", {},
      el("h3", {}, "The same without clicking"),
      el("div", { class: "row" }, language("command", "Command line"), language("python", "Python"), language("rust", "Rust"),
        el("button", { onclick: (/** @type {any} */ event) => navigator.clipboard?.writeText(now.seen).then(() => (event.target.textContent = "Copied")) }, "Copy")),
      code) : null,
  );
  if (fit) {
    const file = await take({ what: now.language, fit: fit.id }).catch(() => null);
    if (file) code.textContent = now.seen = file.text();
  }
}
