// A path in a file: a column that the drive follows.

import { ask, open } from "./api.js";
import { el } from "./dom.js";

/** @type {{file: number|null, column: string|null}} */
const now = { file: null, column: null };

/** The column of a file that most likely is a path. @param {import("./api.js").File} file @param {import("./api.js").Fit} fit */
function likely(file, fit) {
  const names = file.columns.map(({ name }) => name);
  return names.find((name) => name === fit.output) ?? file.roles.output ?? names.find((name) => name !== file.roles.time) ?? names[0];
}

/**
 * @param {import("./api.js").Overview} overview
 * @param {import("./api.js").Fit} fit
 * @param {(what: object) => void} move
 * @param {(overview: any) => void} changed
 */
export function form(overview, fit, move, changed) {
  const again = () => changed(overview);
  if (!overview.files.some((file) => file.id === now.file)) {
    const file = overview.files.find(({ purpose }) => purpose === "path") ?? null;
    Object.assign(now, { file: file?.id ?? null, column: null });
  }
  const file = overview.files.find((file) => file.id === now.file);
  if (file && !file.columns.some(({ name }) => name === now.column)) now.column = likely(file, fit);
  const chosen = async (/** @type {any} */ event) => {
    const [given] = event.target.files;
    const found = await open(given).catch(() => null);
    if (!found) return;
    // One that was open already is its new version, and stays what it is for.
    const made = found.files.find((/** @type {any} */ one) => one.name === given.name);
    const isNew = made && !overview.files.some(({ id }) => id === made.id);
    Object.assign(now, { file: made?.id ?? null, column: null });
    changed(isNew ? (await ask("use", { file: made.id, purpose: "path" }).catch(() => null)) ?? found : found);
  };
  const select = (/** @type {"file"|"column"} */ what, /** @type {string} */ title, /** @type {[string|number, string][]} */ all) =>
    el("label", { class: "field" }, el("span", {}, title), el("select", { "data-key": `path-${what}`, onchange: (/** @type {any} */ e) => (Object.assign(now, what === "file" ? { file: Number(e.target.value) || null, column: null } : { column: e.target.value }), again()) }, ...all.map(([value, text]) => el("option", { value: String(value), selected: value === now[what] }, text))));
  const follow = (/** @type {"inputs"|"outputs"} */ of, /** @type {string} */ text, disabled = false) =>
    el("button", { type: "button", class: of === "outputs" && "first", "data-key": `path-${of}`, disabled, onclick: () => move({ file: now.file, column: now.column, of }) }, text);
  return el("div", {},
    el("h3", {}, "A path in a file"),
    el("div", { class: "row" }, el("label", { class: "button", for: "path-choose" }, "Open a file"), el("input", { id: "path-choose", type: "file", class: "unseen", onchange: chosen }), el("span", { class: "quiet" }, "A staircase, or any other path of the output: a table with a column for it.")),
    el("div", { class: "fields" },
      select("file", "File", [["", "choose one"], ...overview.files.map(({ id, name }) => /** @type {[number, string]} */ ([id, name]))]),
      file ? select("column", "Column", file.columns.map(({ name }) => [name, name])) : null),
    file ? el("div", { class: "row" },
      follow("outputs", "Follow as the output wanted", !fit.inverse),
      follow("inputs", "Follow as the input")) : null);
}
