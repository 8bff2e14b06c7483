// One step for several files.

import { ask } from "./api.js";

/**
 * Asks the same for each file, and goes on where it is refused for one. Returns what is open then.
 * @param {import("./api.js").File[]} files
 * @param {string} request
 * @param {object} more
 */
export async function each(files, request, more) {
  for (const { id } of files) await ask(request, { file: id, ...more }).catch(() => {});
  return ask("overview");
}
