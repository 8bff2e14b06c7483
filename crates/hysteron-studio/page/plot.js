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

/** The colour of a fit's band. @param {number} place */
export const tint = (place) => `${colour(Math.max(0, place))}33`;

/**
 * Round numbers within two ends, some six of them.
 * @param {number} low
 * @param {number} high
 */
export function rounds(low, high) {
  const rough = (high - low) / 6;
  const power = 10 ** Math.floor(Math.log10(rough || 1));
  const step = /** @type {number} */ ([1, 2, 5, 10].find((n) => n * power >= rough)) * power;
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.max(0, Math.floor(high / step + 1e-9) - first + 1) }, (_, n) => (first + n) * step);
}

/**
 * The roundest number from `low` on and below `high`; none where there is no room.
 * @param {number} low
 * @param {number} high
 */
export function roundest(low, high) {
  for (let power = 10 ** Math.ceil(Math.log10(high - low)); power > 1e-9 * (high - low); power /= 10) {
    for (const step of [5 * power, 2 * power, power]) {
      const first = Math.ceil(low / step - 1e-9) * step;
      if (first < high) return [first];
    }
  }
  return [];
}

/** Pictures follow the size of their place. */
const sizes = new ResizeObserver((entries) => {
  for (const { target } of entries) {
    const node = /** @type {any} */ (target);
    const isOther = () => Math.abs(node.clientWidth - node._fullLayout.width) > 1 || Math.abs(node.clientHeight - node._fullLayout.height) > 1;
    if (node.layout && node.clientWidth > 0 && isOther()) requestAnimationFrame(() => Plotly.Plots.resize(node));
  }
});

/**
 * Draws, or draws again. Pictures that are `aligned` begin and end below each other.
 * @param {HTMLElement} node
 * @param {object[]} traces
 * @param {{x: string, y: string, [more: string]: any}} what
 */
export function draw(node, traces, { x, y, xaxis = {}, yaxis = {}, aligned = false, ...more }) {
  const narrow = node.clientWidth < 480;
  const axis = { gridcolor: ink("line"), zerolinecolor: ink("line"), linecolor: ink("line"), automargin: true, exponentformat: "power", minexponent: 5, nticks: narrow ? 6 : 8 };
  const title = (/** @type {string} */ text) => ({ text: plain(text), standoff: 6 });
  const layout = {
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    font: { color: ink("ink"), family: "system-ui, sans-serif", size: 12 },
    margin: { l: aligned ? 68 : 8, r: 12, t: 8, b: 8 },
    showlegend: traces.length > 1,
    // From the edge of the picture, not from that of the curves: where a new width folds the legend, plotly
    // moves the curves after it has placed the legend.
    legend: { orientation: "h", yref: "container", y: 1, yanchor: "top", x: 0, font: { size: 11 } },
    hovermode: "closest",
    hoverdistance: 40,
    dragmode: "zoom",
    xaxis: { ...axis, title: title(x), ...xaxis },
    yaxis: { ...axis, automargin: !aligned, title: title(y), ...yaxis },
    ...more,
  };
  // On a narrow page a finger scrolls: the buttons zoom.
  if (innerWidth < 700 && layout.dragmode === "zoom") layout.dragmode = /** @type {any} */ (false);
  node.setAttribute("role", "img");
  node.setAttribute("aria-label", `${y} over ${x}`);
  sizes.observe(node);
  return Plotly.react(node, traces, layout, { displaylogo: false, displayModeBar: false });
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
 * Pictures as files: each as SVG and as PNG.
 * @param {HTMLElement[]} nodes
 */
export async function archive(nodes) {
  const files = [];
  for (const node of nodes) {
    for (const format of ["svg", "png"]) {
      const url = await Plotly.toImage(node, { format, width: node.clientWidth, height: node.clientHeight, scale: format === "png" ? 2 : 1 });
      const data = url.slice(url.indexOf(",") + 1);
      const bytes = format === "svg" ? new TextEncoder().encode(decodeURIComponent(data)) : Uint8Array.from(atob(data), (c) => c.charCodeAt(0));
      files.push({ name: `${node.id.slice(5)}.${format}`, bytes });
    }
  }
  return files;
}
