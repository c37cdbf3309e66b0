// Runs the parts and prints what held.

import { answers } from "./answers.mjs";
import { body } from "./body.mjs";
import { clock } from "./clock.mjs";
import { compare } from "./compare.mjs";
import { desk } from "./desk.mjs";
import { deskModules } from "./desk-modules.mjs";
import { details } from "./details.mjs";
import { fromBlank } from "./from-blank.mjs";
import { openBrowser, startService } from "./harness.mjs";
import { hostile } from "./hostile.mjs";
import { journeys } from "./journeys.mjs";
import { longWork } from "./long-work.mjs";
import { looks } from "./looks.mjs";
import { matrix } from "./matrix.mjs";
import { modules } from "./modules.mjs";
import { order } from "./order.mjs";
import { pictures } from "./pictures.mjs";
import { studies } from "./studies.mjs";
import { units } from "./units.mjs";
import { violations } from "./violations.mjs";

const PARTS = { modules, hostile, journeys, "from-blank": fromBlank, desk, "desk-modules": deskModules, answers, details, body, units, clock, compare, matrix, order, pictures, "long-work": longWork, studies, violations, looks };

const asked = process.argv.slice(2);
const unknown = asked.filter((name) => !(name in PARTS));
if (unknown.length) throw new Error(`no such part: ${unknown.join(", ")}; there are ${Object.keys(PARTS).join(", ")}`);

const service = await startService();
const browser = await openBrowser();
let failed = 0;

/** One thing that must hold; what it returns is printed. */
async function must(name, act) {
  try {
    const result = await act();
    console.log(`ok      ${name}${result ? `: ${result}` : ""}`);
  } catch (error) {
    failed += 1;
    console.log(`FAILED  ${name}: ${error.message}`);
  }
}

try {
  for (const [name, part] of Object.entries(PARTS)) {
    if (!asked.length || asked.includes(name)) await part({ browser, service, must });
  }
} finally {
  await browser.close();
  await service.stop();
}
console.log(failed ? `${failed} failed` : "all held");
process.exitCode = failed ? 1 : 0;
