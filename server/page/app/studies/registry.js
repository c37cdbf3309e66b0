// The studies of the service. A study is one entry here, and one file where its answer is drawn in its
// own way; without `render` its figures are shown as tables.

import { authority } from "./authority.js";

/**
 * Every study: its name in the address of the page, title, question, path in the service, examples
 * [name, title, note], and `render`, which makes the nodes of an answer {request, document}.
 */
export const STUDIES = [
  {
    name: "authority",
    title: "Authority",
    question: "How much of the wheels should a plan leave to feedback?",
    path: "/v1/studies/authority",
    examples: [["study-authority", "Two targets", "six pairs of shares, fifty flights each"]],
    render: authority,
  },
  {
    name: "flight",
    title: "Flight",
    question: "What does a plan become in closed loop, with what is not known as planned?",
    path: "/v1/studies/flight",
    examples: [["study-flight", "Two targets", "inertia and first attitude not as planned"]],
  },
  {
    name: "envelopes",
    title: "Envelopes",
    question: "What can the wheels do together, and which part of it do slews use?",
    path: "/v1/studies/envelopes",
    examples: [["study-envelopes", "Pyramid", "four wheels, two turns, a demand"]],
  },
  {
    name: "comparison",
    title: "Comparison",
    question: "Reaction wheels or control moment gyroscopes?",
    path: "/v1/studies/comparison",
    examples: [["study-comparison", "Three sizes", "devices of 0.01, 0.1 and 1 N m s"]],
  },
];
