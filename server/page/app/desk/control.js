// One cell or field: an input or a choice that shows a value of the draft and writes it.

import { el } from "../dom.js";
import { cellAt, withCell, written } from "./cells.js";

const BORESIGHTS_LIST = "boresight-names";

/** The control of a column or field; `changed` is called with what was written. */
export function control(column, changed) {
  const attributes = { autocomplete: "off", spellcheck: "false" };
  const choices = column.options && [["", column.unset ?? ""], ...column.options];
  const node = choices
    ? el("select", {}, choices.map(([value, title]) => el("option", { value }, title)))
    : el("input", {
      type: "text", ...attributes, inputmode: column.type === "number" ? "decimal" : null,
      list: column.type === "boresight" ? BORESIGHTS_LIST : null, placeholder: column.placeholder,
    });
  node.addEventListener(choices ? "change" : "input", () => changed(node.value));
  return node;
}

/** Shows a value, unless it is what somebody is writing here. */
export function show(node, column, value) {
  if (column.options) {
    if (![...node.options].some((option) => option.value === value)) node.append(el("option", { value }, value));
    node.value = value;
    return;
  }
  if (node.value === value) return;
  if (node === document.activeElement && written(column.type, node.value) === written(column.type, value)) return;
  node.value = value;
}

/** The names that fields of boresights offer. */
export function boresightNames(desk) {
  const list = el("datalist", { id: BORESIGHTS_LIST });
  const render = () => {
    const named = Array.isArray(desk.spacecraft?.boresights) ? desk.spacecraft.boresights : [];
    list.replaceChildren(...named.map((one) => el("option", { value: String(one?.name ?? "") })));
  };
  desk.draft.listen(render, desk.signal);
  desk.listen(render);
  render();
  return list;
}

/** What a column shows at a path of the draft. */
export function valueAt(draft, path, column) {
  return cellAt(draft.text, draft.tree, path, column.type);
}

/** Writes a cell into the draft; what is written letter by letter is one step of its history. */
export function write(draft, path, column, cell, what) {
  draft.edit(withCell(draft.text, draft.tree, path, column, cell), what, column.options ? null : `cell ${path.join("/")}`);
}

/** Marks a control with what is wrong in it; null for nothing. */
export function mark(node, problem, isWarning = false) {
  node.classList.toggle("wrong", Boolean(problem) && !isWarning);
  node.classList.toggle("doubtful", Boolean(problem) && isWarning);
  if (problem && !isWarning) node.setAttribute("aria-invalid", "true");
  else node.removeAttribute("aria-invalid");
  node.title = problem ? problem.message : "";
}
