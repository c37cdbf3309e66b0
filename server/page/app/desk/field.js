// A field of a form: a label and a control for one value of the draft.

import { el } from "../dom.js";
import { control, mark, show, valueAt, write } from "./control.js";
import { problemAt } from "./marks.js";

let number = 0;

/**
 * A field for a column. `pathOf` gives its path in the draft, or nothing while there is no such value;
 * `also` says what is known of its number in other units, `written` replaces how it is written.
 */
export function field(desk, column, pathOf, { also, written } = {}) {
  const id = `field-${(number += 1)}`;
  const input = control(column, (value) => {
    const path = pathOf();
    if (written) written(value);
    else write(desk.draft, path, column, value, column.title.toLowerCase());
  });
  input.id = id;
  const note = el("span", { class: "field-note", id: `${id}-note` });
  input.setAttribute("aria-describedby", note.id);
  input.addEventListener("blur", () => desk.draft.settle());
  const node = el("div", { class: column.wide ? "field wide" : "field" },
    el("label", { for: id }, column.title, column.unit ? el("span", { class: "unit" }, ` ${column.unit}`) : null), input, note);

  const say = (path) => {
    const [error, warning] = [desk.checking.errors, desk.checking.warnings].map((list) => problemAt(list.filter(({ pointer }) => pointer), path));
    mark(input, error ?? warning, !error);
    note.classList.toggle("is-problem", Boolean(error ?? warning));
    note.textContent = (error ?? warning)?.message ?? (input.value && also ? also(input.value) : column.hint ?? "");
  };
  const render = () => {
    if (!desk.draft.isReadable) return;
    const path = pathOf();
    node.hidden = !path;
    if (!path) return;
    show(input, column, valueAt(desk.draft, path, column));
    say(path);
  };
  desk.draft.listen(render, desk.signal);
  desk.checking.listen(() => {
    const path = desk.draft.isReadable && pathOf();
    if (path) say(path);
  });
  desk.listen(render);
  render();
  return node;
}

/** A group of fields under a name. */
export function group(name, ...nodes) {
  return el("fieldset", {}, el("legend", {}, name), el("div", { class: "fields" }, nodes));
}

/**
 * A choice that is not a value of its own, as {node, offer, show}; `chosen` is called with what is chosen,
 * `offer` takes other options.
 */
export function choice(label, options, chosen) {
  const id = `field-${(number += 1)}`;
  const input = el("select", { id, onchange: () => chosen(input.value) }, options.map(([value, title]) => el("option", { value }, title)));
  const node = el("div", { class: "field wide" }, el("label", { for: id }, label), input);
  const offer = (list) => {
    const key = JSON.stringify(list);
    if (input.dataset.offered === key) return;
    input.dataset.offered = key;
    input.replaceChildren(...list.map(([value, title]) => el("option", { value }, title)));
  };
  return { node, offer, show: (value) => (input.value = value) };
}
