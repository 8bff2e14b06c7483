// What the figures of a page show, as numbers, and which part of it is shown now.

/** @typedef {[number, number]} Ends */
/** @typedef {{x: number, y: number, width: number, height: number}} Area */
/** @typedef {{label: string, key: string, range: Ends, labelled: boolean, numbered: boolean}} Axis */
/** @typedef {{colour: string, width: number, dash: string}} Stroke */
/**
 * @typedef {object} Line
 * @property {string} name
 * @property {Stroke} stroke
 * @property {string | null} fill colour of the area between this line and the one before
 * @property {boolean} forward whether x only grows, as time does
 * @property {number} samples that it was drawn from
 * @property {number[]} kept which of them are here; all, where empty
 * @property {(number | null)[]} xs
 * @property {(number | null)[]} ys
 */
/**
 * @typedef {object} Plot
 * @property {Area} area
 * @property {Axis} x
 * @property {Axis} y
 * @property {Line[]} lines
 * @property {[Ends[], Area, string][]} bands
 * @property {number | null} foot where the x axis stands, if that is below the panel
 * @property {[number, Stroke][]} levels
 * @property {[number, Stroke, string][]} uprights
 * @property {[Ends, Stroke][]} rings around samples
 */
/** @typedef {{sample: number, samples: number}} Pointed */
/** @typedef {{at: Ends, anchor: "start" | "end", size: number, colour: string, text: string}} Words */
/** @typedef {{id: string, plots: Plot[], series: Ends[][], words: Words[], areas: [string, string][]}} Figure */

/** The text of a packed script of this page. @param {string} id */
const unpacked = async (id) => {
  const bytes = Uint8Array.from(atob(document.getElementById(id)?.textContent ?? ""), (c) =>
    c.charCodeAt(0),
  );
  return new Response(
    new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")),
  ).text();
};

/** The figures of this page that are drawn again. @type {Figure[]} */
const figures = [];

/**
 * The part of each axis that is shown, by its key; all of it, where there is none.
 * @type {Map<string, Ends>}
 */
const shown = new Map();
/** The sample that is pointed at, and of how many. @type {Pointed | null} */
let pointed = null;

/**
 * Where a value stands in a series that grows.
 * @param {ArrayLike<number | null>} values
 * @param {number} value
 */
const place = (values, value) => {
  let [low, high] = [0, values.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((values[middle] ?? -Infinity) < value) low = middle + 1;
    else high = middle;
  }
  return low;
};

/** The number of the sample at a place of a line. @param {Line} line @param {number} at */
const sampleAt = ({ kept }, at) => (kept.length ? kept[at] : at);
/**
 * The place of a sample in a line, or of the next one there.
 * @param {Line} line
 * @param {number} sample
 */
const placeOf = ({ kept }, sample) => (kept.length ? place(kept, sample) : sample);

/** The part to which an axis is zoomed, where it has any of that. @param {Axis} axis */
const zoomed = ({ key, range }) => {
  const part = shown.get(key);
  return part && part[0] < range[1] && part[1] > range[0] ? part : null;
};

/**
 * First and last sample within the time that is shown, of a recording of so many.
 * @param {number} samples
 * @returns {Ends | null}
 */
const windowOf = (samples) => {
  for (const { x, lines } of figures.flatMap(({ plots }) => plots)) {
    const part = zoomed(x);
    const line = lines.find(
      (line) => line.forward && line.samples === samples && line.xs.length > 1,
    );
    if (part && line)
      return [
        sampleAt(line, Math.max(0, place(line.xs, part[0]) - 1)),
        sampleAt(line, Math.min(line.xs.length - 1, place(line.xs, part[1]))),
      ];
  }
  return null;
};

/** The part of an axis that is shown. @param {Axis} axis */
const partOf = (axis) => zoomed(axis) ?? axis.range;

/** Whether lines of so many samples are over the time of a recording. @param {number} samples */
const isRecording = (samples) =>
  figures.some(({ plots }) =>
    plots.some(({ lines }) => lines.some((line) => line.forward && line.samples === samples)),
  );
