// A document pasted, dropped, chosen or taken from the examples, with the places of its problems.

import { request } from "./api.js";
import { el } from "./dom.js";
import { failure } from "./failure.js";
import { characterAt, locate, placeInText } from "./pointer.js";
import { pretty } from "./pretty.js";

/** Lines above the place of a problem that stay in sight. */
const ABOVE = 6;

/** Selects a range of a field and scrolls field and page to it. */
function lookAt(text, [begin, end]) {
  const style = getComputedStyle(text);
  const height = Number.parseFloat(style.lineHeight);
  const before = text.value.slice(0, begin).split("\n");
  const above = Number.parseFloat(style.paddingTop) + (before.length - 1) * height;
  text.focus({ preventScroll: true });
  text.setSelectionRange(begin, end);
  text.scrollTop = Math.max(0, above - ABOVE * height);
  const letter = measure(style.font);
  const left = before.at(-1).length * letter;
  text.scrollLeft = left + letter > text.clientWidth ? left - text.clientWidth / 2 : 0;
  const top = text.getBoundingClientRect().top + text.clientTop + above - text.scrollTop;
  if (top < 0 || top + height > innerHeight) scrollBy({ top: top - innerHeight / 3 });
}

/** Width of a letter of a font whose letters are all equally wide. */
function measure(font) {
  const ink = document.createElement("canvas").getContext("2d");
  ink.font = font;
  return ink.measureText("0").width;
}

/**
 * A field for a JSON document, with buttons and what comes of them below it. `changed` is called with
 * what has been written, pasted or loaded here; `taken` may take another file than a document.
 */
export function editor({ id, label, rows = 24, actions, signal, changed = () => {}, taken = () => false }) {
  const text = el("textarea", {
    id, spellcheck: "false", autocomplete: "off", autocapitalize: "off", wrap: "off", rows: String(rows),
    "aria-describedby": `${id}-note`,
  });
  const outcome = el("div", { class: "outcome", "aria-live": "polite" });
  const file = el("input", {
    type: "file", id: "file", accept: ".json,application/json", class: "unseen",
    onchange: () => take(file.files[0]),
  });

  const lines = el("pre", { class: "lines", "aria-hidden": "true" });
  const renumber = () => {
    const number = text.value.split("\n").length;
    if (Number(lines.dataset.number) === number) return;
    lines.textContent = Array.from({ length: number }, (_, index) => index + 1).join("\n");
    lines.dataset.number = String(number);
    lines.scrollTop = text.scrollTop;
  };
  text.addEventListener("input", () => {
    renumber();
    changed(text.value);
  });
  text.addEventListener("scroll", () => (lines.scrollTop = text.scrollTop));

  const put = (document) => {
    text.value = document;
    renumber();
  };
  const write = (document) => {
    put(document);
    text.scrollTop = 0;
    outcome.replaceChildren();
    changed(document);
  };
  const show = (problem) => {
    const at = placeInText(problem);
    const range = at ? characterAt(text.value, at) : locate(text.value, problem.pointer ?? "");
    if (range) lookAt(text, range);
  };

  async function take(dropped) {
    if (dropped && !taken(dropped)) write(await dropped.text());
  }

  async function load(path) {
    try {
      write(pretty(await (await request(path, { signal })).text()));
    } catch (error) {
      if (!signal.aborted) outcome.replaceChildren(failure(error));
    }
  }

  const zone = el("div", { class: "drop numbered" }, lines, text);
  for (const [kind, over] of [["dragover", true], ["dragleave", false], ["drop", false]]) {
    zone.addEventListener(kind, (event) => {
      event.preventDefault();
      zone.classList.toggle("over", over);
      if (kind === "drop") take(event.dataTransfer.files[0]);
    });
  }
  renumber();
  const node = el(
    "div",
    { class: "editor" },
    el("label", { for: id }, label),
    el("p", { id: `${id}-note`, class: "quiet" },
      "JSON, SI units. Paste it, drop a file on the field, or ",
      el("label", { for: "file", class: "link" }, "choose a file"), file, "."),
    zone,
    el("div", { class: "actions" }, actions),
    outcome,
  );
  return {
    node,
    outcome,
    show,
    load,
    put,
    write,
    loadExample: (name) => load(new URL(`../examples/${name}.json`, import.meta.url).pathname),
    get text() {
      return text.value;
    },
    /** The document in the field; null when it is no JSON. */
    get document() {
      try {
        return JSON.parse(text.value);
      } catch {
        return null;
      }
    },
  };
}

/**
 * Buttons for examples, each [name, title, note]; `choose` is called with a name. `operation` is what
 * takes the document, as "tag/identifier" in the description of the API.
 */
export function examples(list, choose, operation) {
  return [
    el("h2", { id: "examples-title" }, "Examples"),
    el("ul", { class: "examples" }, list.map(([name, title, note]) =>
      el("li", {}, el("button", { type: "button", onclick: () => choose(name), "data-example": name },
        el("strong", {}, title), el("span", {}, note))))),
    el("p", { class: "quiet" }, el("a", { href: `/docs/#/${operation}` }, "All fields"), " are in the API description."),
  ];
}
