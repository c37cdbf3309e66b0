// The studies of the service. A study is one entry here, and one file where its answer is drawn.

import { authority } from "./authority.js";
import { comparison } from "./comparison.js";
import { envelopes } from "./envelopes.js";
import { flight } from "./flight.js";
import { authorityOfPlan, flightOfPlan } from "./from-plan.js";

/**
 * Every study: its name in the address of the page, title, question, path in the service, examples
 * [name, title, note], and `render`, which makes the nodes of an answer {request, document}. `ofPlan`
 * makes a request of a plan and its scenario, where the study is about one.
 */
export const STUDIES = [
  {
    name: "authority",
    title: "Authority",
    question: "How much of the wheels should a plan leave to feedback?",
    path: "/v1/studies/authority",
    examples: [["study-authority", "Two targets", "six pairs of shares, fifty flights each"]],
    render: authority,
    ofPlan: authorityOfPlan,
  },
  {
    name: "flight",
    title: "Flight",
    question: "What does a plan become in closed loop, with what is not known as planned?",
    path: "/v1/studies/flight",
    examples: [["study-flight", "Two targets", "inertia and first attitude not as planned"]],
    render: flight,
    ofPlan: flightOfPlan,
  },
  {
    name: "envelopes",
    title: "Envelopes",
    question: "What can the wheels do together, and which part of it do slews use?",
    path: "/v1/studies/envelopes",
    examples: [["study-envelopes", "Pyramid", "four wheels, two turns, a demand"]],
    render: envelopes,
  },
  {
    name: "comparison",
    title: "Comparison",
    question: "Reaction wheels or control moment gyroscopes?",
    path: "/v1/studies/comparison",
    examples: [["study-comparison", "Three sizes", "devices of 0.01, 0.1 and 1 N m s"]],
    render: comparison,
  },
];
