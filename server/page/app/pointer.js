// Where a JSON pointer (RFC 6901) leads to in a text.

/** Begin and end of the value at a pointer, of the deepest one that exists; null without JSON. */
export function locate(text, pointer) {
  const path = pointer.split("/").slice(1).map((part) => part.replaceAll("~1", "/").replaceAll("~0", "~"));
  const scanner = new Scanner(text);
  try {
    return scanner.find(path);
  } catch {
    return null;
  }
}

/** Line and column of a text that is not valid JSON, both counted from 1; null for another problem. */
export function placeInText({ code, message }) {
  const [, line, column] = (code === "malformed_json" && /^line (\d+), column (\d+)/.exec(message)) || [];
  return line ? { line: Number(line), column: Number(column) } : null;
}

/** Begin and end of the character at a line and a column, which counts bytes as the service does. */
export function characterAt(text, { line, column }) {
  const lines = text.split("\n");
  const index = Math.min(line, lines.length) - 1;
  const begin = lines.slice(0, index).reduce((length, one) => length + one.length + 1, 0);
  const bytes = new TextEncoder().encode(lines[index]).slice(0, column);
  const end = Math.min(begin + Math.max(1, new TextDecoder().decode(bytes).length), text.length);
  return [Math.max(0, end - 1), end];
}

/** What a pointer leads to or into, by its name in a document: a target; null where it has none. */
export function nameAt(pointer, document) {
  const [, whole, index] = /^((?:\/scenario)?)\/targets\/(\d+)(?:\/|$)/.exec(pointer ?? "") ?? [];
  const targets = (whole ? document?.scenario : document)?.targets;
  const id = Array.isArray(targets) ? targets[index]?.id : undefined;
  return typeof id === "string" && id ? `target ${id}` : null;
}

class Scanner {
  constructor(text) {
    this.text = text;
    this.at = 0;
  }

  space() {
    while (/[\s\ufeff]/.test(this.text[this.at] ?? "")) this.at += 1;
    if (this.at >= this.text.length) throw new Error("the text ends");
  }

  /** The range of the value that begins here, or of what the path leads to inside. */
  find(path) {
    this.space();
    const begin = this.at;
    const opening = this.text[begin];
    let found = null;
    if (opening === "{" || opening === "[") {
      this.at += 1;
      for (let index = 0; ; index += 1) {
        this.space();
        if (this.text[this.at] === (opening === "{" ? "}" : "]")) break;
        const name = opening === "{" ? this.name() : String(index);
        const wanted = found === null && path.length > 0 && name === path[0];
        const range = this.find(wanted ? path.slice(1) : []);
        if (wanted) found = range;
        this.space();
        if (this.text[this.at] === ",") this.at += 1;
      }
      this.at += 1;
    } else if (opening === '"') {
      this.string();
    } else {
      const scalar = /[^\s,\]}]+/y;
      scalar.lastIndex = this.at;
      this.at += scalar.exec(this.text)[0].length;
    }
    return found ?? [begin, this.at];
  }

  name() {
    const name = this.string();
    this.space();
    if (this.text[this.at] !== ":") throw new Error("a colon is missing");
    this.at += 1;
    return name;
  }

  string() {
    const string = /"(?:[^"\\]|\\.)*"/y;
    string.lastIndex = this.at;
    const [found] = string.exec(this.text);
    this.at += found.length;
    return JSON.parse(found);
  }
}
