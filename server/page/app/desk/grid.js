// A table of the scenario that is written in: one row for each item, one control for each cell.

import { el, scroller } from "../dom.js";
import { control, mark, show, valueAt, write } from "./control.js";
import { GridHead } from "./grid-head.js";
import { listenToGrid } from "./grid-keys.js";
import { byRow, problemAt } from "./marks.js";
import { rekinded, rowsOf, withBlock } from "./rows.js";
import { lengthIn, pathIn } from "./tables.js";

/** Rows that are shown at once. */
const PAGE = 100;
const HELP = "Arrow keys go from cell to cell, Enter to the next row, Alt with up or down moves a row.";

export class Grid {
  #desk;
  #lines = [];
  #columns = [];
  #shape = "";
  #from = 0;
  #head;
  #body = el("tbody", {});
  #table;
  #note;
  #empty;
  #pager;
  #scroller;

  /** A grid of a table of the desk; `empty` is shown without rows, `tools` are further buttons. */
  constructor(desk, table, { empty = "", tools = [], selection }) {
    this.#desk = desk;
    this.table = table;
    this.selection = selection;
    const id = `grid-${table.key}`;
    this.#note = el("p", { class: "quiet cell-note", id: `${id}-note` });
    this.#head = new GridHead(desk, this, tools);
    this.#table = el("table", { class: "grid" }, el("caption", { class: "unseen" }, table.title), this.#head.node, this.#body);
    this.#empty = el("p", { class: "quiet grid-empty" }, empty);
    this.#pager = el("div", { class: "actions pager", hidden: true },
      el("button", { type: "button", class: "small", onclick: () => this.#turn(-PAGE) }, "Rows before"),
      el("span", { class: "quiet" }),
      el("button", { type: "button", class: "small", onclick: () => this.#turn(PAGE) }, "Rows after"));
    this.#scroller = scroller(`Table of ${table.title.toLowerCase()}`, this.#table);
    this.node = el("div", { class: "grid-part" }, this.#head.tools, this.#empty, this.#scroller, this.#pager, this.#note);
    this.#body.addEventListener("focusin", (event) => this.#focused(event.target));
    this.#body.addEventListener("focusout", () => {
      desk.draft.settle();
      this.#note.textContent = "";
    });
    listenToGrid(this.#body, this);
    desk.draft.listen(() => this.render(), desk.signal);
    desk.checking.listen(() => desk.checking.isPending || this.#mark());
    selection.listen(() => this.#choose(), desk.signal);
    this.render();
  }

  get columns() {
    return this.#columns;
  }

  get count() {
    return rowsOf(this.#desk.document, this.table).length;
  }

  /** Shows the draft as it is now. */
  render() {
    const { draft, document } = this.#desk;
    if (!draft.isReadable) return;
    const rows = rowsOf(document, this.table);
    const kinds = rows.map((row) => this.table.kindOf(row ?? {}));
    this.#columns = this.#head.visible(rows, kinds);
    const shape = this.#columns.map(({ key }) => key).join();
    if (shape !== this.#shape) {
      const place = this.#place();
      this.#shape = shape;
      this.#head.render(this.#columns);
      this.#lines = [];
      this.#body.replaceChildren();
      requestAnimationFrame(() => place && !this.#body.contains(globalThis.document.activeElement) && this.focus(...place));
    }
    this.#from = Math.max(0, Math.min(this.#from, Math.floor((rows.length - 1) / PAGE) * PAGE));
    const seen = rows.slice(this.#from, this.#from + PAGE);
    while (this.#lines.length > seen.length) this.#lines.pop().node.remove();
    while (this.#lines.length < seen.length) this.#grow();
    seen.forEach((row, offset) => this.#fill(this.#lines[offset], row ?? {}, this.#from + offset, kinds[this.#from + offset]));
    this.#empty.hidden = rows.length > 0;
    this.#scroller.hidden = rows.length === 0;
    this.#pager.hidden = rows.length <= PAGE;
    this.#pager.children[1].textContent = `${this.#from + 1} to ${this.#from + seen.length} of ${rows.length}`;
    if (!this.selection.isEmpty && Math.max(this.selection.first, this.selection.last) >= rows.length) this.selection.clear();
    this.#choose();
    this.#mark();
  }

  /** Leads to a cell; to the next one that the row has, where it has no such column. */
  focus(index, key) {
    if (index < 0 || index >= this.count) return false;
    if (index < this.#from || index >= this.#from + PAGE) {
      this.#from = Math.floor(index / PAGE) * PAGE;
      this.render();
    }
    const { cells } = this.#lines[index - this.#from];
    const begin = Math.max(0, this.#columns.findIndex((column) => column.key === key));
    const order = [...this.#columns.slice(begin), ...this.#columns.slice(0, begin).reverse()];
    const found = key === "kind" ? cells.get("kind") : order.map((column) => cells.get(column.key)).find((cell) => cell?.control);
    if (!found?.control) return false;
    found.control.focus();
    found.control.select?.();
    return true;
  }

  /** Leads to the cell that a pointer means; false where there is none. */
  lead(pointer) {
    const place = this.#meant(pointer);
    if (!place) return false;
    if (place.column) this.#head.want(place.column);
    return this.focus(place.index, place.column?.key ?? "kind");
  }

  /** Whether there is a cell that a pointer means. */
  has(pointer) {
    return this.#meant(pointer) !== null;
  }

  #meant(pointer) {
    const { path, columns, kindOf } = this.table;
    const begin = `/${path.join("/")}/`;
    const index = pointer.startsWith(begin) ? Number(pointer.slice(begin.length).split("/")[0]) : -1;
    const row = rowsOf(this.#desk.document, this.table)[index];
    if (!row) return null;
    const kind = kindOf(row);
    const column = columns.find((one) => {
      const own = pathIn(one, kind);
      return own && problemAt([{ pointer }], [...path, index, ...own]);
    });
    return { index, column };
  }

  /** Where a control is, as [index, key]; null outside. */
  placeOf(node) {
    const at = node.closest?.("[data-key]");
    return at ? [this.#from + [...this.#body.children].indexOf(at.closest("tr")), at.dataset.key] : null;
  }

  /** Writes a block of cells from a place on. */
  paste([index, key], block) {
    const column = Math.max(0, this.#columns.findIndex((one) => one.key === key));
    const { text, left } = withBlock(this.#desk, this.table, this.#columns, [index, column], block);
    this.#desk.draft.edit(text, "paste");
    this.#note.textContent = left ? `${left} of the pasted cells have no place in these rows and columns.` : "Pasted.";
  }

  /** One more row after the chosen one, with the focus in a column of it. */
  add(key) {
    this.#head.add();
    this.focus(this.selection.last, key);
  }

  /** Moves the chosen rows up (-1) or down (1). */
  move(by) {
    this.#head.move(by);
  }

  /** All rows as they are shown, with their heads, for a spreadsheet. */
  asTable() {
    const lines = rowsOf(this.#desk.document, this.table).map((row, index) => this.#columns.map((column) => {
      const path = pathIn(column, this.table.kindOf(row ?? {}));
      return path ? valueAt(this.#desk.draft, [...this.table.path, index, ...path], column).replace(/[\t\r\n]/g, " ") : "";
    }));
    return [this.#columns.map(({ key }) => key), ...lines].map((line) => line.join("\t")).join("\n");
  }

  #turn(by) {
    this.#from += by;
    this.render();
  }

  #grow() {
    const number = el("button", { type: "button", class: "plain row-number" });
    const line = { node: el("tr", {}, el("td", { class: "row-head" }, number)), number, cells: new Map() };
    number.addEventListener("click", (event) => {
      const index = this.#from + this.#lines.indexOf(line);
      if (event.shiftKey && !this.selection.isEmpty) this.selection.set(this.selection.first, index);
      else this.selection.set(index);
    });
    const keys = this.#columns.map(({ key }) => key);
    // The kind of a row stands beside its name.
    if (this.table.kinds) keys.splice(1, 0, "kind");
    for (const key of keys) {
      const cell = { node: el("td", { "data-key": key }), control: null, kind: null };
      line.cells.set(key, cell);
      line.node.append(cell.node);
    }
    line.node.append(el("td", { class: "more-fields" }));
    this.#lines.push(line);
    this.#body.append(line.node);
  }

  #fill(line, row, index, kind) {
    const { draft } = this.#desk;
    const place = [...this.table.path, index];
    const name = String(row[this.table.named] ?? `${this.table.noun} ${index + 1}`);
    line.number.textContent = String(index + 1);
    line.number.setAttribute("aria-label", `Choose row ${index + 1}, ${name}`);
    for (const column of this.#columns) {
      const cell = line.cells.get(column.key);
      const path = pathIn(column, kind);
      const own = { ...column, length: lengthIn(column, kind) };
      if (!path !== !cell.control) {
        cell.control = path ? control(column, (value) => cell.write(value)) : null;
        cell.node.replaceChildren(cell.control ?? "");
        cell.node.className = [column.type, column.wide && "wide", column.head && "name", !path && "absent"].filter(Boolean).join(" ");
      }
      if (!path) continue;
      cell.path = [...place, ...path];
      cell.write = (value) => write(draft, cell.path, own, value, `${column.title} of ${name}`);
      cell.control.setAttribute("aria-label", `${column.title}${column.unit ? `, ${column.unit}` : ""} of ${name}`);
      show(cell.control, column, valueAt(draft, cell.path, column));
    }
    if (this.table.kinds) this.#fillKind(line.cells.get("kind"), index, kind, name);
    this.#fillRest(line.node.lastChild, row, index, kind, name);
  }

  #fillKind(cell, index, kind, name) {
    const known = this.table.kinds.some(([key]) => key === kind);
    cell.control ??= control({ options: this.table.kinds, unset: "–", type: "choice" }, (value) => cell.write(value));
    if (!cell.node.firstChild) cell.node.append(cell.control);
    cell.path = null;
    cell.write = (value) => value && this.#desk.draft.edit(rekinded(this.#desk, this.table, index, value), `kind of ${name}`);
    cell.control.setAttribute("aria-label", `Kind of ${name}`);
    show(cell.control, { options: this.table.kinds }, known ? kind : "");
  }

  /** What a row has that no column shows leads to its place in the JSON. */
  #fillRest(node, row, index, kind, name) {
    const shown = new Set([...this.table.members, ...this.table.columns.map((column) => pathIn(column, kind)?.[0])]);
    const others = Object.keys(row).filter((member) => !shown.has(member));
    if (node.dataset.others === others.join() && node.dataset.row === String(index)) return;
    [node.dataset.others, node.dataset.row] = [others.join(), String(index)];
    node.replaceChildren(others.length ? el("button", {
      type: "button", class: "small", "aria-label": `Further fields of ${name} in the JSON: ${others.join(", ")}`, title: others.join(", "),
      onclick: () => this.#desk.showInText(`/${[...this.table.path, index, others[0]].join("/")}`),
    }, `+${others.length}`) : "");
  }

  #mark() {
    const { checking } = this.#desk;
    const [errors, warnings] = [checking.errors, checking.warnings].map((list) => byRow(list, this.table.path));
    for (const [offset, { node, cells }] of this.#lines.entries()) {
      const [wrong, doubtful] = [errors, warnings].map((rows) => rows.get(this.#from + offset));
      node.classList.toggle("has-problem", Boolean(wrong));
      for (const [key, { control: input, path }] of cells) {
        if (!input) continue;
        const whole = key === "kind" && [wrong, doubtful].map((list) => list?.find(({ pointer }) =>
          [[], ...this.table.members.map((member) => [member])].some((rest) => pointer === `/${[...this.table.path, this.#from + offset, ...rest].join("/")}`)));
        const error = whole ? whole[0] : path && problemAt(wrong, path);
        mark(input, error || (whole ? whole[1] : path && problemAt(doubtful, path)), !error);
      }
    }
    this.#say(globalThis.document.activeElement);
  }

  #choose() {
    for (const [offset, { node, number, cells }] of this.#lines.entries()) {
      const index = this.#from + offset;
      const isChosen = this.selection.has(index);
      const isReached = this.selection.isEmpty ? index === this.#from : index === this.selection.last;
      node.classList.toggle("chosen", isChosen);
      number.setAttribute("aria-pressed", String(isChosen));
      for (const one of [number, ...[...cells.values()].map((cell) => cell.control)]) if (one) one.tabIndex = isReached ? 0 : -1;
    }
    this.#head.choose();
  }

  #focused(node) {
    const place = this.placeOf(node);
    if (!place) return;
    if (!(this.selection.has(place[0]) && this.selection.first !== this.selection.last)) this.selection.set(place[0]);
    this.#say(node);
  }

  /** Says what is wrong in the cell that is written in, or how it is written. */
  #say(node) {
    if (!this.#body.contains(node)) return;
    const [, key] = this.placeOf(node) ?? [];
    const hint = this.table.columns.find((column) => column.key === key)?.hint;
    this.#note.textContent = node.title || hint || HELP;
    this.#note.classList.toggle("is-problem", Boolean(node.title));
    node.setAttribute("aria-describedby", this.#note.id);
  }

  /** The cell that has the focus, as [index, key]. */
  #place() {
    const { activeElement } = globalThis.document;
    return this.#body.contains(activeElement) ? this.placeOf(activeElement) : null;
  }
}
