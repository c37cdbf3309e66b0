// Which view is shown: the part of the address after "#".

import { onKeyNeeded, read } from "./api.js";
import { el } from "./dom.js";
import { askForKey } from "./key.js";
import { compare } from "./views/compare.js";
import { list } from "./views/list.js";
import { plan } from "./views/plan.js";
import { slew } from "./views/slew.js";
import { studies } from "./views/studies.js";
import { submit } from "./views/submit.js";

const ROUTES = [
  [/^$/, list],
  [/^new$/, submit],
  [/^plans\/([0-9a-f-]+)$/, plan],
  [/^compare(?:\/([0-9a-f-]+))?(?:\/([0-9a-f-]+))?$/, compare],
  [/^slew$/, slew],
  [/^studies(?:\/([a-z_-]+))?$/, studies],
];

const main = document.getElementById("main");
let leave = new AbortController();
let first = true;

function show() {
  const [path, query] = location.hash.replace(/^#\//, "").split("?");
  leave.abort();
  leave = new AbortController();
  const { signal } = leave;
  for (const link of document.querySelectorAll(".masthead nav a")) {
    const place = link.getAttribute("href");
    const current = place === `#/${path}` || (place !== "#/" && `#/${path}`.startsWith(`${place}/`));
    if (current) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  const [match, view] = ROUTES.map(([pattern, view]) => [pattern.exec(path), view]).find(([match]) => match)
    ?? [[], missing];
  const node = view({ signal, id: match[1], other: match[2], query: new URLSearchParams(query) });
  main.replaceChildren(node);
  document.title = `${node.querySelector("h1")?.textContent ?? "slewplan"} – slewplan`;
  if (!first) main.focus({ preventScroll: true });
  if (!first) scrollTo(0, 0);
  first = false;
}

function missing() {
  return el("div", {}, el("h1", {}, "Nothing here"), el("p", {}, el("a", { href: "#/" }, "All plans")));
}

onKeyNeeded(askForKey);
document.getElementById("key-button").addEventListener("click", async () => {
  if (await askForKey(false)) show();
});
// The address belongs to the views, so this link only moves the focus.
document.querySelector(".skip").addEventListener("click", (event) => {
  event.preventDefault();
  main.focus();
});
addEventListener("hashchange", show);
show();

const version = await read("/v1/version").catch(() => null);
if (version) document.getElementById("version").textContent = `slewplan ${version.version}`;
