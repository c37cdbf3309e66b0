// What went wrong with a request.

import { el } from "./dom.js";

/** A message for a failed request, with all problems of an input; `locate` shows the place of one. */
export function failure(error, locate) {
  const items = (error.errors ?? []).map((problem) => item(problem, locate));
  return el(
    "div",
    { class: "failure", role: "alert" },
    el("p", { class: "failure-title" }, error.title ?? "Something went wrong"),
    items.length ? null : el("p", {}, error.message),
    items.length ? el("ul", {}, items) : null,
  );
}

/** Problems or warnings of an input: pointer, message and hint each. */
export function item(problem, locate) {
  const place = problem.pointer || "/";
  const pointer = locate
    ? el("button", { type: "button", class: "pointer", onclick: () => locate(problem.pointer) }, place)
    : el("code", { class: "pointer" }, place);
  return el(
    "li",
    {},
    pointer,
    el("span", {}, problem.message),
    problem.hint ? el("span", { class: "hint" }, problem.hint) : null,
  );
}
