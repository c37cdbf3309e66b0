// The trade curve of a sweep, of which a point is chosen.

import { disclosure, el, section, table } from "../dom.js";
import { significant } from "../format.js";
import { pictureButtons } from "../picture/save.js";
import { curveChart } from "../plots/curves.js";

/** Curves of a sweep: figure, title, unit, colour, and the sweep that gives it already. */
const FIGURES = [
  ["time_s", "Duration", "s", 1, "durations_s"],
  ["effort_nm2_s", "Effort", "N²m²s", 2, null],
  ["energy_bill_j", "Energy bill", "J", 3, "energies_j"],
];

/** The section with the curves; `look` is called with the index of the chosen slew. */
export function trade(sweep, slews, look, signal) {
  const number = sweep.title.toLowerCase();
  const name = (slew) => `${number} ${significant(slew.swept)}`;
  const said = el("span", { class: "quiet" });
  const choose = (index) => {
    for (const chart of charts) chart.choose(index);
    rows.forEach((row, at) => row.classList.toggle("chosen", at === index));
    said.textContent = `Below: ${name(slews[index])}`;
  };
  const chosen = (index) => {
    choose(index);
    look(index);
  };
  const against = { title: sweep.title, unit: sweep.unit, values: slews.map((slew) => slew.swept) };
  const charts = FIGURES
    .filter(([figure, , , , given]) => given !== sweep.kind && slews.some((slew) => slew[figure] !== null))
    .map(([figure, title, unit, colour]) => curveChart({
      title, unit, against,
      curves: [{ name: title, values: slews.map((slew) => slew[figure]), colour }],
      points: {
        label: (index) => `${name(slews[index])}: ${significant(slews[index][figure])} ${unit}${slews[index].solved ? "" : ", not solved"}`,
        failed: (index) => !slews[index].solved,
        choose: chosen,
      },
    }, signal));
  const data = asTable(sweep, slews);
  const rows = [...data.querySelectorAll("tbody tr")];
  choose(0);
  return section("Trade curve", { class: "wide", head: el("div", { class: "tools" }, said, pictureButtons("trade curve")) },
    el("div", { class: "curves" }, charts.map((chart) => chart.node)),
    el("p", { class: "quiet" }, "Choose a point to see its slew; the arrow keys go from point to point."),
    disclosure("Points as a table", () => data));
}

function asTable(sweep, slews) {
  const figures = [...FIGURES, ["energy_proxy_j", "Energy proxy", "J"], ["objective", "Objective", slews[0].objective_unit]]
    .filter(([figure]) => slews.some((slew) => slew[figure] !== null));
  const columns = [
    { title: `${sweep.title}, ${sweep.unit}`, head: true },
    ...figures.map(([, title, unit]) => ({ title: `${title}, ${unit}`, number: true })),
    { title: "Status" },
  ];
  return table("Slews along the sweep", columns, slews.map((slew) => [
    significant(slew.swept), ...figures.map(([figure]) => significant(slew[figure])),
    slew.solved ? "solved" : `not solved: ${slew.status}`,
  ]));
}
