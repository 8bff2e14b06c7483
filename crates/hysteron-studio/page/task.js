// The task that is open beside the pictures: one at a time.

import { by, el } from "./dom.js";

const TASKS = [["prepare", "Prepare"], ["split", "Split"], ["fit", "Fit"], ["drive", "Drive"], ["design", "Design"], ["home", "Take home"]];
/** Tasks that need a fit. */
const FITTED = new Set(["drive", "design"]);

/** @type {string | null} */
let open = null;
/** @type {() => void} */
let onChange = () => {};

/** @param {string} name */
export const isOpen = (name) => open === name;

/** @param {() => void} changed called when another task is open */
export function start(changed) {
  onChange = changed;
  by("tasks").append(...TASKS.map(([name, title]) => el("button", { "data-task": name, "aria-expanded": "false", "aria-controls": "task", disabled: true, onclick: () => show(open === name ? null : name) }, title)));
  by("task-close").addEventListener("click", () => show(null));
  addEventListener("keydown", (event) => event.key === "Escape" && open && show(null));
}

/** Opens a task, or closes the one that is open. @param {string | null} name */
export function show(name) {
  const before = open;
  open = name;
  by("task").hidden = !name;
  document.body.dataset.open = name ?? "";
  for (const [other, title] of TASKS) {
    by(other).hidden = other !== name;
    button(other).setAttribute("aria-expanded", String(other === name));
    for (const figure of document.querySelectorAll(`.of-${other}`)) /** @type {HTMLElement} */ (figure).hidden = other !== name;
    if (other === name) by("task-title").textContent = title;
  }
  if (name) {
    by("task").scrollTop = 0;
    by("task-title").focus();
  } else if (before) button(before).focus();
  onChange();
}

/** @param {string} name */
const button = (name) => /** @type {HTMLButtonElement} */ (document.querySelector(`[data-task="${name}"]`));

/**
 * Offers the tasks that there is something for.
 * @param {boolean} files whether there is a recording
 * @param {boolean} fits whether there is a fit
 */
export function offer(files, fits) {
  for (const [name] of TASKS) button(name).disabled = FITTED.has(name) ? !fits : !files;
  if (open && button(open).disabled) show(null);
}
