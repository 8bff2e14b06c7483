// The calls to the session, whichever way they go: to the command, or to a worker of this browser.

/** @typedef {{code: number, problem: string, remedy: string | null}} Fault */
/** @typedef {{input: string|null, output: string|null, time: string|null, load: string|null}} Roles */
/** @typedef {{name: string, min: number|null, max: number|null, not_numbers: number, picture: ([number, number]|null)[]}} Column */
/** @typedef {{id: number, name: string, bytes: number, rows: number, columns: Column[], roles: Roles, reasons: string[], doubts: {role: string, candidates: [string, string][]}[], notes: string[], problem: Fault|null, repair: {notes: string[], samples: number}|null, steps: Record<string, string>|null, preparation: any[], prepared_at: [string[], string[]][], mend: boolean, purpose: string, marked: [number, number][], samples: number, begins: number[], spans: [number, number][], branches: number, input: string|null, output: string|null}} File */
/** @typedef {{rmse: number, max_abs: number, nrmse_percent: number|null, samples: number}} Errors */
/** @typedef {{id: number, files: number[], options: Record<string, string>, hold_out: string, levels: number, rmse: number, nrmse_percent: number, max_abs: number, held_out: null|{model: Errors, rivals: (Errors & {name: string})[]}, inverse_errors: Errors|null, outliers: number, verdict: [string, string][], late: string[], advice: string[], changed: number[], can_be_judged_anew: boolean, inverse: boolean, timed: boolean, load: [number, number]|null, input: string, output: string, confidence: boolean}} Fit */
/** @typedef {{id: number, stage: string, share: number|null}} JobView */
/** @typedef {{name: string, default: string, range: string, purpose: string}} Option */
/** @typedef {{files: File[], fits: Fit[], jobs: JobView[], best: number|null, best_by: string, options: Option[], memory: [number, number]}} Overview */
/** @typedef {{fit: number|null, raw: boolean, x: (number|null)[], y: (number|null)[]}} Line */
/** @typedef {[(number|null)[], (number|null)[]]} Points */
/** @typedef {{low: number, high: number, beyond: boolean}} Ends */
/** @typedef {{picture: string, x: string, y: string, lines: Line[], left_out: {fit: number, why: {problem: string}}[], ends: [Ends|null, Ends|null], samples: number, span: [number, number]|null, begins: number[], marked: [number, number][], held: [number, number][], band: [Points, Points]|null, band_name: string|null, outliers: [number, number][]}} Curves */

const way = document.querySelector('meta[name="hysteron-session"]') ? await import("./local.js") : await import("./http.js");

/** Which way it is, in words. */
export const about = way.about;

/** @type {(fault: Fault) => void} */
let onFault = () => {};

/** @param {(fault: Fault) => void} listener */
export function whenRefused(listener) {
  onFault = listener;
}

/**
 * @param {string} path
 * @param {string | Blob} [body]
 * @returns {Promise<any>}
 */
async function call(path, body) {
  let answer;
  try {
    answer = await way.call(path, body);
  } catch {
    throw refused({ code: 0, problem: "the studio does not answer", remedy: about.gone });
  }
  if (answer.ok) return JSON.parse(answer.text);
  let fault;
  try {
    fault = JSON.parse(answer.text);
  } catch {
    fault = { code: answer.code, problem: answer.text, remedy: null };
  }
  throw refused(fault);
}

/** @param {Fault} fault */
function refused(fault) {
  onFault(fault);
  return Object.assign(new Error(fault.problem), { fault });
}

/**
 * Asks the session. The answer is null for a picture of what was closed meanwhile.
 * @param {string} request
 * @param {object} [more]
 */
export const ask = (request, more = {}) =>
  call("session", JSON.stringify({ request, ...more })).then((answer) => (answer.response === "gone" ? null : answer));

/**
 * Opens a file.
 * @param {globalThis.File} file
 */
export const open = (file) => call(`open/${encodeURIComponent(file.name)}`, file);

export const reload = () => call("reload");

/** Forgets the session and begins an empty one; null where the page cannot. */
export const anew = way.anew;

/**
 * Saves what the session gives.
 * @param {object} take
 */
export async function take(take) {
  const { name, media, bytes } = await ask("take", take);
  const data = Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0));
  return { name, blob: new Blob([data], { type: media }), text: () => new TextDecoder().decode(data) };
}

/** @param {(told: {changes: number, jobs: JobView[], failed: Fault|null, named: number}) => void} told */
export const listen = (told) => way.listen((text) => told(JSON.parse(text)));
