// The preparation of the file that is shown: its steps, and what they did.

import { ask } from "./api.js";
import { by, el, fill, shown, unit } from "./dom.js";
import * as look from "./look.js";
import { each } from "./alike.js";

const STEPS = [
  ["spikes", "spikes", "Spikes and bursts. A number: deviations from which on a sample is a spike."],
  ["low_pass", "noise", "A low-pass filter that removes the noise. A number: its cut-off in Hz, or in cycles a sample."],
  ["dead_band", "false reversals", "Reversals of the input that are noise. A number: the largest, in the input's unit."],
  ["lag", "lag of the sensor", "Undoes the lag of the input's sensor. Right only if the material does not depend on rate. A number: its time constant in s."],
  ["resample", "equal steps of time", "Where a filter needs them. A number: the step in s."],
  ["signs", "lost signs", "Restores the signs of readings just below zero. It turns good readings over where none was lost. on or off."],
  ["believe", "believe it", "Prepares also a recording with a frozen channel, rows that come twice, or rows that disagree with the others. on or off."],
];

/** What was typed and is not sent yet, by file: it stays when the page is drawn again. @type {Map<number, Record<string, string>>} */
const typed = new Map();

/**
 * @param {import("./api.js").Overview} overview
 * @param {(overview: any) => void} changed
 */
export function show(overview, changed) {
  const file = overview.files.find((file) => look.isShown(file.id));
  if (!file) return fill(by("prepare"));
  const steps = { spikes: "auto", low_pass: "auto", dead_band: "auto", lag: "off", resample: "auto", signs: "off", believe: "off", ...file.steps, ...typed.get(file.id) };
  const send = (/** @type {object | null} */ steps) => ask("prepare", { file: file.id, steps }).then((found) => {
    typed.delete(file.id);
    changed(found);
  }, () => {});
  const others = file.steps ? overview.files.filter((other) => other.id !== file.id && !other.problem && !same(other.steps, file.steps)) : [];
  const field = (/** @type {string[]} */ [name, title, meaning]) =>
    el("label", { class: "field" }, el("span", {}, title), el("input", { name, type: "text", value: /** @type {any} */ (steps)[name], list: "steps", autocomplete: "off", required: true, "data-key": `step-${name}`, oninput: (/** @type {any} */ e) => typed.set(file.id, { ...typed.get(file.id), [name]: e.target.value }) }), el("small", {}, meaning));
  const submit = (/** @type {any} */ event) => {
    event.preventDefault();
    send(Object.fromEntries(/** @type {any} */ (new FormData(event.target))));
  };
  fill(
    by("prepare"),
    el("p", {}, el("strong", {}, file.name), file.steps ? " is prepared. Fits take what is prepared." : " is as it was read."),
    others.length > 0 ? el("button", { type: "button", "data-key": `prepare-others-${file.id}`, onclick: () => each(others, "prepare", { steps: file.steps }).then(changed) }, `The same for ${others.length === 1 ? others[0].name : `the ${others.length} other files`}`) : null,
    ...file.preparation.map((done, n) => report(done, file, file.prepared_at[n] ?? [[], []])),
    el("form", { onsubmit: submit },
      el("div", { class: "row" },
        el("button", { class: "first", "data-key": `prepare-${file.id}` }, file.steps ? "Prepare again" : "Prepare"),
        file.steps && el("button", { type: "button", "data-key": `raw-${file.id}`, onclick: () => send(null) }, "Take it as it was read")),
      el("p", { class: "quiet" }, "Each step: auto, off or a number. By itself a step is taken only where it helps."),
      el("div", { class: "fields" }, ...STEPS.map(field))),
  );
}

/** @param {any} one @param {any} other */
const same = (one, other) => JSON.stringify(one) === JSON.stringify(other);

/**
 * What a preparation did, in numbers.
 * @param {any} done
 * @param {import("./api.js").File} file
 * @param {[string[], string[]]} places of what was repaired of input and output
 */
function report({ samples_before, samples, input_noise, output_noise, spikes, resampled, low_pass, lag, dead_band, judged }, file, places) {
  const [input, output] = [unit(file.input), unit(file.output)];
  const of = (/** @type {any} */ repairs, /** @type {string[]} */ at) => `${repairs.spikes} spikes, ${repairs.signs} lost signs${at.length > 0 ? ` (${at.join(", ")}${repairs.spikes + repairs.signs > at.length ? ", …" : ""} of the file)` : ""}`;
  const filter = (/** @type {any} */ one, /** @type {string} */ of) => (one ? `cut-off ${shown(one.cutoff)} ${low_pass.in_hertz ? "Hz" : "cycles a sample"}, removed ${shown(one.removed)}${of} (root mean square)` : "not needed");
  const rows = [
    ["Samples", samples === samples_before ? String(samples) : `${samples_before} before, ${samples} after`],
    ["Noise of the input, of the output", `${shown(input_noise)}${input}, ${shown(output_noise)}${output} (standard deviation)`],
    ["Spikes of the input", spikes && of(spikes.input, places[0])],
    ["Spikes of the output", spikes && of(spikes.output, places[1])],
    ["Low-pass of the input", low_pass && filter(low_pass.input, input)],
    ["Low-pass of the output", low_pass && filter(low_pass.output, output)],
    ["False reversals of the input", dead_band && `${dead_band.false_reversals} removed up to ${shown(dead_band.size)}${input}: ${dead_band.samples_changed} samples changed by at most ${shown(dead_band.largest_change)}${input}`],
    ["Lag of the sensor", lag && (lag.undone === null ? `not undone: the best, ${shown(lag.estimate)} s, makes no fit 10 % better` : `${shown(lag.undone)} s undone`)],
    ["Steps of time", resampled && `${shown(resampled)} s`],
    ...judged.map((/** @type {any} */ one) => [`Worth: ${one.step}`, one.before === null ? "not taken: the recording is too short to tell" : `${one.kept ? "taken" : "not taken"}: a model errs by ${shown(one.after)}${output} on what it did not see, without this step by ${shown(one.before)}${output}`]),
  ];
  return el("table", { class: "report" }, ...rows.filter(([, text]) => text).map(([name, text]) => el("tr", {}, el("th", { scope: "row" }, name), el("td", {}, text))));
}
