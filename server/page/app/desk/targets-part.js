// The targets as a table, with what brings them here.

import { el, section } from "../dom.js";
import { importTable } from "./import-dialog.js";
import { parse } from "./csv.js";
import { isHead } from "./mapping.js";
import { TARGETS } from "./tables.js";

const EMPTY = "No targets yet. Add one, take them from a table, drop a CSV file or a scenario here, or paste the rows of a spreadsheet.";

/** The section of the targets; `takeScenario` is called with a dropped file that is no table. */
export function targetsPart(desk, takeScenario) {
  const tool = (text, label, onclick) => el("button", { type: "button", class: "small", "aria-label": label, onclick }, text);
  const tools = [
    tool("From a table …", "Take targets from a table", () => importTable(desk)),
    tool("Copy", "Copy the table for a spreadsheet", () => navigator.clipboard.writeText(grid.asTable())),
  ];
  const grid = desk.grid(TARGETS, { selection: desk.targets, empty: EMPTY, tools });
  const node = section("Targets", { class: "desk-part desk-targets", tabindex: "-1" }, grid.node);

  for (const [kind, over] of [["dragover", true], ["dragleave", false], ["drop", false]]) {
    node.addEventListener(kind, (event) => {
      event.preventDefault();
      node.classList.toggle("over", over);
      if (kind === "drop") takeFile(desk, event.dataTransfer.files[0], takeScenario);
    });
  }
  // A table with a head, or one that is pasted beside the cells, is asked about.
  node.addEventListener("paste", (event) => {
    const text = event.clipboardData.getData("text/plain");
    const isCell = event.target.closest?.("[data-key]");
    if (!/[\t\n\r]/.test(text.trim()) || (isCell && !isHead(parse(text).rows[0] ?? []))) return;
    event.preventDefault();
    event.stopPropagation();
    importTable(desk, text);
  }, true);
  return node;
}

/** Takes a file that is a table; what is no table is a scenario. */
export async function takeFile(desk, file, takeScenario) {
  if (!file) return;
  const text = await file.text();
  if (/\.json$/i.test(file.name) || /^\s*\{/.test(text)) takeScenario(text);
  else importTable(desk, text);
}
