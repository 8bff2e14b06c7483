// A figure, drawn again by plotly.js as it is on paper.

/** @returns {any} */
const plotly = () => /** @type {any} */ (globalThis).Plotly;

/**
 * A line as plotly takes it.
 * @param {Line} line
 * @param {number} n of its plot
 * @param {boolean} listed in the legend
 */
const trace = (line, n, listed) => {
  let { xs, ys } = line;
  const part = line.forward ? null : windowOf(line.samples);
  if (part)
    [xs, ys] = [xs, ys].map((values) =>
      values.slice(placeOf(line, part[0]), placeOf(line, part[1]) + 1),
    );
  return {
    type: "scatter",
    mode: xs.length === 1 ? "markers" : "lines",
    x: xs,
    y: ys,
    xaxis: `x${n + 1}`,
    yaxis: `y${n + 1}`,
    name: plain(line.name),
    legendgroup: plain(line.name),
    showlegend: listed,
    line: { color: line.stroke.colour, width: line.stroke.width, dash: dashOf(line.stroke) },
    fill: line.fill ? "tonexty" : "none",
    fillcolor: line.fill ?? undefined,
    hoverinfo: line.name ? "all" : "skip",
    connectgaps: false,
  };
};

/**
 * The area between two lines on which x goes back. Its pieces all turn the same way: one that turns
 * the other way would be a hole.
 * @param {any} upper
 * @param {any} lower
 */
const between = (upper, lower) => {
  /** @type {(number | null)[]} */
  const xs = [];
  /** @type {(number | null)[]} */
  const ys = [];
  for (let k = 0; k + 1 < upper.x.length; k++) {
    if (upper.y[k] === null || upper.y[k + 1] === null) continue;
    const [a, b] = upper.x[k] <= upper.x[k + 1] ? [k, k + 1] : [k + 1, k];
    xs.push(upper.x[a], upper.x[b], upper.x[b], upper.x[a], null);
    ys.push(lower.y[a], lower.y[b], upper.y[b], upper.y[a], null);
  }
  return { ...upper, x: xs, y: ys, fill: "toself", line: { width: 0 } };
};

/** A figure: its picture, and the node that it is drawn in. */
class Drawn {
  /** @param {Figure} figure */
  constructor(figure) {
    this.figure = figure;
    const frame = /** @type {HTMLElement} */ (document.getElementById(figure.id));
    const svg = /** @type {SVGSVGElement} */ (frame.querySelector("svg"));
    this.size = {
      width: Number(svg.getAttribute("width")),
      height: Number(svg.getAttribute("height")),
    };
    this.node = /** @type {any} */ (document.createElement("div"));
    this.node.className = "plot";
    this.node.setAttribute("role", "img");
    this.node.setAttribute("aria-label", svg.getAttribute("aria-label") ?? "");
    this.node.style.height = `${this.size.height}px`;
    // What is over time takes the width that there is.
    const isOverTime = figure.plots.every(({ lines }) => lines.every(({ forward }) => forward));
    if (!isOverTime) this.node.style.maxWidth = `${this.size.width}px`;
    svg.after(this.node);
    frame.classList.add("live");
    this.seen = false;
    /** The sample that is marked here. @type {Pointed | null} */
    this.marked = null;
    /** @type {object[]} */
    this.shapes = [];
    new IntersectionObserver(
      (entries) => {
        this.seen = entries[entries.length - 1].isIntersecting;
        if (!this.seen) return;
        if (this.stale) this.draw();
        else if (this.marked !== pointed) this.remark();
      },
      { rootMargin: "300px" },
    ).observe(this.node);
    this.stale = true;
  }

  /** Whether it still has to be drawn as it should be shown now. */
  get stale() {
    return this.node.dataset.stale === "true";
  }
  set stale(stale) {
    this.node.dataset.stale = String(stale);
  }

  traces() {
    const listed = new Set();
    const { plots, areas } = this.figure;
    const lines = plots.flatMap(({ lines }, n) =>
      lines.map((line, l) => {
        const first = line.name !== "" && !listed.has(line.name);
        listed.add(line.name);
        const drawn = trace(line, n, first);
        // An area that turns back, or has gaps, needs the line before it once more.
        const isWhole = line.forward && !drawn.y.includes(null);
        return line.fill && !isWhole ? between(drawn, trace(lines[l - 1], n, false)) : drawn;
      }),
    );
    // Areas and marks have no line of samples: these are for the legend alone.
    const keys = areas.map(([fill, name]) => ({
      type: "scatter",
      mode: "markers",
      x: [null],
      y: [null],
      xaxis: "x1",
      yaxis: "y1",
      name: plain(name),
      marker: { symbol: "square", size: 12, color: fill, line: { width: 0.5, color: AXIS } },
    }));
    return [...lines, ...keys];
  }

  /** Marks of the sample that is pointed at. */
  marks() {
    this.marked = pointed;
    if (!pointed || !isRecording(pointed.samples)) return [];
    const { sample, samples } = pointed;
    const lines = this.figure.plots.flatMap(({ lines }, n) => lines.map((line) => ({ line, n })));
    return lines.flatMap(({ line, n }) => {
      if (!line.name || line.samples !== samples) return [];
      const at = placeOf(line, sample);
      const [x, y] = [line.xs[at], line.ys[at]];
      if (x == null || y == null) return [];
      return [
        {
          ...ringAround(n, x, y),
          line: { color: "#b0588a", width: 2.5 },
        },
      ];
    });
  }

  /** Replaces the marks. */
  remark() {
    plotly().relayout(this.node, { shapes: [...this.shapes, ...this.marks()] });
  }

  draw() {
    this.stale = false;
    const narrow = isNarrow(this.node.clientWidth, this.size.width);
    this.node.style.height = `${this.size.height + (narrow ? LEGEND : 0)}px`;
    const config = {
      responsive: true,
      displaylogo: false,
      displayModeBar: !narrow,
      modeBarButtons: [["zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "toImage"]],
      doubleClick: false,
      toImageButtonOptions: { filename: this.figure.id, scale: 2 },
    };
    const page = new Frame(this.figure, this.size, this.node.clientWidth);
    this.shapes = page.shapes();
    const layout = { ...page.layout(), shapes: [...this.shapes, ...this.marks()] };
    const begun = Boolean(this.node.layout);
    plotly().react(this.node, this.traces(), layout, config);
    if (!begun) this.listen();
  }

  listen() {
    this.node.on("plotly_relayout", (/** @type {any} */ event) => {
      let changed = false;
      this.figure.plots.forEach(({ x, y }, n) => {
        for (const [axis, name] of /** @type {[Axis, string][]} */ ([
          [x, `xaxis${n ? n + 1 : ""}`],
          [y, `yaxis${n ? n + 1 : ""}`],
        ])) {
          const [low, high] = [event[`${name}.range[0]`], event[`${name}.range[1]`]];
          if (low === undefined || high === undefined) continue;
          shown.set(axis.key, [low, high]);
          changed = true;
        }
      });
      if (changed) everywhere();
    });
    this.node.on("plotly_doubleclick", showAll);
    this.node.on("plotly_hover", (/** @type {any} */ { points: [{ curveNumber, pointIndex }] }) => {
      const lines = this.figure.plots.flatMap(({ lines }) => lines);
      const line = lines[curveNumber];
      if (!line) return;
      const from = line.forward ? 0 : placeOf(line, windowOf(line.samples)?.[0] ?? 0);
      point({ sample: sampleAt(line, pointIndex + from), samples: line.samples });
    });
    this.node.on("plotly_unhover", () => point(null));
  }
}
