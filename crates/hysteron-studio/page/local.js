// The way to a session in a worker of this browser: a page that any server of files can give.

export const about = {
  name: "browser",
  files: "The files stay in this browser.",
  get where() {
    const kept = this.stays ? "The browser keeps the session until you begin anew." : "The session ends with the page: take it home to go on later.";
    return `Static page: everything runs in this browser, and no file leaves it. ${kept}`;
  },
  gone: "take a look at the console of the browser, and open the page again",
  /** Whether the session outlives the page. */
  stays: false,
};

/** @type {Map<number, {resolve: (answer: {ok: boolean, code: number, text: string}) => void, reject: (error: Error) => void}>} */
const open = new Map();
let last = 0;
/** @type {((told: string) => void)[]} */
const listeners = [];
let told = "";
/** Why there is no session. @type {Error | null} */
let gone = null;

const worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
worker.onmessage = (/** @type {MessageEvent} */ { data }) => {
  if (data.stays !== undefined) return void (about.stays = data.stays);
  if (data.forgotten) return location.reload();
  if (data.told !== undefined) {
    told = data.told;
    for (const listener of listeners) listener(told);
  } else if (data.gone !== undefined) {
    fail(new Error(data.gone));
  } else {
    open.get(data.id)?.resolve(data);
    open.delete(data.id);
  }
};
worker.onerror = (/** @type {ErrorEvent} */ event) => fail(new Error(event.message || "the worker cannot be started"));

// The page fetches and compiles: its policy holds here, and both workers take what it has compiled.
const file = new URL("./hysteron.wasm", import.meta.url);
fetch(file)
  .then((answer) => (answer.ok ? answer.arrayBuffer() : Promise.reject(new Error(`${file}: ${answer.status}`))))
  .then((bytes) => WebAssembly.compile(bytes))
  .then((module) => worker.postMessage({ module }), fail);

/** @param {Error} error */
function fail(error) {
  console.error(error);
  gone = error;
  for (const { reject } of open.values()) reject(error);
  open.clear();
}

/**
 * @param {string} path
 * @param {string | Blob} [body]
 * @returns {Promise<{ok: boolean, code: number, text: string}>}
 */
export function call(path, body) {
  return new Promise((resolve, reject) => {
    if (gone) return reject(gone);
    last += 1;
    open.set(last, { resolve, reject });
    worker.postMessage({ id: last, path, body });
  });
}

/** Forgets the session, and opens an empty page. */
export const anew = () => worker.postMessage({ forget: true });

/** @param {(told: string) => void} listener */
export function listen(listener) {
  listeners.push(listener);
  if (told) listener(told);
}
