// Files: what was found in them, and what each column is.

import { ask, open } from "./api.js";
import { by, el, fill, shown } from "./dom.js";
import * as look from "./look.js";
import * as task from "./task.js";
import { each } from "./alike.js";

const ROLES = [["", "not used"], ["input", "input"], ["output", "output"], ["time", "time"], ["load", "load"]];
const PURPOSES = [["fit", "to fit"], ["validate", "for validation"], ["look", "only to look at"], ["path", "a path for “Drive”"]];
/** More columns than these are folded away, but for those that are used. */
const FEW = 5;

/**
 * Listens to what is dropped and chosen.
 * @param {(overview: import("./api.js").Overview) => void} opened
 */
export function start(opened) {
  /** @param {Iterable<File>} files */
  const all = async (files) => {
    by("drop").setAttribute("aria-busy", "true");
    try {
      for (const file of files) opened(await open(file));
    } finally {
      by("drop").removeAttribute("aria-busy");
    }
  };
  by("choose").addEventListener("change", (/** @type {any} */ event) => all([...event.target.files]).finally(() => (event.target.value = "")));
  const over = (/** @type {boolean} */ is) => by("drop").classList.toggle("over", is);
  addEventListener("dragover", (event) => (event.preventDefault(), over(true)));
  addEventListener("dragleave", () => over(false));
  addEventListener("drop", (event) => {
    event.preventDefault();
    over(false);
    all([...(event.dataTransfer?.files ?? [])]);
  });
}

/**
 * Shows the files.
 * @param {import("./api.js").Overview} overview
 * @param {(overview: any) => void} changed
 */
export function show(overview, changed) {
  by("drop").classList.toggle("empty", overview.files.length === 0);
  fill(by("files"), ...overview.files.map((file) => card(file, overview, changed)));
}

/**
 * @param {import("./api.js").File} file
 * @param {import("./api.js").Overview} overview
 * @param {(overview: any) => void} changed
 */
function card(file, overview, changed) {
  const send = (/** @type {string} */ request, more = {}) => ask(request, { file: file.id, ...more }).then(changed, () => {});
  const purpose = el(
    "select",
    { "data-key": `purpose-${file.id}`, "aria-label": `What ${file.name} is for`, onchange: (/** @type {any} */ e) => send("use", { purpose: e.target.value }) },
    ...PURPOSES.map(([value, text]) => el("option", { value, selected: value === file.purpose }, text)),
  );
  const facts = file.problem ? `${file.rows} rows` : `${file.samples} samples, ${file.branches} ${file.branches === 1 ? "branch" : "branches"}`;
  const isShown = !file.problem && look.isShown(file.id);
  const name = file.problem ? file.name : el("button", { class: "plain", "data-key": `show-${file.id}`, "aria-pressed": String(isShown), title: "Show this file in the pictures", onclick: () => look.choose(file.id) }, file.name);
  const isUsed = (/** @type {import("./api.js").Column} */ column) => Object.values(file.roles).includes(column.name);
  // A path need not be a recording.
  const isPath = file.purpose === "path" && file.problem !== null;
  const toRepair = overview.files.filter((other) => other.repair && other.purpose !== "path");
  const first = file.columns.filter((column, n) => file.columns.length <= FEW || isUsed(column) || (file.doubts.length > 0 && n < FEW));
  const others = file.columns.filter((column) => !first.includes(column));
  return el(
    "article",
    { class: isShown ? "card shown" : "card", "aria-label": file.name },
    el("div", { class: "head" }, el("h3", {}, name), el("button", { class: "plain", "aria-label": `Close ${file.name}`, title: "Close", onclick: () => send("close") }, "✕")),
    el("div", { class: "quiet" }, facts, file.steps && ", prepared"),
    el("div", { class: "columns" }, ...first.map((column) => columnRow(file, column, send))),
    others.length > 0 && el("details", {}, el("summary", { class: "quiet" }, `${others.length} more ${others.length === 1 ? "column" : "columns"}`), el("div", { class: "columns" }, ...others.map((column) => columnRow(file, column, send)))),
    ...(isPath ? [] : file.doubts.map((doubt) => question(file, doubt, send))),
    file.problem && !isPath &&
      el("p", { class: "problem" }, file.problem.problem, file.problem.remedy && `. What helps: ${file.problem.remedy}.`),
    file.repair && !isPath && el("div", {}, el("p", {}, `After “Repair rows” ${file.repair.samples} samples are left of ${file.rows} rows:`), el("ul", { class: "notes" }, ...file.repair.notes.map((note) => el("li", {}, note))), el("div", { class: "row" }, el("button", { class: "first", "data-key": `repair-${file.id}`, onclick: () => send("mend", { on: true }) }, "Repair rows"),
      toRepair.length > 1 && el("button", { "data-key": `repair-all-${file.id}`, onclick: () => each(toRepair, "mend", { on: true }).then(changed) }, `Repair ${toRepair.length === 2 ? "both" : `all ${toRepair.length}`} files`))),
    file.notes.length > 0 && el("ul", { class: "notes" }, ...file.notes.map((note) => el("li", {}, note))),
    segments(file),
    el("details", {}, el("summary", { class: "quiet" }, "Why these columns?"), el("ul", { class: "notes quiet" }, ...file.reasons.map((reason) => el("li", {}, reason)))),
    el(
      "div",
      { class: "row" },
      el("label", {}, "This file is ", purpose),
      file.mend && el("label", {}, el("input", { type: "checkbox", "data-key": `mend-${file.id}`, checked: file.mend, onchange: (/** @type {any} */ e) => send("mend", { on: e.target.checked }) }), " Repair rows"),
      file.marked.length > 0 && el("button", { class: "chip", "data-key": `marked-${file.id}`, onclick: () => task.show("split") }, `${file.marked.length} ${file.marked.length === 1 ? "span" : "spans"} held out`),
    ),
  );
}

/** The recordings of a file with several, each a button that shows it. @param {import("./api.js").File} file */
function segments(file) {
  if (file.begins.length < 2) return null;
  const end = (/** @type {number} */ n) => (file.begins[n + 1] ?? file.samples + 1) - 1;
  const one = (/** @type {number} */ begin, /** @type {number} */ n) =>
    el("button", { class: "chip", "data-key": `segment-${file.id}-${n}`, title: `Samples ${begin} to ${end(n)}`, "aria-label": `Show recording ${n + 1}, samples ${begin} to ${end(n)}`, onclick: () => look.choose(file.id, file.spans[n]) }, String(n + 1));
  const all = file.begins.map(one);
  return el("div", { class: "row segments", role: "group", "aria-label": `Recordings of ${file.name}` }, el("span", { class: "quiet" }, `${all.length} recordings:`), ...all.slice(0, 24), all.length > 24 && el("span", { class: "quiet" }, "…"));
}

/**
 * Asks which column has a role that cannot be told.
 * @param {import("./api.js").File} file
 * @param {{role: string, candidates: [string, string][]}} doubt
 * @param {(request: string, more?: object) => void} send
 */
function question(file, { role, candidates }, send) {
  const choose = (/** @type {string} */ name) => send("columns", { roles: { ...file.roles, [role]: name } });
  return el(
    "div",
    { class: "row question", role: "group", "aria-label": `The ${role} of ${file.name}` },
    el("strong", {}, candidates.length > 0 ? `Which column is the ${role}?` : `No column looks like the ${role}: choose one above.`),
    ...candidates.map(([name, why]) => el("button", { "data-key": `doubt-${file.id}-${role}-${name}`, title: why, onclick: () => choose(name) }, name)),
  );
}

/**
 * @param {import("./api.js").File} file
 * @param {import("./api.js").Column} column
 * @param {(request: string, more?: object) => void} send
 */
function columnRow(file, column, send) {
  const roles = /** @type {any} */ (file.roles);
  const role = ["input", "output", "time", "load"].find((name) => roles[name] === column.name) ?? "";
  const choose = (/** @type {string} */ chosen) => {
    const next = { ...roles };
    for (const name of Object.keys(next)) if (next[name] === column.name) next[name] = null;
    // The column that had this role takes the one that is free now.
    if (chosen) {
      if (role && next[chosen]) next[role] = next[chosen];
      next[chosen] = column.name;
    }
    send("columns", { roles: next });
  };
  return el(
    "div",
    { class: role ? "column used" : "column" },
    picture(column),
    el("div", {}, el("strong", {}, column.name), el("div", { class: "quiet" }, `${shown(column.min)} to ${shown(column.max)}`, column.not_numbers > 0 && `, ${column.not_numbers} not numbers`)),
    el(
      "select",
      { "data-key": `role-${file.id}-${column.name}`, "aria-label": `What ${column.name} is`, onchange: (/** @type {any} */ e) => choose(e.target.value) },
      ...ROLES.map(([value, text]) => el("option", { value, selected: value === role }, text)),
    ),
  );
}

/** @param {import("./api.js").Column} column */
function picture(column) {
  const ns = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(ns, "svg");
  svg.setAttribute("viewBox", `0 0 ${Math.max(1, column.picture.length - 1)} 40`);
  svg.setAttribute("preserveAspectRatio", "none");
  svg.setAttribute("aria-hidden", "true");
  const [min, max] = [column.min ?? 0, column.max ?? 0];
  const y = (/** @type {number} */ value) => (max > min ? 38 - (36 * (value - min)) / (max - min) : 20);
  let path = "";
  let pen = "M";
  column.picture.forEach((part, n) => {
    if (!part) return void (pen = "M");
    path += `${pen}${n} ${y(part[0]).toFixed(1)}L${n} ${y(part[1]).toFixed(1)}`;
    pen = "L";
  });
  const line = document.createElementNS(ns, "path");
  line.setAttribute("d", path);
  line.setAttribute("fill", "none");
  line.setAttribute("stroke", "currentColor");
  line.setAttribute("stroke-width", "1.5");
  line.setAttribute("vector-effect", "non-scaling-stroke");
  svg.append(line);
  return /** @type {any} */ (svg);
}
