// Light or dark: as the system has it, until the user chooses. The browser keeps the choice.

import { by } from "./dom.js";

const SYSTEM = matchMedia("(prefers-color-scheme: dark)");

/** Where the browser keeps nothing, the choice lasts as long as the page. */
const kept = {
  /** @returns {string | null} */
  get theme() {
    try {
      return localStorage.getItem("hysteron-theme");
    } catch {
      return null;
    }
  },
  set theme(theme) {
    try {
      localStorage.setItem("hysteron-theme", String(theme));
    } catch {
      // It is not kept.
    }
  },
};

/** @param {string} theme */
function take(theme) {
  document.documentElement.dataset.theme = theme;
  by("theme").textContent = theme === "dark" ? "Light" : "Dark";
}

/** @param {() => void} changed */
export function start(changed) {
  const system = () => (SYSTEM.matches ? "dark" : "light");
  take(kept.theme ?? system());
  by("theme").addEventListener("click", () => {
    const other = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    kept.theme = other;
    take(other);
    changed();
  });
  SYSTEM.addEventListener("change", () => {
    if (kept.theme) return;
    take(system());
    changed();
  });
}
