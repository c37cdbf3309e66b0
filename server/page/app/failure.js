// What went wrong with a request, and what is doubtful about one that went well.

import { el } from "./dom.js";
import { count } from "./format.js";
import { nameAt, placeInText } from "./pointer.js";

/**
 * A message for a failed request, with all problems of an input; `locate` shows the place of one, and
 * `document`, where it is known, gives the names of targets, `further` another way to the place of one.
 */
export function failure(error, locate, document, further) {
  const items = (error.errors ?? []).map((problem) => item(problem, locate, document, further));
  const doubts = (error.warnings ?? []).map((problem) => item(problem, locate, document, further));
  return el(
    "div",
    { class: "failure", role: "alert" },
    el("p", { class: "failure-title" }, error.title ?? "Something went wrong"),
    items.length ? null : el("p", {}, error.message),
    items.length ? el("ul", {}, items) : null,
    doubts.length ? el("p", {}, count(doubts.length, "warning")) : null,
    doubts.length ? el("ul", {}, doubts) : null,
  );
}

/** A message for a request that succeeded, with the warnings about its input. */
export function success(title, warnings, locate, document, further) {
  return el(
    "div",
    { class: warnings.length ? "success doubtful" : "success", role: "status" },
    el("p", { class: "success-title" }, warnings.length ? `${title}, with ${count(warnings.length, "warning")}` : title),
    warnings.length ? el("ul", {}, warnings.map((warning) => item(warning, locate, document, further))) : null,
  );
}

/** Problems or warnings of an input: target, pointer, message and hint each. */
export function item(problem, locate, document, further) {
  const at = placeInText(problem);
  const place = at ? `line ${at.line}, column ${at.column}` : problem.pointer || "/";
  const pointer = locate
    ? el("button", { type: "button", class: "pointer", onclick: () => locate(problem) }, place)
    : el("code", { class: "pointer" }, place);
  const name = nameAt(problem.pointer, document);
  return el(
    "li",
    {},
    el("span", {}, name ? [el("strong", { class: "named-place" }, name), " "] : null, pointer, further ? [" ", further(problem)] : null),
    el("span", {}, problem.message),
    problem.hint ? el("span", { class: "hint" }, problem.hint) : null,
  );
}
