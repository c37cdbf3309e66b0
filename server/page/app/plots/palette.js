// What drawings take from the style. Colours of curves; they follow the theme because they are read when something is drawn.

const read = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** The colour of a custom property. */
export const colour = (name) => read(`--${name}`);

/** The colour of the n-th curve. */
export const curve = (index) => read(`--curve-${(index % 6) + 1}`);

/** How much larger letters are than usual: drawn things grow with what the reader has set. */
export const letters = () => Number.parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;

/** Calls back when the theme changes. */
export function onTheme(redraw, signal) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw, { signal });
}
