// The plan as files.

import { request } from "../api.js";
import { el, section } from "../dom.js";
import { failure } from "../failure.js";

/** Values of `format` for other tools, endings of the files, names and what they are for. */
const EXPORTS = [
  ["csv", "csv", "CSV", "sampled trajectory"],
  ["aem-kvn", "aem", "CCSDS AEM", "attitude message, keywords and values"],
  ["aem-xml", "aem.xml", "CCSDS AEM, XML", "the same message"],
  ["basilisk", "waypoints.csv", "Basilisk", "for waypointReference"],
  ["open-mct", "open-mct.json", "Open MCT", "activities of a plan"],
  ["stk", "a", "STK", "attitude file"],
  ["wheel-rpm", "tsv", "Wheel speeds", "commands in rpm"],
];

/**
 * The section with a link for every file that there is: `plan` says what the document of the plan has,
 * none without it, `exports` whether there is a flight to write for other tools.
 */
export function downloads(id, name, { plan = null, exports = false } = {}) {
  const stem = (name ?? "plan").replaceAll(/[^\w.-]+/g, "-");
  const said = el("div", { "aria-live": "polite" });
  const formats = [...plan ? [["json", "json", "JSON", plan]] : [], ...exports ? EXPORTS : []];
  const links = formats.map(([format, ending, title, note]) =>
    link(`/v1/plans/${id}/result?format=${format}`, `${stem}.${ending}`, title, note, said));
  links.push(link(`/v1/plans/${id}/scenario`, `${stem}-scenario.json`, "Scenario", "what was asked for", said));
  return section("Downloads", { class: "wide" },
    el("ul", { class: "downloads" }, links.map((one) => el("li", {}, one))), said);
}

/** A link to a file. It is fetched first: a link carries no key, and could not say why there is no file. */
function link(path, file, title, note, said) {
  const node = el("a", { class: "download", href: path, download: file }, el("strong", {}, title), el("span", {}, note));
  node.addEventListener("click", async (event) => {
    event.preventDefault();
    try {
      const content = URL.createObjectURL(await (await request(path)).blob());
      said.replaceChildren();
      el("a", { href: content, download: file }).click();
      setTimeout(() => URL.revokeObjectURL(content), 60_000);
    } catch (error) {
      said.replaceChildren(failure({ ...error, title: `${file}: ${error.title ?? "not written"}`, message: error.message }));
    }
  });
  return node;
}
