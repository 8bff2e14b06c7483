// What made the session what it is, kept by the browser: a page that is opened again goes on.

/** @typedef {{name: string, bytes: Uint8Array} | {name: "open", label: string, file: Blob}} Step */

const NAME = "hysteron";
/** Milliseconds for which a page that is being reloaded may still hold the session. */
const LEAVING = 1000;

export class Kept {
  /** @param {IDBDatabase} base */
  constructor(base) {
    this.base = base;
  }

  /**
   * The session that is kept here. Rejects where the browser keeps nothing, and while another page
   * has it: two pages are two sessions.
   */
  static async open() {
    // It is held until the worker ends.
    await new Promise((resolve, reject) => {
      const waiting = { signal: AbortSignal.timeout(LEAVING) };
      navigator.locks.request(NAME, waiting, () => new Promise(() => resolve(null))).catch(reject);
    });
    const asked = indexedDB.open(NAME, 1);
    asked.onupgradeneeded = () => asked.result.createObjectStore("steps", { autoIncrement: true });
    return new Kept(await done(asked));
  }

  /** @returns {Promise<Step[]>} */
  steps() {
    return done(this.store("readonly").getAll());
  }

  /** @param {Step} step */
  add(step) {
    return done(this.store("readwrite").add(step));
  }

  clear() {
    return done(this.store("readwrite").clear());
  }

  /** @param {IDBTransactionMode} mode */
  store(mode) {
    return this.base.transaction("steps", mode).objectStore("steps");
  }
}

/**
 * @template T
 * @param {IDBRequest<T>} asked
 * @returns {Promise<T>}
 */
const done = (asked) =>
  new Promise((resolve, reject) => {
    asked.onsuccess = () => resolve(asked.result);
    asked.onerror = () => reject(asked.error);
  });
