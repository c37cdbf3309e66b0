// The keys of a grid, as in a spreadsheet, and what is pasted into it.

import { parse } from "./csv.js";

/** Whether the caret is at an edge of an input, or all of it is chosen, so that an arrow leaves it. */
function leaves(node, key) {
  if (node.tagName !== "INPUT") return true;
  const { selectionStart: begin, selectionEnd: end, value } = node;
  if (begin === 0 && end === value.length) return true;
  return begin === end && begin === (key === "ArrowLeft" ? 0 : value.length);
}

/** Listens to keys and pastes in the body of a grid. */
export function listenToGrid(body, grid) {
  body.addEventListener("keydown", (event) => {
    const place = grid.placeOf(event.target);
    if (!place || event.ctrlKey || event.metaKey) return;
    if (act(event, place, grid)) event.preventDefault();
  });
  body.addEventListener("paste", (event) => {
    const place = grid.placeOf(event.target);
    const text = event.clipboardData.getData("text/plain");
    // One value is pasted as into any field.
    if (!place || !/[\t\n\r]/.test(text.trim())) return;
    event.preventDefault();
    grid.paste(place, parse(text, "\t").rows);
  });
}

/** Whether a key has been used. */
function act(event, [index, key], grid) {
  const { target } = event;
  if (event.altKey) {
    const by = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (!by) return false;
    grid.move(by);
    return grid.focus(index + by, key);
  }
  if (event.key === "Enter") {
    if (grid.focus(index + (event.shiftKey ? -1 : 1), key)) return true;
    if (!event.shiftKey) grid.add(key);
    return true;
  }
  // A choice keeps up and down for itself.
  const rows = { ArrowUp: -1, ArrowDown: 1 }[event.key];
  if (rows) return target.tagName === "INPUT" && !event.shiftKey && (grid.focus(index + rows, key), true);
  if (!["ArrowLeft", "ArrowRight"].includes(event.key) || event.shiftKey || !leaves(target, event.key)) return false;
  const row = [...target.closest("tr").querySelectorAll("input, select")];
  const next = row[row.indexOf(target) + (event.key === "ArrowLeft" ? -1 : 1)];
  next?.focus();
  next?.select?.();
  return true;
}
