// A worker with the session, in the place of the server. A fit runs in a worker of its own, so that
// the session answers meanwhile, and a fit that is cancelled ends at once.

import { Kept } from "./kept.js";
import { NoMemory, decode, encode, instance } from "./wasm.js";

/** @typedef {import("./kept.js").Step} Step */

const page = /** @type {any} */ (self);
/** @type {WebAssembly.Module} */
let module;
/** @type {import("./wasm.js").Instance} */
let session;
/** What made the session what it is. A panic ends its instance; a new one takes the same steps. @type {Step[]} */
let steps = [];
/** The same, beyond the page; null where the browser does not keep it. @type {Kept | null} */
let kept = null;
/** Fits that wait. @type {{job: number, bytes: Uint8Array}[]} */
let waiting = [];
/** The fit that runs. @type {{job: number, worker: Worker} | null} */
let running = null;
/** What the page was told last. */
let told = "";
/** What became of the session that was kept, where it is lost. @type {object | null} */
let lost = null;

/** Gives the module that the page has compiled. @type {(module: WebAssembly.Module) => void} */
let begin = () => {};
/** One thing after the other: files are read meanwhile. Nothing comes before the module. */
let turn = /** @type {Promise<WebAssembly.Module>} */ (new Promise((resolve) => (begin = resolve)))
  .then(async (given) => {
    module = given;
    await begun();
    tell();
  })
  .catch((error) => page.postMessage({ gone: error.message }));
const inTurn = (/** @type {() => any} */ work) => void (turn = turn.then(work).catch((error) => console.error(error)));

/** The session as it was when the page was closed, or an empty one. */
async function begun() {
  try {
    kept = await Kept.open();
    steps = await kept.steps();
  } catch (error) {
    console.info("the browser does not keep the session:", error);
    kept = null;
  }
  page.postMessage({ stays: kept !== null });
  try {
    const asked = await replay();
    // Fits that were under way begin anew.
    const { jobs } = JSON.parse(decode(session.call("request", [encode('{"request":"overview"}')]).output));
    const due = new Set(jobs.map((/** @type {{id: number}} */ { id }) => id));
    waiting = [...asked].filter(([job]) => due.has(job)).map(([job, bytes]) => ({ job, bytes }));
    next();
  } catch (error) {
    await lose(error);
    lost = { code: 104, problem: "the session that this browser kept cannot be opened", remedy: "open the files again" };
  }
}

/** The session takes a step. @param {Step} step */
function took(step) {
  steps.push(step);
  kept?.add(step).catch((error) => {
    // Half a session is none.
    console.warn("the browser does not keep the session any more:", error);
    forget();
    kept = null;
    page.postMessage({ stays: false });
  });
}

const forget = () => kept?.clear().catch((error) => console.error(error));

page.onmessage = (/** @type {{data: any}} */ { data }) => {
  if (data.module) return begin(data.module);
  if (data.forget) return inTurn(() => forget()?.then(() => page.postMessage({ forgotten: true })));
  inTurn(() => serve(data).then(tell));
};

/** @param {{id: number, path: string, body: any}} call */
async function serve({ id, path, body }) {
  try {
    const { value, output } = path.startsWith("open/") ? await opened(decodeURIComponent(path.slice(5)), body) : ask(body);
    page.postMessage({ id, ok: value > 0, code: value, text: decode(output) });
  } catch (error) {
    if (error instanceof NoMemory) return page.postMessage({ id, ok: false, code: 101, text: fault(101, error.message, "close other files") });
    const remedy = await restart();
    const problem = `a defect of the studio: ${/** @type {Error} */ (error).message}`;
    page.postMessage({ id, ok: false, code: 104, text: fault(104, problem, remedy) });
  }
}

const fault = (/** @type {number} */ code, /** @type {string} */ problem, /** @type {string} */ remedy) => JSON.stringify({ code, problem, remedy });

/**
 * @param {string} label
 * @param {Blob} file
 */
async function open(label, file) {
  const admitted = session.call("admits", [], file.size);
  if (!admitted.value) return admitted;
  let bytes;
  try {
    bytes = new Uint8Array(await file.arrayBuffer());
  } catch {
    return { value: 0, output: encode(fault(102, `${label} cannot be read any more`, "drop it again")) };
  }
  const name = encode(label);
  return session.call("open", [bytes, name], name.length);
}

/**
 * @param {string} label
 * @param {Blob} file
 */
async function opened(label, file) {
  const answer = await open(label, file);
  if (answer.value) took({ name: "open", label, file });
  return answer;
}

/** @param {string} text */
function ask(text) {
  const { request, job } = JSON.parse(text);
  const bytes = encode(text);
  const answer = session.call("request", [bytes]);
  // A drive is no change for others, but takes a number.
  if (answer.value === 2 || (answer.value && request === "drive")) took({ name: "request", bytes });
  if (answer.value && request === "fit") {
    const made = session.call("job");
    waiting.push({ job: made.value, bytes: made.output });
    next();
  }
  if (answer.value && request === "cancel") stop(job);
  return answer;
}

/** Begins the next fit. */
function next() {
  const first = running ? undefined : waiting.shift();
  if (!first) return;
  const worker = new Worker(new URL("./fitter.js", import.meta.url), { type: "module" });
  running = { job: first.job, worker };
  worker.onmessage = ({ data }) =>
    inTurn(async () => {
      if (running?.worker !== worker) return;
      if (data.told) await step("progress", data.told);
      else if (data.finished) await end("finish", data.finished);
      else await end("ended", encode(JSON.stringify({ job: first.job, problem: `a fit ended: ${data.failed}` })));
      tell();
    });
  worker.onerror = (event) =>
    inTurn(async () => {
      if (running?.worker !== worker) return;
      await end("ended", encode(JSON.stringify({ job: first.job, problem: `a fit ended: ${event.message ?? "its worker is gone"}` })));
      tell();
    });
  worker.postMessage({ module, job: first.bytes });
}

/**
 * The fit that runs is at its end.
 * @param {string} name
 * @param {Uint8Array} bytes
 */
async function end(name, bytes) {
  running?.worker.terminate();
  running = null;
  await step(name, bytes);
  took({ name, bytes });
  next();
}

/**
 * Ends a fit that was cancelled, or takes it out of those that wait.
 * @param {number} job
 */
function stop(job) {
  const bytes = encode(JSON.stringify({ job, problem: null }));
  if (running?.job === job) return inTurn(() => end("ended", bytes).then(tell));
  waiting = waiting.filter((other) => other.job !== job);
  inTurn(async () => {
    await step("ended", bytes);
    took({ name: "ended", bytes });
    tell();
  });
}

/**
 * A call that nobody waits for.
 * @param {string} name
 * @param {Uint8Array} bytes
 */
async function step(name, bytes) {
  try {
    session.call(name, [bytes]);
  } catch (error) {
    console.error(error);
    await restart();
  }
}

/** A new instance, brought to where the old one was. Returns the fits that were asked for. */
async function replay() {
  /** @type {Map<number, Uint8Array>} */
  const asked = new Map();
  session = await instance(module);
  for (const taken of steps) {
    if ("file" in taken) {
      if (!(await open(taken.label, taken.file)).value) throw new Error("a file is gone");
      continue;
    }
    session.call(taken.name, [taken.bytes]);
    const job = taken.name === "request" ? session.call("job") : null;
    if (job?.value) asked.set(job.value, job.output);
  }
  return asked;
}

/** After a defect. Returns what the user may do. */
async function restart() {
  try {
    await replay();
    return "the session is as it was before; take it home, and tell us what you did";
  } catch (error) {
    await lose(error);
    return "the session is lost; open the files again";
  }
}

/** @param {any} why */
async function lose(why) {
  console.error(why);
  running?.worker.terminate();
  [steps, waiting, running] = [[], [], null];
  session = await instance(module);
  forget();
}

/** Tells the page what is new. */
function tell() {
  const news = decode(session.call("told").output);
  const now = lost ? JSON.stringify({ ...JSON.parse(news), failed: lost }) : news;
  if (now !== told) page.postMessage({ told: (told = now) });
}
