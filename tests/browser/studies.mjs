// Studies with their drawings, and those that are made of a plan at one click.

import { readFileSync } from "node:fs";
import { check, eventually, findings, fixture, openPage, picture, planned } from "./harness.mjs";

const number = (text) => Number.parseFloat(text.replace("−", "-"));
const close = (found, wanted, most) => Math.abs(found - wanted) <= most;

/** Runs the example of a study; the answer that the page offers as a file. */
async function ran(page, service, name) {
  await page.goto("about:blank");
  await page.goto(`${service.address}/#/studies/${name}?example=study-${name}`);
  await page.waitForFunction(() => document.querySelector("textarea").value.length > 0);
  await page.getByRole("button", { name: "Run", exact: true }).click();
  return answered(page);
}

async function answered(page) {
  await page.locator(".result .uplot").first().waitFor();
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name: /^Answer/ }).click()]);
  return JSON.parse(readFileSync(await download.path(), "utf8"));
}

async function clean(page, name) {
  await picture(page, name);
  const found = await findings(page);
  check(found.length === 0, found.join("\n"));
}

export async function studies(given) {
  await envelopes(given);
  await comparison(given);
  await flight(given);
  await ofAPlan(given);
}

async function envelopes({ browser, service, must }) {
  const { page, complaints, close: leave } = await openPage(browser, service);
  let answer;
  await must("envelopes are drawn with the shares that slews take of them", async () => {
    answer = await ran(page, service, "envelopes");
    check(await page.locator("canvas.solid").count() === 2, "two envelopes");
    check(await page.locator(".curves .uplot").count() === 4, "four plots of shares");
    await page.locator("summary", { hasText: "Shares as a table" }).click();
    const rows = page.getByRole("region", { name: "Largest shares of the envelopes" }).locator("tbody tr");
    await rows.first().waitFor();
    // The service tells the shares at the ends of the pieces of a way; none is larger in between for a convex set.
    const path = answer.turns[0].time_optimal.find((slew) => slew.allocation === "free").path;
    const cells = await rows.filter({ has: page.getByRole("rowheader", { name: "fastest", exact: true }) }).first().locator("td").allTextContents();
    for (const [index, kind] of ["full_share", "pseudo_inverse_share"].entries()) {
      const most = Math.max(...path.momentum.map((sample) => sample[kind]));
      check(close(number(cells[index + 1]), most, 6e-4), `${kind} ${cells.join()} beside ${most}`);
    }
    await clean(page, "study-envelopes");
    return cells.join(" ");
  });
  await must("an envelope is turned with keys, and another turn has other slews", async () => {
    const solid = page.locator("canvas.solid").first();
    const before = await solid.getAttribute("data-pose");
    await solid.focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("+");
    await eventually(async () => check(await solid.getAttribute("data-pose") === "304.0 23.5 1.25", await solid.getAttribute("data-pose")));
    await page.keyboard.press("0");
    await eventually(async () => check(await solid.getAttribute("data-pose") === before, "0 does not reset"));
    const text = () => page.locator(".envelope .key").first().textContent();
    const first = await text();
    await page.getByLabel("Turn", { exact: true }).selectOption("1");
    const duration = answer.turns[1].eigenaxis.find((slew) => slew.limit === "full").duration_s.toFixed(2);
    await eventually(async () => check(await text() !== first && (await text()).includes(`${duration} s`), await text()));
    check(complaints.length === 0, complaints.join("\n"));
    return text();
  });
  await leave();
}

async function comparison({ browser, service, must }) {
  const { page, complaints, close: leave } = await openPage(browser, service);
  await must("wheels and gyroscopes are compared in diagrams and tables", async () => {
    const answer = await ran(page, service, "comparison");
    await eventually(async () => check(await page.locator(".curves .uplot").count() === answer.sizes.length + 4, "a diagram for each size, and four"));
    const cells = await page.getByRole("region", { name: "Angles from which on gyroscopes are faster" }).locator("tbody tr").first().locator("td").allTextContents();
    const angles = answer.sizes[0].advantages.map(({ angle_rad: angle }) => ((angle * 180) / Math.PI).toFixed(1));
    check(cells.join() === angles.join(), cells.join());
    await page.locator("summary", { hasText: "Slew times as tables" }).click();
    const rows = page.getByRole("region", { name: /^Slew times with devices of/ }).first().locator("tbody tr");
    await eventually(async () => check(await rows.count() === answer.angles_rad.length, "a row for every angle"));
    await page.locator("summary", { hasText: "Slew times as tables" }).click();
    await clean(page, "study-comparison");
    check(complaints.length === 0, complaints.join("\n"));
    return cells.join(" ");
  });
  await leave();
}

async function flight({ browser, service, must }) {
  const { page, complaints, close: leave } = await openPage(browser, service);
  await must("a flight in closed loop is drawn with its errors and the limits that it meets", async () => {
    const { flight: found } = await ran(page, service, "flight");
    const shown = await page.locator(".facts .figure").first().textContent();
    check(close(number(shown), (found.end.attitude_rad * 180) / Math.PI, 1e-3), `${shown} for ${found.end.attitude_rad} rad`);
    const titles = await page.locator(".timelines h3").allTextContents();
    check(["Attitude error", "Rate error"].every((title) => titles.some((text) => text.startsWith(title))), titles.join());
    await page.locator(".bar.limit").first().waitFor();
    await page.locator("summary", { hasText: "Phases as a table" }).click();
    const phases = page.getByRole("region", { name: "Phases of the flight" });
    const first = found.samples.find((sample) => sample.torque_limited.includes(true));
    const begin = await phases.locator("tr", { hasText: "torque limit met" }).first().locator("td").first().textContent();
    check(begin === first.time_s.toFixed(2), `${begin} s beside ${first.time_s} s`);
    const shares = await page.getByRole("region", { name: "Shares of the time at limits" }).locator("tbody tr").first().locator("td").allTextContents();
    check(shares[0] === `${(100 * found.saturation[0].torque).toFixed(1)} %`, shares.join());
    await page.getByLabel("Moment").focus();
    await page.keyboard.press("End");
    const last = (found.samples.at(-1).error.attitude_rad * 180) / Math.PI;
    await eventually(async () => {
      const value = await page.locator(".chart", { hasText: "Attitude error" }).locator(".key .value").textContent();
      check(close(number(value), last, 6e-4), `${value} beside ${last}`);
    });
    await clean(page, "study-flight");
    check(complaints.length === 0, complaints.join("\n"));
    return `${shown}, ${found.samples.length} samples`;
  });
  await leave();
}

async function ofAPlan({ browser, service, must }) {
  const id = await planned(service, fixture("two-targets"));
  const plan = await (await fetch(`${service.address}/v1/plans/${id}/result`)).json();
  const { page, complaints, close: leave } = await openPage(browser, service);
  await must("a plan is flown in closed loop at one press of a key", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.getByRole("link", { name: "Fly in closed loop" }).focus();
    await page.keyboard.press("Enter");
    const { flight: found } = await answered(page);
    // The plan itself was flown, none was made for it.
    check(found.plan_status === null && found.total_time_s === plan.total_time_s, `${found.plan_status}, ${found.total_time_s} s`);
    check(JSON.stringify(found.passages.map(({ target }) => target)) === JSON.stringify(plan.sequence), "another order");
    await page.getByText(/^Not as planned: inertia 3 sigma 0.02/).waitFor();
    return page.locator(".facts .figure").first().textContent();
  });
  await must("what share of torque to leave is asked at one press of a key", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.getByRole("link", { name: "What share of torque?" }).focus();
    await page.keyboard.press("Enter");
    const { rows } = await answered(page);
    check(rows.length === 4 && close(rows[0].total_time_s, plan.total_time_s, 1e-3), `${rows.length} rows, ${rows[0].total_time_s} s`);
    check(complaints.length === 0, complaints.join("\n"));
    return rows.map((row) => `${row.total_time_s.toFixed(1)} s`).join(", ");
  });
  await leave();
}
