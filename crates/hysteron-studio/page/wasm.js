// An instance of the session as WebAssembly: bytes in, bytes out.

/** @typedef {{call: (name: string, input?: Uint8Array[], number?: number) => {value: number, output: Uint8Array}}} Instance */

/** What stands in a file or an answer, as text and back. */
export const encode = (/** @type {string} */ text) => new TextEncoder().encode(text);
export const decode = (/** @type {Uint8Array} */ bytes) => new TextDecoder().decode(bytes);

/** There is no memory for what a call is given. The instance lives on. */
export class NoMemory extends Error {}

/**
 * A call that throws has ended the instance, but for NoMemory; the message says why.
 * @param {WebAssembly.Module} module
 * @param {(told: Uint8Array) => void} [tell]
 * @returns {Promise<Instance>}
 */
export async function instance(module, tell = () => {}) {
  let panic = "";
  /** @type {any} */
  let inside = null;
  const part = (/** @type {number} */ at, /** @type {number} */ length) => new Uint8Array(inside.memory.buffer, at >>> 0, length >>> 0);
  const hysteron = {
    tell: (/** @type {number} */ at, /** @type {number} */ length) => tell(part(at, length).slice()),
    panicked: (/** @type {number} */ at, /** @type {number} */ length) => void (panic = decode(part(at, length).slice())),
  };
  /** @type {Record<string, Record<string, any>>} */
  const given = { hysteron };
  // The crate that packs archives brings random numbers for encryption, which nothing asks for.
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    (given[from] ??= {})[name] ??= () => {
      throw new Error(`${name} is not there`);
    };
  }
  inside = (await WebAssembly.instantiate(module, given)).exports;
  inside.begin();
  return {
    call(name, input = [], number = 0) {
      const size = input.reduce((all, bytes) => all + bytes.length, 0);
      try {
        let at = size ? inside.input(size) >>> 0 : 0;
        if (size && !at) throw new NoMemory("the browser has no memory left for it");
        for (const bytes of input) {
          part(at, bytes.length).set(bytes);
          at += bytes.length;
        }
        const value = inside[name](number) ?? 0;
        return { value, output: part(inside.output(), inside.output_length()).slice() };
      } catch (error) {
        if (error instanceof NoMemory) throw error;
        // Without words of its own it is a trap: mostly memory that is not there.
        throw new Error(panic || `the session ended (${/** @type {Error} */ (error).message})`);
      }
    },
  };
}
