// JSON for people: short lists and objects on one line each.

const WIDTH = 100;

/** A document that came on one line, over several; another one as it is. */
export function pretty(text) {
  if (text.trim().includes("\n")) return text;
  return `${write(JSON.parse(text), "")}\n`;
}

/** A document on one line. */
export function flat(value) {
  if (value === null || typeof value !== "object") return JSON.stringify(value);
  if (Array.isArray(value)) return `[${value.map(flat).join(", ")}]`;
  return `{${Object.entries(value).map(([name, item]) => `${JSON.stringify(name)}: ${flat(item)}`).join(", ")}}`;
}

/** A document over several lines where it is too long for one, all but the first of them indented. */
export function write(value, indent) {
  const isPlain = value === null || typeof value !== "object";
  const one = flat(value);
  if (isPlain || one.length + indent.length <= WIDTH) return one;
  const inner = `${indent}  `;
  const parts = Array.isArray(value)
    ? value.map((item) => inner + write(item, inner))
    : Object.entries(value).map(([name, item]) => `${inner}${JSON.stringify(name)}: ${write(item, inner)}`);
  const [open, close] = Array.isArray(value) ? "[]" : "{}";
  return `${open}\n${parts.join(",\n")}\n${indent}${close}`;
}
