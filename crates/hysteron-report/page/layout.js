// Where everything of a figure stands, as it does on paper.

/** Pixels for the legend below a figure on a narrow page. */
const LEGEND = 88;
const INK = "#1b2128";
const AXIS = "#444b54";
const LOOK = {
  gridcolor: "#e6e9ed",
  linecolor: AXIS,
  zeroline: false,
  showline: true,
  ticks: "outside",
  tickfont: { size: 12.5 },
  exponentformat: "power",
  minexponent: 5,
};

/**
 * Whether a figure has less room than a wide page gives it.
 * @param {number} room in pixels
 * @param {number} width of the figure on paper
 */
const isNarrow = (room, width) => room < Math.min(520, width - 1);

/** Names come from files: markup in them is text. @param {string} text */
const plain = (text) =>
  text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");

/** The dashes of a line. @param {Stroke} stroke */
const dashOf = ({ dash }) => {
  const lengths = dash.split(" ").filter(Boolean);
  return lengths.map((length) => `${Math.max(1.5, Number(length))}px`).join(",") || "solid";
};

/**
 * A ring around a sample.
 * @param {number} n the panel
 * @param {number} x
 * @param {number} y
 */
const ringAround = (n, x, y) => ({
  type: "circle",
  xref: `x${n + 1}`,
  yref: `y${n + 1}`,
  xsizemode: "pixel",
  ysizemode: "pixel",
  xanchor: x,
  yanchor: y,
  x0: -6,
  x1: 6,
  y0: -6,
  y1: 6,
});

/** Axes, lines, areas and words of a figure, as plotly takes them. */
class Frame {
  /**
   * @param {Figure} figure
   * @param {{width: number, height: number}} size on paper
   * @param {number} room for it
   */
  constructor({ plots, words }, size, room) {
    this.plots = plots;
    this.words = words;
    this.size = size;
    this.room = room;
    this.narrow = isNarrow(room, size.width);
    const areas = plots.map(({ area }) => area);
    // What all panels cover.
    this.left = Math.min(...areas.map(({ x }) => x));
    this.top = Math.min(...areas.map(({ y }) => y));
    this.right = Math.max(...areas.map(({ x, width }) => x + width));
    this.lowest = Math.max(...areas.map(({ y, height }) => y + height));
    this.bottom = Math.max(this.lowest, ...plots.map(({ foot }) => foot ?? 0));
  }

  /** The share of the width at a pixel of the paper. @param {number} x */
  across(x) {
    return (x - this.left) / (this.right - this.left);
  }

  /** The share of the height, upwards. @param {number} y */
  up(y) {
    return (this.bottom - y) / (this.bottom - this.top);
  }

  axes() {
    // Several panels in a column share one label, beside the one in the middle.
    const middle = this.plots.some(({ y }) => y.labelled) ? -1 : (this.plots.length - 1) >> 1;
    /** @param {Axis} axis @param {boolean} here whether its label stands here */
    const shared = (axis, here) => ({
      ...LOOK,
      range: [...partOf(axis)],
      title: here ? { text: plain(axis.label), font: { size: 13.5 }, standoff: 8 } : undefined,
    });
    const pairs = this.plots.map(({ area, x, y, foot }, n) => {
      const isLowest = area.y + area.height >= this.lowest - 1;
      const place =
        foot === null ? { anchor: `y${n + 1}` } : { anchor: "free", position: this.up(foot) };
      return [
        [
          `xaxis${n + 1}`,
          {
            ...shared(x, x.labelled || isLowest),
            ...place,
            domain: [this.across(area.x), this.across(area.x + area.width)],
            showticklabels: x.numbered || isLowest,
          },
        ],
        [
          `yaxis${n + 1}`,
          {
            ...shared(y, y.labelled || n === middle),
            anchor: `x${n + 1}`,
            domain: [this.up(area.y + area.height), this.up(area.y)],
          },
        ],
      ];
    });
    return Object.fromEntries(pairs.flat());
  }

  /** Filled areas, and lines across a panel. */
  shapes() {
    const line = (/** @type {Stroke} */ stroke) => ({
      color: stroke.colour,
      width: stroke.width,
      dash: dashOf(stroke),
    });
    const high = (/** @type {Area} */ { y, height }) => ({
      yref: "paper",
      y0: this.up(y + height),
      y1: this.up(y),
    });
    return this.plots.flatMap(({ area, bands, levels, uprights, rings }, n) => {
      const [xref, yref] = [`x${n + 1}`, `y${n + 1}`];
      const wide = {
        xref: "paper",
        x0: this.across(area.x),
        x1: this.across(area.x + area.width),
      };
      const below = { layer: "below" };
      return [
        ...bands.map(([ends, at, fill]) => {
          const [y0, y1] = [this.up(at.y + at.height), this.up(at.y)];
          const path = ends.map(([a, b]) => `M${a},${y0}V${y1}H${b}V${y0}Z`).join("");
          // A pixel wide at least.
          const look = { ...below, fillcolor: fill, line: { width: 1, color: fill } };
          return { type: "path", path, xref, yref: "paper", ...look };
        }),
        ...levels.map(([y, stroke]) => {
          const look = { ...below, line: line(stroke) };
          return { type: "line", ...wide, yref, y0: y, y1: y, ...look };
        }),
        ...uprights.map(([x, stroke]) => {
          return { type: "line", xref, x0: x, x1: x, ...high(area), line: line(stroke) };
        }),
        ...rings.map(([[x, y], stroke]) => ({ ...ringAround(n, x, y), line: line(stroke) })),
      ];
    });
  }

  /** Title and headings. */
  texts() {
    // A narrow page has the title in the caption only, and a remark where its heading leaves room.
    const isTitle = (/** @type {Words} */ { at: [, y] }) => y < this.top - 30;
    const plotted = this.room - this.left - (this.size.width - this.right);
    const fits = (/** @type {Words} */ { at: [x, y], text }) => {
      // Of panels side by side each has its own.
      const own = (/** @type {Words} */ { anchor, at }) => anchor === "start" && at[1] === y && at[0] <= x;
      const heading = this.words.filter(own).sort((a, b) => b.at[0] - a.at[0])[0];
      const letters = (heading?.text.length ?? 0) + text.length;
      const from = heading?.at[0] ?? this.left;
      return letters * 5.4 < plotted * (this.across(x) - this.across(from));
    };
    const stays = (/** @type {Words} */ words) =>
      words.anchor === "end" ? isTitle(words) || fits(words) : !isTitle(words);
    const kept = this.narrow ? this.words.filter(stays) : this.words;
    const said = kept.filter(({ text }) => text);
    return said.map(({ at: [x, y], anchor, size, colour, text }) => {
      const share = Math.min(1, Math.max(0, this.across(x)));
      return {
        text: plain(text),
        font: { size: this.narrow ? 0.8 * size : size, color: colour },
        showarrow: false,
        xref: "paper",
        x: share,
        xanchor: anchor === "end" ? "right" : "left",
        // What stands beside the panels keeps its distance in pixels.
        xshift: share === this.across(x) ? 0 : x - (share === 0 ? this.left : this.right),
        yref: "paper",
        y: 1,
        yanchor: "bottom",
        yshift: this.top - y - 0.25 * size,
      };
    });
  }

  /** What happened at the lines through the panels, in the first one. */
  events() {
    const { area, uprights } = this.plots[0];
    const named = uprights.filter(([, , text]) => text);
    return named.map(([x, , text], n) => ({
      text: plain(text),
      font: { size: 12.5 },
      bgcolor: "rgba(255,255,255,.8)",
      showarrow: false,
      xref: "x1",
      x,
      xanchor: "left",
      xshift: 2,
      yref: "paper",
      y: this.up(area.y),
      yanchor: "top",
      yshift: -14 * (n % 3),
    }));
  }

  layout() {
    const { left, right, top, bottom, narrow } = this;
    const { width, height } = this.size;
    const below = (bottom - height) / (bottom - top);
    const above = 1 + (top - 34) / (bottom - top);
    const isOverTime = this.plots.every(({ lines }) => lines.every(({ forward }) => forward));
    return {
      ...this.axes(),
      annotations: [...this.texts(), ...this.events()],
      font: {
        family: "Arimo, 'Liberation Sans', Arial, Helvetica, sans-serif",
        color: INK,
        size: 13.5,
      },
      margin: {
        l: left,
        r: width - right,
        t: top,
        b: height - bottom + (narrow ? LEGEND : 0),
        autoexpand: false,
      },
      legend: {
        orientation: "h",
        x: 0,
        xanchor: "left",
        y: narrow ? below : above,
        yanchor: "top",
        font: { size: narrow ? 12 : 13.5 },
        // What was chosen stays when the figure is drawn again.
        uirevision: "kept",
      },
      modebar: { uirevision: "kept" },
      hovermode: isOverTime ? "x" : "closest",
      hoverlabel: { namelength: -1 },
      // A finger scrolls the page.
      dragmode: matchMedia("(pointer: coarse)").matches ? false : "zoom",
      paper_bgcolor: "#fff",
      plot_bgcolor: "rgba(0,0,0,0)",
    };
  }
}
