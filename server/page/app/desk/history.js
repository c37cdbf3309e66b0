// Undo and redo, by buttons and by the usual keys.

import { el } from "../dom.js";

/** Buttons that take back and do again, and say what. */
export function historyButtons({ draft, signal }) {
  const undo = el("button", { type: "button", onclick: () => draft.undo() }, "Undo");
  const redo = el("button", { type: "button", onclick: () => draft.redo() }, "Redo");
  const render = () => {
    for (const [button, verb, what] of [[undo, "Undo", draft.undoable], [redo, "Redo", draft.redoable]]) {
      // A button that is really disabled would lose the focus.
      if (what === null) button.setAttribute("aria-disabled", "true");
      else button.removeAttribute("aria-disabled");
      button.title = what === null ? "" : `${verb}: ${what}`;
    }
  };
  draft.listen(render, signal);
  render();
  return [undo, redo];
}

/** Ctrl or Command with Z, Shift and Z, or Y, anywhere in a view. */
export function listenToHistory(node, draft) {
  node.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase();
    if (key !== "z" && key !== "y") return;
    event.preventDefault();
    if (key === "y" || event.shiftKey) draft.redo();
    else draft.undo();
  });
}
