// Targets from a table: a file or what was copied, its columns, and what is wrong with its cells.

import { el, scroller } from "../dom.js";
import { count } from "../format.js";
import { delimiterOf, parse } from "./csv.js";
import { insert, put } from "./json-edit.js";
import { KIND_TITLES, usualBoresight } from "./kinds.js";
import { choices, guess, kindMeant, targetsOf } from "./mapping.js";
import { begun, rowsOf } from "./rows.js";
import { TARGETS } from "./tables.js";

/** Rows that are shown before they are taken, beside those with problems. */
const PREVIEW = 8;
const MAX_SHOWN = 50;

/** Asks how a table is to be read, and takes its targets into the draft. `text` may be there already. */
export function importTable(desk, text = "") {
  return new ImportDialog(desk).open(text);
}

class ImportDialog {
  #desk;
  #rows = [];
  #keys = [];
  #source = el("textarea", { id: "import-text", rows: "5", spellcheck: "false", autocomplete: "off", wrap: "off" });
  #file = el("input", { id: "import-file", type: "file", accept: ".csv,.tsv,.txt,text/csv,text/tab-separated-values" });
  #head = el("input", { id: "import-head", type: "checkbox" });
  #kind = el("select", { id: "import-kind" }, KIND_TITLES.orientation.map(([value, title]) => el("option", { value }, title)));
  #boresight = el("select", { id: "import-boresight" });
  #preview = el("div", { class: "import-preview" });
  #said = el("p", { class: "import-said", role: "status" });
  #add = el("button", { value: "add", class: "primary" }, "Add targets");
  #replace = el("button", { value: "replace" }, "Replace all targets");
  #options;
  #dialog;

  constructor(desk) {
    this.#desk = desk;
    const field = (id, label, control) => el("div", { class: "field" }, el("label", { for: id }, label), control);
    this.#options = el("div", { class: "fields" },
      el("div", { class: "field check" }, this.#head, el("label", { for: "import-head" }, "The first line names the columns")),
      field("import-kind", "Targets are given as", this.#kind), field("import-boresight", "What points there", this.#boresight));
    this.#dialog = el("dialog", { class: "import-dialog", "aria-labelledby": "import-title" }, el("form", { method: "dialog" },
      el("h2", { id: "import-title" }, "Targets from a table"),
      el("div", { class: "fields" }, field("import-file", "File", this.#file)),
      el("div", { class: "field" }, el("label", { for: "import-text" }, "Or its rows, pasted"), this.#source),
      this.#options, this.#preview, this.#said,
      el("div", { class: "actions" }, this.#add, this.#replace, el("button", { value: "", formnovalidate: true }, "Cancel"))));
    this.#source.addEventListener("input", () => this.#read());
    this.#file.addEventListener("change", async () => {
      this.#source.value = await this.#file.files[0]?.text() ?? "";
      this.#read();
    });
    this.#head.addEventListener("change", () => this.#render());
    this.#kind.addEventListener("change", () => this.#render());
    this.#boresight.addEventListener("change", () => this.#render());
  }

  open(text) {
    const { spacecraft } = this.#desk;
    const named = (Array.isArray(spacecraft?.boresights) ? spacecraft.boresights : []).map(({ name }) => name).filter(Boolean);
    const plain = [[0, 0, 1], [1, 0, 0], [0, 1, 0]].map((axis, index) => [JSON.stringify(axis), `+${"ZXY"[index]} of the body`]);
    this.#boresight.replaceChildren(...[...named.map((name) => [JSON.stringify(name), name]), ...plain]
      .map(([value, title]) => el("option", { value }, title)));
    this.#boresight.value = JSON.stringify(usualBoresight(spacecraft));
    this.#source.value = text;
    this.#read();
    document.body.append(this.#dialog);
    this.#dialog.showModal();
    this.#desk.signal.addEventListener("abort", () => this.#dialog.close());
    return new Promise((resolve) => {
      this.#dialog.addEventListener("close", () => {
        const { returnValue } = this.#dialog;
        if (returnValue) this.#take(returnValue === "replace");
        this.#dialog.remove();
        resolve(Boolean(returnValue));
      });
    });
  }

  /** Reads the table anew, with what it seems to mean. */
  #read() {
    this.#rows = parse(this.#source.value, delimiterOf(this.#source.value)).rows;
    const { head, keys, kind } = guess(this.#rows);
    this.#head.checked = head;
    this.#keys = keys;
    this.#kind.value = kind;
    this.#render();
  }

  get #body() {
    return this.#head.checked ? this.#rows.slice(1) : this.#rows;
  }

  #targets(replaced) {
    const { document, spacecraft } = this.#desk;
    const taken = replaced ? [] : rowsOf(document, TARGETS).map((row) => row?.id);
    const boresight = JSON.parse(this.#boresight.value);
    return targetsOf(this.#body, this.#keys, { kind: this.#kind.value, boresight, spacecraft, taken });
  }

  #render() {
    const rows = this.#body;
    const { problems } = this.#targets(false);
    this.#options.hidden = this.#preview.hidden = this.#rows.length === 0;
    this.#add.disabled = rows.length === 0;
    this.#add.textContent = rows.length ? `Add ${count(rows.length, "target")}` : "Add targets";
    this.#replace.hidden = rowsOf(this.#desk.document, TARGETS).length === 0 || rows.length === 0;
    this.#boresight.parentElement.hidden = !/^(pointing|ra_dec)/.test(this.#kind.value);
    const first = problems[0];
    this.#said.classList.toggle("is-problem", problems.length > 0);
    this.#said.textContent = problems.length
      ? `${count(problems.length, "cell")} with a problem; the first is row ${first.row + 1}, column ${first.column + 1}: ${first.message}.`
      : rows.length ? `${count(rows.length, "row")}, every cell can be read.` : "";
    if (!this.#rows.length) return;
    const { activeElement } = document;
    const focused = this.#preview.contains(activeElement) ? activeElement.id : null;
    this.#preview.replaceChildren(this.#table(rows, problems));
    if (focused) this.#preview.querySelector(`#${CSS.escape(focused)}`)?.focus();
  }

  #table(rows, problems) {
    const options = choices(this.#kind.value);
    const titles = this.#head.checked ? this.#rows[0] : [];
    const title = (index) => titles[index] || `Column ${index + 1}`;
    const heads = this.#keys.map((key, index) => {
      const select = el("select", { id: `import-column-${index}`, "aria-label": `${title(index)} is` },
        el("option", { value: "" }, "left out"), options.map(([value, name]) => el("option", { value }, name)));
      select.value = options.some(([value]) => value === key) ? key : "";
      select.addEventListener("change", () => {
        this.#keys = this.#keys.map((other, place) => (place === index ? select.value || null : other === select.value ? null : other));
        const kind = kindMeant(this.#keys);
        if (!options.some(([value]) => value === "ra") || kind === "ra_dec_roll") this.#kind.value = kind;
        this.#render();
      });
      return el("th", { scope: "col" }, el("span", { class: "import-title" }, title(index)), select);
    });
    const wrong = new Map(problems.map((problem) => [`${problem.row} ${problem.column}`, problem.message]));
    const troubled = new Set(problems.map(({ row }) => row));
    const shown = rows.map((_, row) => row).filter((row) => row < PREVIEW || troubled.has(row)).slice(0, MAX_SHOWN);
    const cell = (row, column) => {
      const message = wrong.get(`${row} ${column}`);
      return el("td", { class: message ? "wrong" : null }, rows[row][column] ?? "",
        message ? el("span", { class: "cell-problem" }, message) : null);
    };
    const table = el("table", {}, el("caption", { class: "unseen" }, "What the table has"),
      el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Row"), heads)),
      el("tbody", {}, shown.map((row) => el("tr", {}, el("th", { scope: "row" }, String(row + 1)), this.#keys.map((_, column) => cell(row, column))))));
    const rest = rows.length - shown.length;
    return el("div", {}, scroller("What the table has", table), rest > 0 ? el("p", { class: "quiet" }, `and ${count(rest, "more row")}`) : null);
  }

  #take(replaced) {
    const { draft, document } = this.#desk;
    const { texts } = this.#targets(replaced);
    const clear = replaced ? put(draft.text, TARGETS.path, "[\n  ]") : begun(draft.text, document);
    draft.edit(insert(clear, TARGETS.path, replaced ? 0 : rowsOf(document, TARGETS).length, texts), "targets from a table");
    this.#desk.targets.set(rowsOf(this.#desk.document, TARGETS).length - 1);
  }
}
