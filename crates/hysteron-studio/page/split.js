// What is held out of the fits to come, to test them.

import { ask } from "./api.js";
import { by, el, fill } from "./dom.js";
import * as look from "./look.js";

/**
 * @param {import("./api.js").Overview} overview
 * @param {(overview: any) => void} changed
 */
export function show(overview, changed) {
  const files = overview.files.filter((file) => !file.problem);
  const send = (/** @type {string} */ request, /** @type {object} */ more) => ask(request, more).then(changed, () => {});
  const file = files.find((file) => look.isShown(file.id));
  const validated = files.filter((file) => file.purpose === "validate");
  const marked = files.filter((file) => file.purpose === "fit" && file.marked.length > 0);
  const held = [...validated.map((file) => `all of ${file.name}`), ...marked.map((file) => `${file.marked.length} ${file.marked.length === 1 ? "span" : "spans"} of ${file.name}`)];
  fill(
    by("split"),
    el("p", { class: "quiet" }, "A fit is worth what it says of data that it did not see."),
    el("p", {}, el("strong", {}, "The next fit is tested on "), held.length > 0 ? `${held.join(", ")}.` : "a fifth of the branches, where there are enough of them."),
    el("h3", {}, "Whole files"),
    ...files.map((file) => el("label", { class: "line" }, el("input", { type: "checkbox", "data-key": `hold-${file.id}`, checked: file.purpose === "validate", onchange: (/** @type {any} */ e) => send("use", { file: file.id, purpose: e.target.checked ? "validate" : "fit" }) }), " ", file.name)),
    file ? spans(file, send) : null,
  );
}

/**
 * The spans of the file that is shown.
 * @param {import("./api.js").File} file
 * @param {(request: string, more: object) => void} send
 */
function spans(file, send) {
  const remove = async (/** @type {number} */ n) => {
    const rest = file.marked.filter((_, other) => other !== n);
    // Marks are made one at a time; the last answer is drawn.
    for (const rows of [null, ...rest].slice(0, -1)) await ask("mark", { file: file.id, rows }).catch(() => {});
    send("mark", { file: file.id, rows: rest.at(-1) ?? null });
  };
  const submit = (/** @type {any} */ event) => {
    event.preventDefault();
    const form = new FormData(event.target);
    send("mark", { file: file.id, rows: [Number(form.get("first")), Number(form.get("last"))] });
  };
  const number = (/** @type {string} */ name, /** @type {string} */ text) =>
    el("label", { class: "field" }, el("span", {}, text), el("input", { name, type: "number", min: 1, max: file.samples, required: true, "data-key": `mark-${name}` }));
  return el("div", {},
    el("h3", {}, `Spans of ${file.name}`),
    file.purpose === "validate" && el("p", { class: "quiet" }, "All of this file is held out."),
    el("ul", { class: "plain" }, ...file.marked.map(([a, b], n) => el("li", {}, `samples ${a} to ${b} `, el("button", { class: "chip", "data-key": `unmark-${n}`, "aria-label": `Fit samples ${a} to ${b} again`, onclick: () => remove(n) }, "Remove the mark")))),
    el("button", { "data-key": "mark", "aria-pressed": String(look.isMarking()), onclick: () => look.marks() }, look.isMarking() ? "Drag over the output…" : file.marked.length > 0 ? "Mark another span" : "Mark a span"),
    el("form", { class: "row ends", onsubmit: submit }, number("first", "or from sample"), number("last", "to sample"), el("button", {}, "Mark")));
}
