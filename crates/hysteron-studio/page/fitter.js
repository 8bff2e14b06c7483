// A worker that makes one fit, and ends with it.

import { instance } from "./wasm.js";

const page = /** @type {any} */ (self);
/** Milliseconds between two messages about progress. */
const EVERY = 50;

page.onmessage = async (/** @type {{data: {module: WebAssembly.Module, job: Uint8Array}}} */ { data }) => {
  let last = -EVERY;
  const tell = (/** @type {Uint8Array} */ told) => {
    if (performance.now() - last < EVERY) return;
    last = performance.now();
    page.postMessage({ told });
  };
  try {
    const session = await instance(data.module, tell);
    page.postMessage({ finished: session.call("run", [data.job]).output });
  } catch (error) {
    page.postMessage({ failed: /** @type {Error} */ (error).message });
  }
};
