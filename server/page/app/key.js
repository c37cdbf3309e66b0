// The dialog for the key of a service that asks for one.

import { el } from "./dom.js";
import { key } from "./api.js";

let open = null;

/** Asks for a key; resolves to whether one was given. Several requests share one dialog. */
export function askForKey(refused) {
  open ??= show(refused).finally(() => (open = null));
  return open;
}

function show(refused) {
  const input = el("input", {
    id: "key", type: "password", autocomplete: "off", spellcheck: "false", value: key.get(),
  });
  const note = refused
    ? "The service did not accept this key."
    : "Requests carry it as a bearer token. It is forgotten when the tab is closed.";
  const dialog = el(
    "dialog",
    { class: "key-dialog", "aria-labelledby": "key-title" },
    el(
      "form",
      { method: "dialog" },
      el("h2", { id: "key-title" }, "Key of the service"),
      el("p", { id: "key-note" }, note),
      el("label", { for: "key" }, "Key"),
      input,
      el(
        "div",
        { class: "actions" },
        el("button", { value: "use", class: "primary" }, "Use key"),
        el("button", { value: "", formnovalidate: true }, "Cancel"),
      ),
    ),
  );
  input.setAttribute("aria-describedby", "key-note");
  document.body.append(dialog);
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      const used = dialog.returnValue === "use";
      if (used) key.set(input.value.trim());
      dialog.remove();
      resolve(used);
    });
  });
}
