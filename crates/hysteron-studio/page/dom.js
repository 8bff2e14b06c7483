// Elements without markup: a name from a file is text, whatever it holds.

/**
 * An element. `on…` adds a listener, `class` and the rest are attributes; null and false leave one out.
 * @param {string} tag
 * @param {Record<string, any>} [attributes]
 * @param {...(Node | string | null | undefined | false)} children
 * @returns {HTMLElement}
 */
export function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name === "value" || name === "checked" || name === "selected") /** @type {any} */ (node)[name] = value;
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children) if (child || child === "") node.append(child);
  return node;
}

/**
 * Saves a file as the user's browser does.
 * @param {{name: string, blob: Blob}} file
 */
export function save({ name, blob }) {
  const link = el("a", { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(/** @type {any} */ (link).href), 10000);
}

/**
 * The element with an id.
 * @param {string} id
 * @returns {any}
 */
export function by(id) {
  const node = document.getElementById(id);
  if (!node) throw new Error(`the page has no ${id}`);
  return node;
}

/**
 * A number with four digits.
 * @param {number | null | undefined} value
 */
export function shown(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(2);
  return String(Number(value.toPrecision(4)));
}

/**
 * Replaces the children of a node, and puts the focus back where it was by name.
 * @param {HTMLElement} node
 * @param {...(Node | null)} children
 */
export function fill(node, ...children) {
  const focus = document.activeElement?.getAttribute("data-key");
  node.replaceChildren(...children.filter((child) => child !== null));
  if (focus) /** @type {HTMLElement | null} */ (node.querySelector(`[data-key="${CSS.escape(focus)}"]`))?.focus();
}

/**
 * Which sample of a file it is, and where it stands there.
 * @param {{number: number, place: string | null}} sample
 */
export const which = ({ number, place }) => `sample ${number}${place ? ` (${place} of the file)` : ""}`;

/** @param {string} text */
export const capital = (text) => `${text[0].toUpperCase()}${text.slice(1)}`;

/**
 * The unit in the name of a column, with a space before it; empty without one.
 * @param {string | null | undefined} column
 */
export const unit = (column) => {
  const found = /\[([^\]]+)\]$/.exec(column ?? "");
  return found ? ` ${found[1]}` : "";
};
