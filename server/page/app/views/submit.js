// A new plan: a scenario pasted, dropped, chosen or taken from the examples.

import { post, request } from "../api.js";
import { el } from "../dom.js";
import { failure, item } from "../failure.js";
import { count } from "../format.js";
import { locate } from "../pointer.js";

const EXAMPLES = [
  ["two-targets", "Two targets", "settle, dwell and a keep-out cone"],
  ["olivares-a", "Experiment A", "six targets, the published case"],
  ["olivares-b", "Experiment B", "twelve targets"],
  ["olivares-c", "Experiment C", "eighteen targets"],
  ["pyramid-momentum-bias", "Pyramid with bias", "four wheels, stored momentum"],
];

/** The view at "#/new", which may name an example or a plan to start from. */
export function submit({ signal, query }) {
  const text = el("textarea", {
    id: "scenario", spellcheck: "false", autocomplete: "off", autocapitalize: "off", wrap: "off", rows: "24",
    "aria-describedby": "scenario-note",
  });
  const outcome = el("div", { class: "outcome", "aria-live": "polite" });
  const check = el("button", { type: "button", onclick: () => send(true) }, "Check");
  const go = el("button", { type: "button", class: "primary", onclick: () => send(false) }, "Plan");
  const file = el("input", {
    type: "file", id: "file", accept: ".json,application/json", class: "unseen",
    onchange: () => take(file.files[0]),
  });

  const write = (scenario) => {
    text.value = scenario;
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
    text.scrollTop = Math.max(0, (line - 6) * height);
  };

  async function send(only) {
    check.disabled = go.disabled = true;
    try {
      const answer = await post(only ? "/v1/plans?validate_only=true" : "/v1/plans", text.value, signal);
      if (only) outcome.replaceChildren(valid(answer, show));
      else location.hash = `#/plans/${answer.id}`;
    } catch (error) {
      if (!signal.aborted) outcome.replaceChildren(failure(error, show));
    }
    check.disabled = go.disabled = false;
  }

  async function take(dropped) {
    if (dropped) write(await dropped.text());
  }

  async function fetched(path) {
    try {
      write(pretty(await (await request(path, { signal })).text()));
    } catch (error) {
      if (!signal.aborted) outcome.replaceChildren(failure(error));
    }
  }
  const example = (name) => fetched(new URL(`../../examples/${name}.json`, import.meta.url).pathname);

  const zone = el("div", { class: "drop" }, text);
  for (const [kind, over] of [["dragover", true], ["dragleave", false], ["drop", false]]) {
    zone.addEventListener(kind, (event) => {
      event.preventDefault();
      zone.classList.toggle("over", over);
      if (kind === "drop") take(event.dataTransfer.files[0]);
    });
  }
  if (query.get("example")) example(query.get("example"));
  if (query.get("from")) fetched(`/v1/plans/${encodeURIComponent(query.get("from"))}/scenario`);

  return el(
    "div",
    { class: "view" },
    el("div", { class: "title" }, el("h1", {}, "New plan")),
    el(
      "div",
      { class: "split" },
      el(
        "div",
        { class: "editor" },
        el("label", { for: "scenario" }, "Scenario"),
        el("p", { id: "scenario-note", class: "quiet" },
          "JSON, SI units. Paste it, drop a file on the field, or ",
          el("label", { for: "file", class: "link" }, "choose a file"), file, "."),
        zone,
        el("div", { class: "actions" }, go, check),
        outcome,
      ),
      el(
        "aside",
        { "aria-labelledby": "examples-title" },
        el("h2", { id: "examples-title" }, "Examples"),
        el("ul", { class: "examples" }, EXAMPLES.map(([name, title, note]) =>
          el("li", {}, el("button", { type: "button", onclick: () => example(name), "data-example": name },
            el("strong", {}, title), el("span", {}, note))))),
        el("p", { class: "quiet" }, el("a", { href: "/docs/" }, "All fields"), " are in the API description."),
      ),
    ),
  );
}

function valid(answer, show) {
  const warnings = answer.warnings ?? [];
  return el(
    "div",
    { class: "success", role: "status" },
    el("p", { class: "success-title" }, warnings.length ? `Valid, with ${count(warnings.length, "warning")}` : "Valid"),
    warnings.length ? el("ul", {}, warnings.map((warning) => item(warning, show))) : null,
  );
}

/** A scenario that came on one line with short lists and objects on one line each. */
function pretty(text) {
  if (text.trim().includes("\n")) return text;
  const flat = (value) => {
    if (value === null || typeof value !== "object") return JSON.stringify(value);
    if (Array.isArray(value)) return `[${value.map(flat).join(", ")}]`;
    return `{${Object.entries(value).map(([name, item]) => `${JSON.stringify(name)}: ${flat(item)}`).join(", ")}}`;
  };
  const write = (value, indent) => {
    const isPlain = value === null || typeof value !== "object";
    const one = flat(value);
    if (isPlain || one.length + indent.length <= 100) return one;
    const inner = `${indent}  `;
    const parts = Array.isArray(value)
      ? value.map((item) => inner + write(item, inner))
      : Object.entries(value).map(([name, item]) => `${inner}${JSON.stringify(name)}: ${write(item, inner)}`);
    const [open, close] = Array.isArray(value) ? "[]" : "{}";
    return `${open}\n${parts.join(",\n")}\n${indent}${close}`;
  };
  return `${write(JSON.parse(text), "")}\n`;
}
