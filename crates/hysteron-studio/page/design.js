// The profile of input that the data lack.

import { ask, take } from "./api.js";
import { by, el, fill, save, shown, unit } from "./dom.js";
import { draw, stroke } from "./plot.js";
import { CLASSES, classes } from "./plane.js";
import { isOpen } from "./task.js";

/** @type {{fit: number|null, heating: string, cooling: string, budget: string, whole: boolean, found: any}} */
const now = { fit: null, heating: "1", cooling: "1", budget: "", whole: false, found: null };

const wish = () => ({ fit: now.fit, heating: Number(now.heating), cooling: Number(now.cooling), budget: now.budget === "" ? null : Number(now.budget), whole: now.whole });

/** @param {import("./api.js").Overview} overview */
export async function show(overview) {
  if (overview.fits.length === 0) return;
  if (!overview.fits.some((fit) => fit.id === now.fit)) Object.assign(now, { fit: overview.best, found: null });
  const of = unit(overview.fits.find((fit) => fit.id === now.fit)?.input) || " of the input";
  const number = (/** @type {"heating"|"cooling"|"budget"} */ name, /** @type {string} */ title, /** @type {string} */ meaning, required = true) =>
    el("label", { class: "field" }, el("span", {}, title), el("input", { name, type: "number", min: 0, step: "any", required, value: now[name], "data-key": `design-${name}`, oninput: (/** @type {any} */ e) => (now[name] = e.target.value) }), meaning && el("small", {}, meaning));
  const submit = async (/** @type {any} */ event) => {
    event.preventDefault();
    now.found = await ask("design", wish()).catch(() => null);
    await picture();
  };
  fill(by("design-form"),
    el("form", { onsubmit: submit },
      el("div", { class: "fields" },
        el("label", { class: "field" }, el("span", {}, "Plane of"), el("select", { "data-key": "design-fit", onchange: (/** @type {any} */ e) => (now.fit = Number(e.target.value)) }, ...overview.fits.map((fit, n) => el("option", { value: String(fit.id), selected: fit.id === now.fit }, `fit ${n + 1}`))), el("small", {}, "What its files determine is left out.")),
        number("heating", `Fastest rise [${of.trim()}/s]`, ""),
        number("cooling", `Fastest fall [${of.trim()}/s]`, ""),
        number("budget", "Longest duration [min]", "Empty: as long as needed.", false)),
      el("div", { class: "row" },
        el("button", { class: "first", id: "design-begin" }, "Design"),
        el("label", {}, el("input", { type: "checkbox", "data-key": "design-whole", checked: now.whole, onchange: (/** @type {any} */ e) => (now.whole = e.target.checked) }), " the whole plane, as if nothing were recorded"),
        el("button", { type: "button", id: "design-take", disabled: !now.found?.samples, onclick: () => take({ what: "profile", ...wish() }).then(save, () => {}) }, "Profile (CSV)"))));
  await picture();
}

async function picture() {
  const found = now.found;
  by("design-command").hidden = !found;
  for (const figure of document.querySelectorAll(".of-design")) /** @type {HTMLElement} */ (figure).hidden = !found || !isOpen("design");
  if (!found) return void (by("design-text").textContent = "");
  by("design-take").disabled = found.samples === 0;
  const minutes = (/** @type {number} */ seconds) => `${shown(seconds / 60)} min`;
  const told = (/** @type {number[]} */ counts) => counts.map((count, n) => `${count} ${CLASSES[n]}`).filter((_, n) => counts[n] > 0).join(", ");
  by("design-text").textContent = found.samples === 0
    ? "Nothing is missing: what is recorded determines every operator."
    : `${minutes(found.duration)}, ${found.branches} branches, ${found.samples} samples. Operators now: ${told(found.counts_before)}. With the profile: ${told(found.counts_after)}.${found.full_duration > found.duration * 1.0001 ? ` All would take ${minutes(found.full_duration)}.` : ""}`;
  by("design-command").textContent = found.command;
  if (!isOpen("design")) return;
  await draw(by("plot-profile"), [{ x: found.time, y: found.input, mode: "lines", line: stroke(0) }], { x: "time [s]", y: found.unit });
  await classes(by("plot-before"), found.levels, found.before, found.unit);
  await classes(by("plot-after"), found.levels, found.after, found.unit);
}
