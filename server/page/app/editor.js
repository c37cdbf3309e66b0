// A document pasted, dropped, chosen or taken from the examples, with the places of its problems.

import { request } from "./api.js";
import { el } from "./dom.js";
import { failure } from "./failure.js";
import { locate } from "./pointer.js";
import { pretty } from "./pretty.js";

/** Lines above the place of a problem that stay in sight. */
const ABOVE = 6;

/** A field for a JSON document, with buttons and what comes of them below it. */
export function editor({ id, label, rows = 24, actions, signal }) {
  const text = el("textarea", {
    id, spellcheck: "false", autocomplete: "off", autocapitalize: "off", wrap: "off", rows: String(rows),
    "aria-describedby": `${id}-note`,
  });
  const outcome = el("div", { class: "outcome", "aria-live": "polite" });
  const file = el("input", {
    type: "file", id: "file", accept: ".json,application/json", class: "unseen",
    onchange: () => take(file.files[0]),
  });

  const write = (document) => {
    text.value = document;
    text.scrollTop = 0;
    outcome.replaceChildren();
  };
  const show = (pointer) => {
    const range = locate(text.value, pointer ?? "");
    if (!range) return;
    text.focus();
    text.setSelectionRange(...range);
    const line = text.value.slice(0, range[0]).split("\n").length;
    const height = text.scrollHeight / text.value.split("\n").length;
    text.scrollTop = Math.max(0, (line - ABOVE) * height);
  };

  async function take(dropped) {
    if (dropped) write(await dropped.text());
  }

  async function load(path) {
    try {
      write(pretty(await (await request(path, { signal })).text()));
    } catch (error) {
      if (!signal.aborted) outcome.replaceChildren(failure(error));
    }
  }

  const zone = el("div", { class: "drop" }, text);
  for (const [kind, over] of [["dragover", true], ["dragleave", false], ["drop", false]]) {
    zone.addEventListener(kind, (event) => {
      event.preventDefault();
      zone.classList.toggle("over", over);
      if (kind === "drop") take(event.dataTransfer.files[0]);
    });
  }
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
    loadExample: (name) => load(new URL(`../examples/${name}.json`, import.meta.url).pathname),
    get text() {
      return text.value;
    },
  };
}

/** Buttons for examples, each [name, title, note]; `choose` is called with a name. */
export function examples(list, choose) {
  return [
    el("h2", { id: "examples-title" }, "Examples"),
    el("ul", { class: "examples" }, list.map(([name, title, note]) =>
      el("li", {}, el("button", { type: "button", onclick: () => choose(name), "data-example": name },
        el("strong", {}, title), el("span", {}, note))))),
    el("p", { class: "quiet" }, el("a", { href: "/docs/" }, "All fields"), " are in the API description."),
  ];
}
