// The way to a session in the command: calls over HTTP, progress as server-sent events.

export const about = {
  name: "server",
  files: "The files stay on this machine.",
  where: "Local server: runs on this machine only. Nothing is sent elsewhere.",
  gone: "is the command still running? Start it again and open the new address",
  /** Whether the session outlives the page. */
  stays: true,
};

/**
 * @param {string} path
 * @param {string | Blob} [body]
 */
export async function call(path, body) {
  const headers = typeof body === "string" ? { "content-type": "application/json" } : undefined;
  const answer = await fetch(`api/${path}`, { method: "POST", body, headers });
  return { ok: answer.ok, code: answer.status, text: await answer.text() };
}

/** The command ends a session. */
export const anew = null;

/** @param {(told: string) => void} told */
export function listen(told) {
  const events = new EventSource("api/events");
  events.onmessage = (event) => told(event.data);
}
