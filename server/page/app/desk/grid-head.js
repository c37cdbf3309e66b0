// Head and tools of a grid: the names of its columns, which of them are shown, what is done with rows.

import { el } from "../dom.js";
import { find } from "./json-tree.js";
import { added, doubled, removed, shifted } from "./rows.js";
import { pathIn } from "./tables.js";

export class GridHead {
  #desk;
  #grid;
  #wanted = new Set();
  #buttons;
  #menu;

  constructor(desk, grid, tools) {
    this.#desk = desk;
    this.#grid = grid;
    const { noun } = grid.table;
    const button = (text, label, act) => el("button", { type: "button", class: "small", "aria-label": label, onclick: act }, text);
    this.#buttons = [
      button("Duplicate", `Duplicate the chosen ${noun}s`, () => this.duplicate()),
      button("Delete", `Delete the chosen ${noun}s`, () => this.remove()),
      button("Up", `Move the chosen ${noun}s up`, () => this.move(-1)),
      button("Down", `Move the chosen ${noun}s down`, () => this.move(1)),
    ];
    this.#menu = el("details", { class: "columns-menu" }, el("summary", {}, "Columns"));
    const optional = grid.table.columns.filter((column) => column.optional);
    this.#menu.append(el("div", { class: "columns-list" }, optional.map((column) => {
      const box = el("input", { type: "checkbox", onchange: () => {
        if (box.checked) this.#wanted.add(column.key);
        else this.#wanted.delete(column.key);
        grid.render();
      } });
      box.dataset.column = column.key;
      return el("label", {}, box, ` ${column.title}`);
    })));
    this.#menu.hidden = optional.length === 0;
    this.#menu.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.#menu.open) return;
      this.#menu.open = false;
      this.#menu.querySelector("summary").focus();
    });
    this.add = this.add.bind(this);
    this.tools = el("div", { class: "tools grid-tools", role: "group", "aria-label": `${grid.table.title}: tools` },
      button(`Add ${noun}`, null, this.add), this.#buttons, tools, this.#menu);
    this.node = el("thead", {});
  }

  /** The columns that rows of some kinds show: what is optional where it holds something or is wanted. */
  visible(rows, kinds) {
    const { table } = this.#grid;
    const { tree } = this.#desk.draft;
    const all = kinds.length ? [...new Set(kinds)] : [table.kindOf({})];
    const isHeld = (column) => rows.some((_, index) => {
      const path = pathIn(column, kinds[index]);
      return path && find(tree, [...table.path, index, ...path]);
    });
    return table.columns.filter((column) => all.some((kind) => pathIn(column, kind))
      && (!column.optional || this.#wanted.has(column.key) || isHeld(column)));
  }

  /** A column is to be shown. */
  want(column) {
    if (!column.optional || this.#wanted.has(column.key)) return;
    this.#wanted.add(column.key);
    this.#grid.render();
  }

  render(columns) {
    const { table } = this.#grid;
    const heads = columns.map((column) => el("th", { scope: "col", title: column.hint },
      column.title, column.unit ? el("span", { class: "unit" }, ` ${column.unit}`) : null));
    if (table.kinds) heads.splice(1, 0, el("th", { scope: "col" }, table.named ? "Given as" : "Towards"));
    this.node.replaceChildren(el("tr", {}, el("th", { scope: "col" }, el("span", { class: "unseen" }, "Row")), heads,
      el("th", { scope: "col" }, el("span", { class: "unseen" }, "Further fields"))));
    for (const box of this.#menu.querySelectorAll("input")) box.checked = columns.some(({ key }) => key === box.dataset.column);
  }

  /** Tells the tools which rows are chosen. */
  choose() {
    const { selection, count } = this.#grid;
    const [low, high] = selection.isEmpty ? [-1, -1] : selection.range;
    const [copy, remove, up, down] = this.#buttons;
    for (const one of [copy, remove]) one.disabled = selection.isEmpty;
    up.disabled = selection.isEmpty || low === 0;
    down.disabled = selection.isEmpty || high === count - 1;
  }

  /** One more row after the last chosen one. */
  add() {
    const { table, selection } = this.#grid;
    const after = selection.isEmpty ? null : selection.range[1];
    const { text, index } = added(this.#desk, table, after);
    this.#desk.draft.edit(text, `add ${table.noun}`);
    selection.set(index);
    this.#grid.focus(index, this.#grid.columns[0].key);
  }

  duplicate() {
    const { table, selection } = this.#grid;
    const [low, high] = selection.range;
    this.#desk.draft.edit(doubled(this.#desk, table, [low, high]), `duplicate ${table.noun}`);
    selection.set(high + 1, high + 1 + high - low);
  }

  remove() {
    const { table, selection } = this.#grid;
    const [low, high] = selection.range;
    this.#desk.draft.edit(removed(this.#desk, table, [low, high]), `delete ${table.noun}`);
    const left = this.#grid.count;
    if (left) selection.set(Math.min(low, left - 1));
    else this.tools.querySelector("button").focus();
  }

  move(by) {
    const { table, selection } = this.#grid;
    if (selection.isEmpty) return;
    const { first, last } = selection;
    const text = shifted(this.#desk, table, selection.range, by);
    if (text === null) return;
    this.#desk.draft.edit(text, `move ${table.noun}`);
    selection.set(first + by, last + by);
  }
}
