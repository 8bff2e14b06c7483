// The preparation of a file: its steps, and what they did.

import { el, shown } from "./dom.js";

const STEPS = [
  ["spikes", "spikes", "Spikes and bursts. A number: deviations from which on a sample is a spike."],
  ["low_pass", "noise", "A low-pass filter that removes the noise. A number: its cut-off in Hz, or in cycles a sample."],
  ["dead_band", "false reversals", "Reversals of the input that are noise. A number: the largest, in the input's unit."],
  ["lag", "lag of the sensor", "Undoes the lag of the input's sensor. Right only if the material does not depend on rate. A number: its time constant in s."],
  ["resample", "equal steps of time", "Where a filter needs them. A number: the step in s."],
  ["signs", "lost signs", "Restores the signs of readings just below zero. It turns good readings over where none was lost. on or off."],
  ["believe", "believe it", "Prepares also a recording with a frozen channel, rows that come twice, or rows that disagree with the others. on or off."],
];

/** Open forms, by file: they stay open when the page is drawn again. @type {Set<number>} */
const opened = new Set();

/**
 * @param {import("./api.js").File} file
 * @param {(request: string, more?: object) => void} send
 */
export function form(file, send) {
  if (file.problem && !file.steps) return null;
  const steps = /** @type {Record<string, string>} */ (file.steps ?? { spikes: "auto", low_pass: "auto", dead_band: "auto", lag: "off", resample: "auto", signs: "off", believe: "off" });
  const field = (/** @type {string[]} */ [name, title, meaning]) =>
    el("label", { class: "field" }, el("span", {}, title), el("input", { name, type: "text", value: steps[name], list: "steps", autocomplete: "off", required: true }), el("small", {}, meaning));
  const submit = (/** @type {any} */ event) => {
    event.preventDefault();
    send("prepare", { steps: Object.fromEntries(/** @type {any} */ (new FormData(event.target))) });
  };
  return el(
    "details",
    { class: "prepare", open: opened.has(file.id) || file.steps !== null, ontoggle: (/** @type {any} */ e) => void (e.target.open ? opened.add(file.id) : opened.delete(file.id)) },
    el("summary", {}, file.steps ? "Prepared" : "Prepare: spikes, noise, false reversals, lag"),
    el("form", { onsubmit: submit },
      el("div", { class: "fields" }, ...STEPS.map(field)),
      el("div", { class: "row" },
        el("button", { class: "first", "data-key": `prepare-${file.id}` }, "Prepare"),
        file.steps && el("button", { type: "button", "data-key": `raw-${file.id}`, onclick: () => (opened.delete(file.id), send("prepare", { steps: null })) }, "Take it as it was read"),
        el("small", { class: "quiet" }, "Each step: auto, off or a number; taken by itself only where it helps."))),
    ...file.preparation.map(report),
  );
}

/** @param {any} done */
function report({ samples_before, samples, input_noise, output_noise, spikes, resampled, low_pass, lag, dead_band, judged }) {
  const of = (/** @type {any} */ repairs) => `${repairs.spikes} spikes, ${repairs.signs} lost signs${repairs.first.length > 0 ? ` (rows ${repairs.first.join(", ")}${repairs.spikes + repairs.signs > repairs.first.length ? ", …" : ""})` : ""}`;
  const filter = (/** @type {any} */ one) => (one ? `cut-off ${shown(one.cutoff)} ${low_pass.in_hertz ? "Hz" : "cycles a sample"}, removed ${shown(one.removed)} (root mean square)` : "not needed");
  const rows = [
    ["Samples", samples === samples_before ? String(samples) : `${samples_before} before, ${samples} after`],
    ["Noise of the input, of the output", `${shown(input_noise)}, ${shown(output_noise)} (standard deviation)`],
    ["Spikes of the input", spikes && of(spikes.input)],
    ["Spikes of the output", spikes && of(spikes.output)],
    ["Low-pass of the input", low_pass && filter(low_pass.input)],
    ["Low-pass of the output", low_pass && filter(low_pass.output)],
    ["False reversals of the input", dead_band && `${dead_band.false_reversals} removed up to ${shown(dead_band.size)}: ${dead_band.samples_changed} samples changed by at most ${shown(dead_band.largest_change)}`],
    ["Lag of the sensor", lag && (lag.undone === null ? `not undone: the best, ${shown(lag.estimate)} s, makes no fit 10 % better` : `${shown(lag.undone)} s undone`)],
    ["Steps of time", resampled && `${shown(resampled)} s`],
    ...judged.map((/** @type {any} */ one) => [`Worth: ${one.step}`, one.before === null ? "not taken: the recording is too short to tell" : `${one.kept ? "taken" : "not taken"}: a model errs by ${shown(one.after)} on what it did not see, without this step by ${shown(one.before)}`]),
  ];
  return el("table", { class: "report" }, ...rows.filter(([, text]) => text).map(([name, text]) => el("tr", {}, el("th", { scope: "row" }, name), el("td", {}, text))));
}

/** What repaired rows would be, where they are refused. @param {import("./api.js").File} file */
export function repair(file) {
  if (!file.repair) return null;
  return el("div", {}, el("p", {}, `After “Repair rows” ${file.repair.samples} samples are left of ${file.rows} rows:`), el("ul", { class: "notes" }, ...file.repair.notes.map((note) => el("li", {}, note))));
}
