// Draws the figures of a page again, so that they zoom together. Axes of the same quantity show the
// same part of it, a part of the time is shown in the loops too, and the sample that one points at
// is marked in all figures. Paper, and a page without this script, keep the pictures.

/** @type {Drawn[]} */
const drawn = [];

/** Draws what is shown now. */
function everywhere() {
  document.querySelector(".tools .all")?.setAttribute("aria-disabled", String(shown.size === 0));
  for (const figure of drawn) {
    figure.stale = true;
    if (figure.seen) figure.draw();
  }
}

/** @param {Pointed | null} sample */
function point(sample) {
  pointed = sample;
  for (const figure of drawn) {
    if (figure.seen && !figure.stale) figure.remark();
  }
}

function showAll() {
  shown.clear();
  everywhere();
}

/**
 * Shows another part of an axis.
 * @param {Axis} axis
 * @param {number} share of what is shown now
 * @param {number} move by that share of it
 */
function showPart(axis, share, move) {
  const [low, high] = shown.get(axis.key) ?? axis.range;
  const [first, last] = axis.range;
  const whole = last - first;
  const half = Math.min(whole, Math.max((high - low) * share, 1e-6 * whole)) / 2;
  const wanted = (low + high) / 2 + move * (high - low);
  const middle = Math.min(last - half, Math.max(first + half, wanted));
  if (2 * half < whole) shown.set(axis.key, [middle - half, middle + half]);
  else shown.delete(axis.key);
  everywhere();
}

/** Buttons for the time, and for all, which do what a drag does. */
function tools() {
  /** @param {string} sign @param {string} title @param {() => void} onclick */
  const button = (sign, title, onclick) => {
    const made = Object.assign(document.createElement("button"), {
      textContent: sign,
      title,
      onclick,
    });
    if (sign !== title) made.setAttribute("aria-label", title);
    return made;
  };
  const bar = document.createElement("div");
  bar.className = "tools";
  bar.setAttribute("role", "toolbar");
  bar.setAttribute("aria-label", "Part of the figures that is shown");
  const time = figures
    .flatMap(({ plots }) => plots)
    .find(({ lines }) => lines.some(({ forward }) => forward))?.x;
  if (time) {
    bar.append(
      button("+", "Zoom in", () => showPart(time, 0.5, 0)),
      button("−", "Zoom out", () => showPart(time, 2, 0)),
      button("◀", "Earlier", () => showPart(time, 1, -0.25)),
      button("▶", "Later", () => showPart(time, 1, 0.25)),
    );
  }
  const all = button("Show all", "Show all", showAll);
  all.className = "all";
  all.setAttribute("aria-disabled", "true");
  bar.append(all);
  const first = document.querySelector("figure");
  (first?.closest("section") ?? first)?.before(bar);
  // A phone that is turned has another layout.
  matchMedia("(max-width: 44rem)").addEventListener("change", everywhere);
  addEventListener("keydown", ({ key }) => key === "Escape" && showAll());
}

(async () => {
  const { columns, ...page } = JSON.parse(await unpacked("figures"));
  figures.push(...page.figures);
  for (const { plots, series } of figures) {
    plots.forEach(({ lines }, n) => {
      lines.forEach(
        (line, l) => ([line.xs, line.ys] = series[n][l].map((column) => columns[column])),
      );
    });
  }
  const script = Object.assign(document.createElement("script"), {
    textContent: await unpacked("plotly"),
  });
  document.head.append(script);
  if (!plotly()) return;
  drawn.push(...figures.map((figure) => new Drawn(figure)));
  tools();
})();
