// The values of a JSON text with their places in it: numbers keep the digits that they are written with.

const SCALAR = /[^\s,\]}]+/y;
const STRING = /"(?:[^"\\]|\\.)*"/y;
const SPACE = /[\s\ufeff]*/y;

/**
 * The value of a text as {kind, begin, end, entries}; null without JSON. `entries` of objects and arrays
 * are {key, begin, node}: `begin` is where the name or the item begins, `key` the name or the index.
 */
export function treeOf(text) {
  try {
    JSON.parse(text.replace(/^\ufeff/, ""));
  } catch {
    return null;
  }
  return new Reader(text).value();
}

/** The node at a path of names and indices; undefined where there is none. */
export function find(node, path) {
  let at = node ?? undefined;
  for (const key of path) {
    // The last one counts where a name is there twice, as in `JSON.parse`.
    at = (at?.kind === "array" ? at.entries[key] : at?.entries?.findLast((entry) => entry.key === key))?.node;
  }
  return at;
}

/** The path of a JSON pointer (RFC 6901). */
export function pathOf(pointer) {
  return pointer.split("/").slice(1).map((part) => part.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** Reads a text that is known to be JSON. */
class Reader {
  constructor(text) {
    this.text = text;
    this.at = 0;
  }

  take(pattern) {
    pattern.lastIndex = this.at;
    const [found] = pattern.exec(this.text);
    this.at += found.length;
    return found;
  }

  value() {
    this.take(SPACE);
    const begin = this.at;
    const opening = this.text[begin];
    if (opening === "{") return this.container("object", "}", begin);
    if (opening === "[") return this.container("array", "]", begin);
    this.take(opening === '"' ? STRING : SCALAR);
    return { kind: opening === '"' ? "string" : "scalar", begin, end: this.at };
  }

  container(kind, closing, begin) {
    const entries = [];
    this.at += 1;
    for (;;) {
      this.take(SPACE);
      if (this.text[this.at] === closing) break;
      if (this.text[this.at] === ",") {
        this.at += 1;
        this.take(SPACE);
      }
      const from = this.at;
      let key = String(entries.length);
      if (kind === "object") {
        key = JSON.parse(this.take(STRING));
        this.take(SPACE);
        this.at += 1;
      }
      entries.push({ key, begin: from, node: this.value() });
    }
    this.at += 1;
    return { kind, begin, end: this.at, entries };
  }
}
