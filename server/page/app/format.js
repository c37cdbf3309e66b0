// Numbers as people read them. What does not exist is a dash.

const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const DASH = "–";
const known = (value) => typeof value === "number" && Number.isFinite(value);

/** A number with so many digits after the point. */
export function fixed(value, digits = 2) {
  if (!known(value)) return DASH;
  const text = value.toFixed(digits);
  // A zero has no sign, whatever was rounded to it.
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/** A difference as it was written, with the sign that it lacks when it is positive. */
export function signed(text) {
  return /^[^−–-]*[1-9]/.test(text) ? `+${text}` : text;
}

/** Seconds with their unit. */
export function seconds(value, digits = 2) {
  return known(value) ? `${fixed(value, digits)} s` : DASH;
}

/** A ratio in percent. */
export function percent(value, digits = 2) {
  return known(value) ? `${fixed(100 * value, digits)} %` : DASH;
}

/** A small number in scientific form, zero as such. */
export function small(value) {
  if (!known(value)) return DASH;
  if (value === 0) return "0";
  return raised(value, 1);
}

function raised(value, digits) {
  const [shown, exponent] = value.toExponential(digits).split("e");
  const power = [...exponent.replace("+", "")].map((sign) => RAISED[sign]).join("");
  return `${shown.replace("-", "−")}·10${power}`;
}

/** A number of any size with so many digits that count. */
export function significant(value, digits = 4) {
  if (!known(value)) return DASH;
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return raised(value, digits - 1).replace(/\.?0+·/, "·");
  return String(Number(value.toPrecision(Math.max(digits, String(Math.trunc(size)).length)))).replace("-", "−");
}

/** A moment in the time of the reader, with its date. */
export function moment(text) {
  if (!text) return DASH;
  const time = { hour: "2-digit", minute: "2-digit", second: "2-digit", hour12: false };
  const date = { year: "numeric", month: "short", day: "numeric" };
  return new Date(text).toLocaleString("en-GB", { ...date, ...time });
}

/** A count with its noun. */
export function count(number, noun) {
  return `${number} ${noun}${number === 1 ? "" : "s"}`;
}
