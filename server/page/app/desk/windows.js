// Windows of a target as they stand in a cell: `60..120 300..360`, or with dates as ISO 8601 has them.
//
// The command line reads tables in the same way.

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
const DATE = /^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d{1,9})?Z?$/;

/** How a cell of windows is written. */
export const WINDOWS_HINT = "from..to, seconds from the start or dates; several with spaces between";

/** The members of one end of a window; null for what is neither a number nor a date. */
function end(name, text) {
  if (DATE.test(text)) return { [name]: text };
  const number = NUMBER.test(text) ? Number(text) : NaN;
  return Number.isFinite(number) ? { [`${name}_s`]: number } : null;
}

/** The windows of a cell, or null where it cannot be read. */
export function windowsOf(cell) {
  const parts = cell.replace(/\s*(\.\.|\/)\s*/g, "$1").split(/[\s;,|]+/).filter(Boolean);
  const windows = parts.map((part) => {
    const ends = part.split(/\.\.|\//);
    const [from, to] = ends.length === 2 ? [end("from", ends[0]), end("to", ends[1])] : [null, null];
    return from && to ? { ...from, ...to } : null;
  });
  return windows.length && !windows.includes(null) ? windows : null;
}

/** Windows as they stand in a cell; null for what is no list of windows. */
export function cellOf(windows) {
  if (!Array.isArray(windows)) return null;
  const texts = windows.map((window) => {
    const [from, to] = [window?.from ?? window?.from_s, window?.to ?? window?.to_s];
    return from === undefined || to === undefined ? null : `${from}..${to}`;
  });
  return texts.includes(null) ? null : texts.join(" ");
}
