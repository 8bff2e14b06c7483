// The page: shows what the session has, whenever it changes.

import { about, anew, ask, listen, reload, whenRefused } from "./api.js";
import { by, el, fill } from "./dom.js";
import * as opening from "./open.js";
import * as preparing from "./prepare.js";
import * as splitting from "./split.js";
import * as fitting from "./fit.js";
import * as looking from "./look.js";
import * as driving from "./drive.js";
import * as designing from "./design.js";
import * as home from "./home.js";
import * as task from "./task.js";
import * as theme from "./theme.js";

/** The fits that are drawn. @type {Set<number>} */
const drawn = new Set();
/** The fits that were seen before: a new one is drawn. @type {Set<number>} */
const known = new Set();
/** @type {import("./api.js").Overview | null} */
let overview = null;
/** What is shown, as text. */
let seen = "";

/** @param {import("./api.js").Overview} found */
async function show(found) {
  by("files-stay").textContent = about.files;
  by("where").textContent = about.where;
  by("anew").hidden = !anew || !about.stays || found.files.length === 0;
  // What was wrong with a file that is gone, or before a fit that was made, is past.
  if (overview && (found.files.length < overview.files.length || found.fits.length > overview.fits.length)) by("fault").hidden = true;
  overview = found;
  seen = JSON.stringify(found);
  const ids = new Set(found.fits.map((fit) => fit.id));
  for (const id of [...drawn]) if (!ids.has(id)) drawn.delete(id);
  for (const id of ids) {
    if (!known.has(id)) drawn.add(id);
    known.add(id);
  }
  document.body.classList.toggle("empty", found.files.length === 0);
  task.offer(found.files.some((file) => !file.problem), found.fits.length > 0);
  const drawing = looking.show(found, drawn, show);
  opening.show(found, show);
  fitting.show(found, drawn, draw, show);
  await drawing;
  await tasks();
  document.body.dataset.shown = String(found.fits.length);
}

/** Shows the tasks, of which one may be open. */
async function tasks() {
  if (!overview) return;
  preparing.show(overview, show);
  splitting.show(overview, show);
  await driving.show(overview, show);
  await designing.show(overview);
  await home.show(overview);
}

const draw = () => overview && looking.show(overview, drawn, show);
// The page that made a change has drawn it already.
const refresh = () => ask("overview").then((found) => (JSON.stringify(found) === seen ? undefined : show(found)), () => {});

/** @param {import("./api.js").Fault} fault */
function say({ problem, remedy }) {
  const node = by("fault");
  node.hidden = false;
  fill(node, el("span", {}, `${problem}${remedy ? `. What helps: ${remedy}.` : ""}`), el("button", { onclick: () => (node.hidden = true) }, "Close"));
}

whenRefused(say);

task.start(() => void tasks());
theme.start(() => overview && show(overview));
by("reload").addEventListener("click", () => reload().then(show, () => {}));
by("anew").addEventListener("click", () => confirm("Forget files, fits and marks?") && anew?.());

document.body.dataset.session = about.name;
addEventListener("beforeunload", (event) => {
  if (!about.stays && overview?.files.length) event.preventDefault();
});

let changes = -1;
/** @type {string | null} */
let failed = null;
opening.start(show);
listen((told) => {
  fitting.working(told.jobs);
  by("reload").hidden = told.named === 0;
  const fault = told.failed ? JSON.stringify(told.failed) : null;
  // What was cancelled is known to whoever cancelled it.
  if (told.failed && fault !== failed && told.failed.code !== 103) {
    say(told.failed);
  }
  failed = fault;
  if (told.changes !== changes) {
    changes = told.changes;
    refresh();
  }
});
