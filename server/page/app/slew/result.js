// The answer to a request for slews: one, or those along a sweep, of which one is looked at.

import { Cursor } from "../cursor.js";
import { el } from "../dom.js";
import { flown } from "../flown.js";
import { banners } from "../plan/violations.js";
import { saved } from "../saved.js";
import { checkedSlew } from "./checked.js";
import { evidenceGroups, optimality } from "./evidence.js";
import { slewFacts, slewVerification } from "./facts.js";
import { slewFlight } from "./flight.js";
import { sweepOf } from "./sweep.js";
import { trade } from "./trade.js";

/** The nodes of an answer {request, document, text}. */
export function slewResult({ request, document, text }, signal) {
  const { slews, complete } = document;
  const stem = (request.name ?? "slew").replaceAll(/[^\w.-]+/g, "-");
  const place = el("div", {});
  let drawing = new AbortController();
  signal.addEventListener("abort", () => drawing.abort());
  const look = (index) => {
    drawing.abort();
    drawing = new AbortController();
    place.replaceChildren(...one(slews[index], request, drawing.signal));
  };
  const sweep = sweepOf(request);
  const nodes = [
    complete ? null : el("p", { class: "cut-short" }, asked(sweep, slews.length)),
    sweep && slews.length ? trade(sweep, slews, look, signal) : null,
    place,
    saved([[text, `${stem}-answer.json`, "Answer", "all that the service found"],
      [JSON.stringify(request, null, 2), `${stem}.json`, "Request", "what was asked for"]], signal),
  ];
  if (slews.length) look(0);
  return nodes;
}

function asked(sweep, found) {
  return sweep ? `Time ran out: ${found} of ${sweep.values.length} slews were reached.` : "Time ran out before the slew was done.";
}

/** The views of one slew. */
function one(slew, request, signal) {
  const flight = slewFlight(slew, request);
  const cards = el("div", { class: "cards" }, slewVerification(slew), optimality(slew, request));
  // Then the verification says why.
  const cursor = new Cursor();
  if (!flight) return [...banners(checkedSlew(slew), request), slewFacts(slew, request), cards];
  return [
    ...banners(checkedSlew(slew), request, cursor),
    slewFacts(slew, request),
    flown(flight, cursor, signal, evidenceGroups(slew.evidence)),
    cards,
  ];
}
