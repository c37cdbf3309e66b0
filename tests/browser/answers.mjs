// Slews and studies: what is answered at once.

import { readFileSync } from "node:fs";
import { check, eventually, findings, fixture, openPage, picture } from "./harness.mjs";

/** The loading of an answer that the service refuses, which the browser itself reports. */
const REFUSED = [/^console: Failed to load resource.* 422 /];
/** A slew that is given up after this would have been solved for long, ms. */
const SOON_MS = 20_000;

export async function answers(given) {
  await quarterTurn(given);
  await tradeCurve(given);
  await throughACone(given);
  await wrongAndGivenUp(given);
  await study(given);
}

/** Opens an example of a view and sends it. */
async function sent(page, service, { view, example, verb }) {
  await page.goto(`${service.address}/#/${view}`);
  await page.locator(`[data-example="${example}"]`).click();
  await page.waitForFunction(() => document.querySelector("textarea").value.length > 0);
  await page.getByRole("button", { name: verb, exact: true }).click();
  await page.getByRole("region", { name: "Result" }).waitFor();
}

/** The answer that the page offers as a file. */
async function downloaded(page) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name: /^Answer/ }).click()]);
  return { name: download.suggestedFilename(), document: JSON.parse(readFileSync(await download.path(), "utf8")) };
}

const figure = (page, name) => page.locator(".facts > div", { has: page.getByText(name, { exact: true }) }).locator(".figure");
const close = (found, wanted, most) => Math.abs(found - wanted) <= most;

async function quarterTurn({ browser, service, must }) {
  const { page, complaints, close: leave } = await openPage(browser, service);
  let slew;

  await must("a quarter turn is solved from its example, by keys alone", async () => {
    await page.goto(service.address);
    await page.getByRole("link", { name: "Slew", exact: true }).focus();
    await page.keyboard.press("Enter");
    await page.getByRole("button", { name: /Quarter turn/ }).focus();
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.querySelector("textarea").value.includes("evidence"));
    await page.getByRole("button", { name: "Solve" }).focus();
    await page.keyboard.press("Enter");
    const result = page.getByRole("region", { name: "Result" });
    await result.waitFor();
    await eventually(async () => check(await result.evaluate((node) => node === document.activeElement), "the focus is not on the result"));
    const shown = Number.parseFloat(await figure(page, "Duration").textContent());
    ({ slews: [slew] } = (await downloaded(page)).document);
    check(slew.solved && close(shown, slew.time_s, 5e-4), `${shown} s beside ${slew.time_s} s`);
    // The same pair rest to rest in the answer of another interface.
    check(close(shown, await restToRest(service), 1e-3 * shown), `${shown} s`);
    return `${shown} s`;
  });
  await must("its plots share one moment with the evidence", async () => {
    const titles = await page.locator(".timelines h3").allTextContents();
    check(["Hamiltonian", "Switching functions"].every((title) => titles.some((text) => text.startsWith(title))), titles.join());
    await page.getByLabel("Moment").focus();
    await page.keyboard.press("End");
    const last = slew.evidence.intervals.at(-1).switching_end;
    const values = await eventually(async () => {
      const texts = await page.locator(".chart", { hasText: "Switching functions" }).locator(".key .value").allTextContents();
      check(texts.length === last.length, `${texts.length} values`);
      check(texts.every((text, wheel) => close(Number(text.replace("−", "-")), last[wheel], 6e-4)), texts.join());
      return texts;
    });
    await page.getByRole("button", { name: "Show a shorter time" }).click();
    const lines = await page.locator(".timelines .u-cursor-x").evaluateAll((all) => all.map((line) => line.getBoundingClientRect().right));
    check(lines.length === 5, `${lines.length} plots`);
    return values.join(" ");
  });
  await must("the points of every plot stand at the moment, between samples too", async () => {
    const moment = await page.evaluate(() => {
      const slider = document.getElementById("moment");
      const between = 0.4 * Number(slider.max);
      slider.value = String(between);
      slider.dispatchEvent(new Event("input"));
      return Number(slider.value);
    });
    const samples = slew.trajectory.states.map((state) => state.time_s);
    check(samples.every((time) => Math.abs(time - moment) > 0.2), "the moment is that of a sample");
    const away = await eventually(async () => {
      const found = await page.locator(".timelines .uplot").evaluateAll((all) => all.flatMap((plot) => {
        const line = plot.querySelector(".u-cursor-x").getBoundingClientRect().right;
        return [...plot.querySelectorAll(".u-cursor-pt")].map((point) => {
          const { left, right } = point.getBoundingClientRect();
          return Math.abs((left + right) / 2 - line);
        });
      }));
      check(found.length === 15, `${found.length} points`);
      check(found.every((distance) => distance < 1.5), `${Math.max(...found).toFixed(1)} px away`);
      return Math.max(...found);
    });
    return `at most ${away.toFixed(1)} px away`;
  });
  await must("its tables have what the plots show", async () => {
    for (const name of ["Directions", "Samples", "Hamiltonian", "Switching functions"]) {
      await page.locator("summary", { hasText: `${name} as a table` }).click();
    }
    const rows = (name) => page.getByRole("region", { name }).locator("tbody tr").count();
    // A table is filled when it is opened, which the page is told after the click.
    await eventually(async () => {
      check(await rows("Samples of the trajectory") === slew.trajectory.states.length, "samples");
      check(await rows("Switching functions on the intervals") === slew.evidence.intervals.length, "switching functions");
    });
    check(await page.locator(".chip.good", { hasText: "Passed" }).count() === 1, "passed");
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
  });
  await must("no error of the console with a slew", () => check(complaints.length === 0, complaints.join("\n")));
  await leave();
}

/** The quarter turn as a leg, s. */
async function restToRest(service) {
  const { spacecraft, start, end } = fixture("slews/quarter-turn");
  const answer = await fetch(`${service.address}/v1/legs/query`, {
    method: "POST", headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ spacecraft, pairs: [{ from: start.attitude, to: end.attitude }], mode: "compute" }),
  });
  return (await answer.json()).legs[0].duration_s;
}

async function tradeCurve({ browser, service, must }) {
  const { page, complaints, close: leave } = await openPage(browser, service);
  await must("the points of a trade curve lead to their slews", async () => {
    await sent(page, service, { view: "slew", example: "olrac-four-wheels", verb: "Solve" });
    const { slews } = (await downloaded(page)).document;
    const points = page.getByRole("radiogroup", { name: /^Duration/ }).getByRole("radio");
    await eventually(async () => check(await points.count() === slews.length && await points.first().isChecked(), "points"));
    const seen = [];
    for (let index = 0; index < slews.length; index += 1) {
      if (index === 0) await points.first().focus();
      else await page.keyboard.press("ArrowRight");
      await page.getByText(`Below: weight ${slews[index].swept}`).waitFor();
      seen.push(await eventually(async () => {
        const shown = Number.parseFloat(await figure(page, "Duration").textContent());
        check(close(shown, slews[index].time_s, 5e-4), `${shown} s beside ${slews[index].time_s} s`);
        return `${shown} s`;
      }));
    }
    await page.getByRole("radiogroup", { name: /^Effort/ }).getByRole("radio").nth(1).click();
    await eventually(async () => {
      check(await points.nth(1).isChecked(), "the curves choose together");
      const shown = Number.parseFloat(await figure(page, "Duration").textContent());
      check(close(shown, slews[1].time_s, 5e-4), `${shown} s`);
    });
    return seen.join(", ");
  });
  await must("the points are where their values are", async () => {
    const places = await page.getByRole("radiogroup", { name: /^Duration/ }).getByRole("radio")
      .evaluateAll((all) => all.map((point) => [Number.parseFloat(point.style.left), Number.parseFloat(point.style.top)]));
    // The axis is one of logarithms.
    const { weights } = fixture("slews/olrac-four-wheels").sweep;
    const decades = places.slice(1).map(([x], index) => (x - places[index][0]) / Math.log10(weights[index + 1] / weights[index]));
    check(decades.every((width) => width > 10 && close(width, decades[0], 0.5)), `decades of ${decades.join()} px`);
    check(places.every(([, y], index) => index === 0 || y < places[index - 1][1]), "longer slews are higher");
    await page.locator("summary", { hasText: "Points as a table" }).click();
    const rows = page.getByRole("region", { name: "Slews along the sweep" }).locator("tbody tr");
    const expected = weights.map((_, index) => (index === 1 ? "chosen" : ""));
    await eventually(async () => {
      const classes = await rows.evaluateAll((all) => all.map((row) => row.className));
      check(classes.join() === expected.join(), `rows ${classes.join()}`);
    });
    return `${decades[0].toFixed(1)} px for a decade`;
  });
  await must("no error of the console with a sweep", () => check(complaints.length === 0, complaints.join("\n")));
  await leave();
}

/** The quarter turn through a cone around the Sun, which is only reported. */
function past() {
  const slew = fixture("slews/quarter-turn");
  slew.spacecraft.boresights = [{ name: "camera", axis: [1, 0, 0] }];
  slew.epoch = "2026-05-05T00:00:00Z";
  slew.keep_out = [{ boresight: "camera", direction: { body: "sun" }, half_angle_deg: 30, applies: "report" }];
  return slew;
}

async function throughACone({ browser, service, must }) {
  const { page, complaints, close: leave } = await openPage(browser, service);
  await must("a slew through a reported cone is amber, with its clearance", async () => {
    await page.goto(`${service.address}/#/slew`);
    await page.getByLabel("Slew", { exact: true }).fill(JSON.stringify(past(), null, 2));
    await page.getByRole("button", { name: "Solve" }).click();
    await page.locator(".chip.waits", { hasText: "Passed, but keep-out violated" }).waitFor();
    const { document: { slews: [slew] } } = await downloaded(page);
    const [{ clearance_deg: least }] = slew.flight.keep_out_clearance_deg;
    check(least < -5 && slew.flight.keep_out_intrusions.length === 1, String(least));
    const shown = await page.locator("dl.pairs > div", { hasText: "camera from /keep_out/0" }).locator("dd").textContent();
    check(shown.startsWith(`−${(-least).toFixed(1)}° at `), shown);
    // The Sun's place is in the answer only.
    await page.locator(".timelines h3", { hasText: "Clearance of cones" }).waitFor();
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    return shown;
  });
  await must("no error of the console with a cone", () => check(complaints.length === 0, complaints.join("\n")));
  await leave();
}

async function wrongAndGivenUp({ browser, service, must }) {
  const { page, complaints, close: leave } = await openPage(browser, service, { expected: REFUSED });
  await must("problems of a slew are shown with their places", async () => {
    await page.goto(`${service.address}/#/slew`);
    const slew = fixture("slews/quarter-turn");
    slew.objective = { kind: "fastest" };
    slew.start.attitude = {};
    await page.getByLabel("Slew", { exact: true }).fill(JSON.stringify(slew, null, 2));
    await page.getByRole("button", { name: "Solve" }).click();
    await page.locator(".failure .pointer").first().waitFor();
    const pointers = await page.locator(".failure .pointer").allTextContents();
    check(pointers.includes("/objective/kind") && pointers.includes("/start/attitude"), pointers.join());
    await page.getByRole("button", { name: "/objective/kind" }).click();
    await eventually(async () => {
      const chosen = await page.locator("#slew").evaluate((field) => field.value.slice(field.selectionStart, field.selectionEnd));
      check(chosen === '"fastest"', `selected ${chosen}`);
    });
    await picture(page, "problems-desktop-light");
    return pointers.join(" ");
  });
  await must("a slew that takes long is given up, on the service too", async () => {
    const slew = fixture("slews/lro-least-bill");
    slew.sweep = { durations_s: Array.from({ length: 200 }, (_, index) => 800 + 5 * index) };
    await page.locator("#slew").fill(JSON.stringify(slew));
    await page.getByRole("button", { name: "Solve" }).click();
    await page.locator(".chip.goes", { hasText: "Computing" }).waitFor();
    await eventually(async () => check(await page.getByRole("button", { name: "Solve" }).isDisabled(), "not one at a time"));
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    await picture(page, "computing-desktop-light");
    await page.getByRole("button", { name: "Cancel" }).click();
    await page.locator(".chip.ended", { hasText: "Cancelled" }).waitFor();
    await page.getByRole("button", { name: "Cancel" }).waitFor({ state: "hidden" });
    const begun = Date.now();
    await sent(page, service, { view: "slew", example: "quarter-turn", verb: "Solve" });
    check(Date.now() - begun < SOON_MS, "the next one waits");
    return `the next one took ${Date.now() - begun} ms`;
  });
  await must("no other error of the console there", () => check(complaints.length === 0, complaints.join("\n")));
  await leave();
}

async function study({ browser, service, must }) {
  const { page, complaints, close: leave } = await openPage(browser, service, { expected: REFUSED });
  await must("the authority study is run and shown as curves and tables", async () => {
    await page.goto(service.address);
    await page.getByRole("link", { name: "Studies" }).click();
    await page.getByRole("heading", { name: "Authority study" }).waitFor();
    await sent(page, service, { view: "studies/authority", example: "study-authority", verb: "Run" });
    const { document: { rows } } = await downloaded(page);
    const table = page.getByRole("region", { name: "Plans and flights" }).locator("tbody tr");
    await eventually(async () => check(await table.count() === rows.length, `${await table.count()} rows`));
    const cells = await table.first().locator("td").allTextContents();
    const share = `${(100 * rows[0].flights.share_within).toFixed(1)} %`;
    check(cells.includes(rows[0].total_time_s.toFixed(2)) && cells.includes(share), cells.join());
    await eventually(async () => check(await page.locator(".curves .uplot").count() === 3, "three plots"));
    await page.locator("summary", { hasText: "Targets and wheels" }).first().click();
    const cones = page.getByRole("region", { name: /^Clearance of cones that so many flights keep/ }).first();
    const [cone] = rows[0].flights.keep_out_clearance_deg;
    await cones.locator("tbody tr").first().waitFor();
    const least = await cones.locator("tbody tr").first().locator("th, td").allTextContents();
    check(least[0] === "camera from /keep_out/0" && least.includes(cone.clearance_deg.min.toFixed(2)), least.join());
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    return `${share} within the tolerance at ${cells[0]}`;
  });
  await must("problems of a study are shown with their places", async () => {
    const wrong = fixture("studies/authority");
    wrong.authorities[1].torque_authority = 2;
    await page.locator("#study").fill(JSON.stringify(wrong));
    await page.getByRole("button", { name: "Run" }).click();
    await page.locator(".failure .pointer", { hasText: "/authorities/1/torque_authority" }).waitFor();
    await page.getByRole("region", { name: "Result" }).waitFor({ state: "hidden" });
  });
  await must("no other error of the console with a study", () => check(complaints.length === 0, complaints.join("\n")));
  await leave();
}
