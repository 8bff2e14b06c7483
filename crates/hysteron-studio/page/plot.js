// Pictures by plotly.js, in the colours of the page.

/** @type {any} */
const Plotly = /** @type {any} */ (globalThis).Plotly;

// Told apart by people who do not see all colours (after Okabe and Ito 2008), and by their dashes.
const COLOURS = { light: ["#0072b2", "#d55e00", "#00835f", "#b0588a", "#a86f00", "#3d4db8"], dark: ["#56b4e9", "#f0a03c", "#3fcf9f", "#e9a3cb", "#f0e442", "#9fb0ff"] };
const DASHES = ["solid", "dash", "dot", "dashdot"];

/** @param {number} id */
export const colour = (id) => COLOURS[isDark() ? "dark" : "light"][id % 6];

export const isDark = () => document.documentElement.dataset.theme === "dark";

/** @param {string} name */
export const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/**
 * The look of a line: what was measured is a plain line in the ink of the page.
 * @param {number | null} place of the fit in the list; null for what was measured
 */
export function stroke(place) {
  if (place === null) return { color: isDark() ? "#c3ccd5" : "#4a5561", width: 1.6 };
  return { color: colour(place), width: 1.8, dash: DASHES[place % DASHES.length] };
}

/**
 * Draws, or draws again.
 * @param {HTMLElement} node
 * @param {object[]} traces
 * @param {{x: string, y: string, [more: string]: any}} what
 */
export function draw(node, traces, { x, y, xaxis = {}, yaxis = {}, ...more }) {
  const narrow = node.clientWidth < 480;
  const axis = { gridcolor: ink("line"), zerolinecolor: ink("line"), linecolor: ink("line"), automargin: true, exponentformat: "power", minexponent: 5 };
  const layout = {
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    font: { color: ink("ink"), family: "system-ui, sans-serif", size: narrow ? 12 : 13 },
    margin: { l: 8, r: 12, t: 8, b: 8 },
    showlegend: traces.length > 1,
    legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 },
    hovermode: "closest",
    dragmode: "zoom",
    xaxis: { ...axis, title: { text: plain(x), standoff: 6 }, ...xaxis },
    yaxis: { ...axis, title: { text: plain(y), standoff: 6 }, ...yaxis },
    ...more,
  };
  // On a narrow page a finger scrolls: the buttons zoom.
  if (narrow && layout.dragmode === "zoom") layout.dragmode = /** @type {any} */ (false);
  const config = {
    responsive: true,
    displaylogo: false,
    displayModeBar: false,
  };
  return Plotly.react(node, traces, layout, config);
}

/**
 * Sets the marks of the sample pointed at, and keeps all other shapes.
 * @param {any} node
 * @param {object[]} shapes
 */
export function mark(node, shapes) {
  const others = (node.layout.shapes ?? []).filter((/** @type {any} */ shape) => shape.name !== "now");
  return Plotly.relayout(node, { shapes: [...others, ...shapes] });
}

/**
 * Plotly takes some markup in texts. Names come from files, and are text only.
 * @param {string} text
 */
export const plain = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll("$", "＄");

/**
 * Listens once, however often the picture is drawn again.
 * @param {any} node
 * @param {string} event
 * @param {(event: any) => void} listener
 */
export function on(node, event, listener) {
  node.removeAllListeners?.(event);
  node.on(event, listener);
}

/**
 * The picture as a file.
 * @param {HTMLElement} node
 * @param {"svg" | "png"} format
 */
export function save(node, format) {
  return Plotly.downloadImage(node, { format, filename: node.id, width: node.clientWidth, height: node.clientHeight, scale: format === "png" ? 2 : 1 });
}
