// One manoeuvre, with a choice of objective and command.

import { read } from "../api.js";
import { el } from "../dom.js";
import { count } from "../format.js";
import { slewResult } from "../slew/result.js";
import { workbench } from "../workbench.js";

const EXAMPLES = [
  ["quarter-turn", "Quarter turn", "minimum time, with the evidence of optimality"],
  ["olrac-four-wheels", "Time and effort", "four wheels, seven weights"],
  ["biros-sampled", "Sampled commands", "friction, torques held for 0.5 s"],
  ["lro-least-bill", "Least energy", "in a given time, motors and their bill"],
];

/** The view at "#/slew", which may name an example to start from. */
export function slew({ signal, query }) {
  return workbench({
    title: "One slew", id: "slew", label: "Slew", verb: "Solve", done, path: "/v1/slews",
    operation: "slews/solve_slew",
    list: EXAMPLES, signal, query,
    head: el("p", { class: "quiet" }, "A manoeuvre between two states, in least time or for another objective."),
    draw: async (answer, drawing) => slewResult({ ...answer, request: await writtenOut(answer.request, drawing) }, drawing),
  });
}

function done({ slews }) {
  const missed = slews.filter((slew) => !slew.solved).length;
  return missed ? `${missed} of ${count(slews.length, "slew")} not solved,` : "Solved";
}

/** The request with a stored spacecraft written out: the plots need its limits. */
async function writtenOut(request, signal) {
  const { ref, version } = request.spacecraft;
  if (ref === undefined) return request;
  const query = version ? `?version=${version}` : "";
  const stored = await read(`/v1/spacecraft/${encodeURIComponent(ref)}${query}`, signal);
  return { ...request, spacecraft: stored.spacecraft };
}
